"""The root of everything geometry refuses."""

from __future__ import annotations


class GeometryError(ValueError):
    """Numbers that cannot be a camera, a grid, a cylinder or a table; the message says which."""
