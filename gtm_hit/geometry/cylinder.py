"""A person's size, and the rectangles it makes in a view."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.errors import GeometryError
from gtm_hit.geometry.grid import Grid, Precision
from gtm_hit.geometry.rectangle_rule import centre_rule, corners_rule

HEIGHTS = (0.3, 3.0)  # metres an annotated person may have: a pram, a child on shoulders
RADII = (0.05, 2.0)  # metres
BLOCK = 8192  # positions worked on together: their temporaries stay in the processor's cache


class CylinderError(GeometryError):
    """A radius or height no person has."""


@dataclass(frozen=True)
class Cylinder:
    radius: float  # metres
    height: float  # metres

    def __post_init__(self) -> None:
        for name in ("radius", "height"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise CylinderError(f"{name} must be a positive number of metres, not {value}")


class FootRule(StrEnum):
    """Where a rectangle ends at the bottom, and in which arithmetic: the two published data sets differ."""

    CORNERS = "corners"  # WILDTRACK
    CENTRE = "centre"  # MultiviewX


def rectangles(
    camera: Camera, grid: Grid, cylinder: Cylinder, rule: FootRule, positions: ArrayLike
) -> tuple[NDArray[np.int16], NDArray[np.bool_]]:
    """Rectangles of a cylinder standing on each position.

    Parameters
    ----------
    positions : (N,) ids on the grid; GridError otherwise

    Returns
    -------
    boxes : (N, 4) int16, xmin ymin xmax ymax in pixels, never clipped to the image; 0 where not visible
    visible : (N,) bool
    """
    ids = np.atleast_1d(np.asarray(positions, dtype=np.int64))
    grid.check(ids)
    boxes = np.empty((ids.size, 4), np.int16)
    for start in range(0, ids.size, BLOCK):
        block = slice(start, start + BLOCK)
        rows, columns = np.divmod(ids[block], grid.columns)
        fill_block(camera, grid, cylinder, rule, columns, rows, boxes[block])
    return boxes, is_visible(boxes)


def fill_block(
    camera: Camera,
    grid: Grid,
    cylinder: Cylinder,
    rule: FootRule,
    columns: NDArray[np.int64],
    rows: NDArray[np.int64],
    boxes: NDArray[np.int16],
) -> None:
    """Write the rectangles of `columns` and `rows`, broadcast against each other, into `boxes` (..., 4)."""
    apply = corners_rule if rule is FootRule.CORNERS else centre_rule
    precision: Precision = np.float32 if rule is FootRule.CORNERS else np.float64
    x, y = grid.column_metres(columns, precision), grid.row_metres(rows, precision)
    apply(camera, cylinder.radius, cylinder.height, x, y, boxes)


def is_visible(boxes: NDArray[np.int16]) -> NDArray[np.bool_]:
    """Which of the boxes (..., 4) are visible: those have an xmax above 0, the others are all 0."""
    return boxes[..., 2] > 0
