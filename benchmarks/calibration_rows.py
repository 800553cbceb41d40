"""A line of the table that `python -m benchmarks.calibration` prints."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    name: str
    got: str
    bar: str
    met: bool | None  # None: nothing to compare with
