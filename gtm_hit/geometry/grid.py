"""The positions people can stand on: a regular grid on the ground."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gtm_hit.geometry.errors import GeometryError

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
Precision = type[np.float32] | type[np.float64]


class GridError(GeometryError):
    """A grid that has no positions, or none at finite places."""


@dataclass(frozen=True)
class Grid:
    """`columns` along X, `rows` along Y; a position's id is `row * columns + column`."""

    columns: int
    rows: int
    step: float  # metres
    origin_x: float  # metres, of position 0
    origin_y: float  # metres, of position 0

    def __post_init__(self) -> None:
        for name in ("columns", "rows"):
            if getattr(self, name) < 1:
                raise GridError(f"{name} must be at least 1, not {getattr(self, name)}")
        if not (math.isfinite(self.step) and self.step > 0):
            raise GridError(f"step must be a positive number of metres, not {self.step}")
        if not (math.isfinite(self.origin_x) and math.isfinite(self.origin_y)):
            raise GridError(f"origin must be finite, not ({self.origin_x}, {self.origin_y})")

    @property
    def count(self) -> int:
        return self.columns * self.rows

    @property
    def extent(self) -> tuple[float, float]:
        """Width along X and length along Y, metres."""
        return self.columns * self.step, self.rows * self.step

    def column_metres(self, columns: ArrayLike, precision: Precision = np.float64) -> NDArray[Any]:
        """X of columns, metres, computed in `precision`.

        The published rectangles were made with this order of operations in float32.
        """
        return self._along(columns, self.columns, self.extent[0], self.origin_x, precision)

    def row_metres(self, rows: ArrayLike, precision: Precision = np.float64) -> NDArray[Any]:
        """Y of rows, metres."""
        return self._along(rows, self.rows, self.extent[1], self.origin_y, precision)

    def metres(self, positions: ArrayLike) -> Floats:
        """Ground X and Y, (N, 2), of positions (N,)."""
        rows, columns = np.divmod(np.atleast_1d(np.asarray(positions, dtype=np.int64)), self.columns)
        return np.column_stack((self.column_metres(columns), self.row_metres(rows)))

    def position(self, xy: ArrayLike) -> Ids:
        """Nearest position, (N,), of ground points (N, 2) in metres.

        -1 where the point is more than half a step outside the grid or NaN: ids are integers and have no NaN.
        """
        cells = self._cells(xy)
        inside = np.all((cells >= 0) & (cells < (self.columns, self.rows)), axis=1, keepdims=True)
        columns, rows = np.where(inside, cells, 0.0).astype(np.int64).T
        return np.where(inside[:, 0], rows * self.columns + columns, -1)

    def nearest(self, xy: ArrayLike) -> Ids:
        """Nearest position, (N,), of ground points (N, 2) wherever they are; -1 only for NaN."""
        cells = self._cells(xy)
        known = np.logical_not(np.isnan(cells).any(axis=1, keepdims=True))
        clamped = np.clip(np.where(known, cells, 0.0), 0, (self.columns - 1, self.rows - 1))
        columns, rows = clamped.astype(np.int64).T
        return np.where(known[:, 0], rows * self.columns + columns, -1)

    def check(self, positions: Ids) -> None:
        """Raise GridError for the first position that is not on the grid."""
        outside = positions[(positions < 0) | (positions >= self.count)]
        if outside.size:
            raise GridError(f"position {outside[0]} is not on the grid of {self.columns}×{self.rows}")

    def contains(self, position: int) -> bool:
        return 0 <= position < self.count

    @staticmethod
    def _along(
        cells: ArrayLike, count: int, extent: float, origin: float, precision: Precision
    ) -> NDArray[Any]:
        along: NDArray[Any] = np.asarray(cells).astype(precision)
        return precision(origin) + along * precision(extent) / precision(count)

    def _cells(self, xy: ArrayLike) -> Floats:
        points = np.asarray(xy, dtype=np.float64).reshape(-1, 2)
        # Half up instead of numpy's half to even: the browser rounds this way.
        return np.floor((points - (self.origin_x, self.origin_y)) / self.step + 0.5)
