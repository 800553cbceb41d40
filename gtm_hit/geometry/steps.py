"""How long computations say how far they are."""

from __future__ import annotations

from collections.abc import Callable

Steps = Callable[[int, int], object]
"""Told the steps done and the steps in all."""
