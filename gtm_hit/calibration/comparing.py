"""What differs between two calibrations of the same cameras: numbers, lenses, and where the ground lies.

The shift on the ground is what a click would feel: a point of the ground is seen by the camera as it was, and
its pixel is put back on the ground by the camera as it is now.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, back_project, fold, normalise
from gtm_hit.geometry.grid import Grid

Floats = NDArray[np.float64]

MOST_CELLS = 120  # along the longer side of the ground
LATTICE = 41  # pixels along each side of the picture at which lenses are compared
CM = 100.0


class OtherCameras(ValueError):
    """The two calibrations are not of the same cameras."""


@dataclass(frozen=True, eq=False)
class Cells:
    """The ground in squares of `together` by `together` positions; the last of a line may be cut."""

    grid: Grid
    together: int

    @property
    def columns(self) -> int:
        return math.ceil(self.grid.columns / self.together)

    @property
    def rows(self) -> int:
        return math.ceil(self.grid.rows / self.together)

    @property
    def side(self) -> float:
        """Metres."""
        return self.together * self.grid.step

    def middles(self) -> Floats:
        """(rows × columns, 3) metres, on the ground."""
        x = self.grid.column_metres(self._middle(self.columns, self.grid.columns))
        y = self.grid.row_metres(self._middle(self.rows, self.grid.rows))
        across, up = np.meshgrid(x, y)
        return np.column_stack((across.ravel(), up.ravel(), np.zeros(across.size)))

    def _middle(self, cells: int, positions: int) -> Floats:
        first = np.arange(cells, dtype=np.float64) * self.together
        last = np.minimum(first + self.together, positions) - 1
        return (first + last) / 2


@dataclass(frozen=True)
class Spread:
    """Of the cells one camera sees; None where it sees none."""

    seen: int
    lost: int  # cells whose pixel shows no ground any more
    median: float | None  # cm
    p95: float | None  # cm
    most: float | None  # cm


@dataclass(frozen=True)
class CameraChange:
    """How one camera went from `before` to `after`."""

    before: Camera
    after: Camera
    centre: tuple[float, float, float]  # cm along X, Y and Z
    turned: float  # degrees
    distortion: float | None  # px, the most in the picture, focal length and principal point left alone
    ground: Spread

    @property
    def name(self) -> str:
        return self.before.name

    @property
    def moved(self) -> float:
        """cm from centre to centre."""
        return math.hypot(*self.centre)


@dataclass(frozen=True, eq=False)
class Change:
    cells: Cells
    cameras: tuple[CameraChange, ...]
    cm: Floats  # (cameras, rows, columns); NaN where the camera sees no ground, infinite where it is lost

    @property
    def worst(self) -> Floats:
        """The largest shift of all cameras that see a cell, (rows, columns); NaN where none does."""
        highest = np.where(np.isnan(self.cm), -np.inf, self.cm).max(axis=0)
        return np.where(np.isneginf(highest), np.nan, highest)


def compare_cameras(before: Sequence[Camera], after: Sequence[Camera], grid: Grid) -> Change:
    """Raises OtherCameras when names or picture sizes differ."""
    _refuse_others(before, after)
    cells = cells_of(grid)
    ground = cells.middles()
    cm = np.stack([ground_shift(*pair, ground) for pair in zip(before, after, strict=True)])
    changes = tuple(
        CameraChange(
            old,
            new,
            _tuple(CM * (new.centre - old.centre)),
            _degrees(old, new),
            _distortion(old, new),
            _spread(shift),
        )
        for old, new, shift in zip(before, after, cm, strict=True)
    )
    return Change(cells, changes, cm.reshape(len(before), cells.rows, cells.columns))


def cells_of(grid: Grid) -> Cells:
    return Cells(grid, max(1, math.ceil(max(grid.columns, grid.rows) / MOST_CELLS)))


def ground_shift(before: Camera, after: Camera, points: Floats) -> Floats:
    """cm, (N,), that points (N, 3) of the ground go; NaN where `before` does not see them.

    Infinite where `after` has no ground at the pixel: it is above the horizon or beyond the lens's fold.
    """
    pixels = _seen_at(before, points)
    seen = ~np.isnan(pixels[:, 0])
    shift = np.full(len(points), np.nan)
    found = back_project(after, pixels[seen])
    away = CM * np.hypot(*(found - points[seen, :2]).T)
    shift[seen] = np.where(np.isnan(away), np.inf, away)
    return shift


def _seen_at(camera: Camera, points: Floats) -> Floats:
    """Pixels (N, 2); NaN where the camera does not see the point."""
    x, y, depth = (points @ camera.rotation.T + camera.tvec).T
    with np.errstate(all="ignore"):
        x, y = x / depth, y / depth
        # Beyond the fold a lens's formula turns back into the picture.
        shown = (depth * camera.facing > 0) & (np.hypot(x, y) < fold(camera))
        x, y = camera.distort(x, y) if camera.has_lens else (x, y)
    (fx, _, cx), (_, fy, cy), _ = camera.matrix.tolist()
    pixels = np.column_stack((x * fx + cx, y * fy + cy))
    shown &= ((pixels >= -0.5) & (pixels < (camera.width - 0.5, camera.height - 0.5))).all(axis=1)
    return np.where(shown[:, None], pixels, np.nan)


def _distortion(before: Camera, after: Camera) -> float | None:
    """Pixels that the change of distortion alone moves what is seen, at the worst place of the picture.

    None where no place is known to both lenses.
    """
    across = np.linspace(0, before.width - 1, LATTICE)
    down = np.linspace(0, before.height - 1, LATTICE)
    x, y = np.meshgrid(across, down)
    plane = normalise(before, np.column_stack((x.ravel(), y.ravel())))
    known = np.hypot(*plane.T) < min(fold(before), fold(after))  # NaN is not
    if not known.any():
        return None
    x, y = plane[known].T
    bent = [_bent(replace(camera, matrix=before.matrix), x, y) for camera in (before, after)]
    return float(np.hypot(*(bent[1] - bent[0])).max())


def _bent(camera: Camera, x: Floats, y: Floats) -> Floats:
    x, y = camera.distort(x, y) if camera.has_lens else (x, y)
    return np.stack((x * camera.matrix[0, 0], y * camera.matrix[1, 1]))


def _degrees(before: Camera, after: Camera) -> float:
    turn = cv2.Rodrigues(after.rotation @ before.rotation.T)[0]
    return math.degrees(float(np.linalg.norm(turn)))


def _spread(cm: Floats) -> Spread:
    seen = cm[~np.isnan(cm)]
    kept = seen[np.isfinite(seen)]
    lost = len(seen) - len(kept)
    if not len(kept):
        return Spread(len(seen), lost, None, None, None)
    return Spread(len(seen), lost, *np.percentile(kept, [50, 95, 100]).tolist())


def _tuple(values: Floats) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z


def _refuse_others(before: Sequence[Camera], after: Sequence[Camera]) -> None:
    names = [[camera.name for camera in cameras] for cameras in (before, after)]
    if names[0] != names[1]:
        raise OtherCameras(f"One has cameras {', '.join(names[0])}, the other {', '.join(names[1])}.")
    for old, new in zip(before, after, strict=True):
        if (old.width, old.height) != (new.width, new.height):
            raise OtherCameras(
                f"Pictures of {old.name} have {old.width}×{old.height} pixels in one, "
                f"{new.width}×{new.height} in the other."
            )
