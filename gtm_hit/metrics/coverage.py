"""How many cameras see each position of the grid."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.annotations import Ids, MetricsError


@dataclass(frozen=True, eq=False)
class Coverage:
    """Positions of a grid, every `every`-th along both axes, and how many cameras see each."""

    grid: Grid
    every: int
    cameras: int
    seen_by: Ids  # (rows, columns) of the chosen positions

    @property
    def counts(self) -> Ids:
        """(cameras + 1,): positions seen by exactly 0, 1, … cameras."""
        return np.bincount(self.seen_by.ravel(), minlength=self.cameras + 1).astype(np.int64)

    @property
    def mean(self) -> float:
        """Cameras per position."""
        return float(self.seen_by.mean())


def chosen_positions(grid: Grid, every: int = 1) -> Ids:
    """Ids, (rows, columns), of every `every`-th position along both axes, beginning with position 0."""
    if every < 1:
        raise MetricsError(f"every must be 1 or more, not {every}")
    columns = np.arange(0, grid.columns, every, dtype=np.int64)
    rows = np.arange(0, grid.rows, every, dtype=np.int64)
    return rows[:, None] * grid.columns + columns[None, :]


def coverage(grid: Grid, visible: Iterable[NDArray[np.bool_]], every: int = 1) -> Coverage:
    """`visible`: for each camera in turn which of all positions of the grid, (grid.count,), it sees.

    One camera at a time is enough: a table's views need not be in memory together.
    """
    positions = chosen_positions(grid, every)
    seen_by = np.zeros(positions.shape, dtype=np.int64)
    cameras = 0
    for camera in visible:
        if camera.shape != (grid.count,):
            raise MetricsError(f"visibility has shape {camera.shape}, not ({grid.count},)")
        seen_by += camera[positions]
        cameras += 1
    return Coverage(grid, every, cameras, seen_by)
