"""Which of many views are worth solving: tilts in all directions first, then the rest of the picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.views import BoardView, Floats

WANTED = 20  # views; more take time and hardly add
DIRECTIONS = 8  # of tilt
LEAST_TILT = 10.0  # degrees: below it a board looks as if seen straight on
CELLS = (8, 6)  # columns and rows the picture is divided into, for its coverage


@dataclass(frozen=True)
class Tilt:
    """How a board stands to the camera, by a rough focal length: told well enough to choose."""

    angle: float  # degrees between the board's normal and the line of sight, 0 … 90
    direction: float  # degrees, where it leans to in the picture, 0 … 360


def choose(views: Sequence[BoardView], size: tuple[int, int], wanted: int = WANTED) -> list[str]:
    """Names of at most `wanted` views, best first. The same views give the same names."""
    left = {view.name: view for view in sorted(views, key=lambda view: view.name)}
    tilts = {name: tilt_of(view, size) for name, view in left.items()}
    covered = {name: cells_of(view.pixels, size) for name, view in left.items()}
    chosen: list[str] = []
    seen = np.zeros((CELLS[1], CELLS[0]), dtype=np.int64)
    for name in _most_tilted(tilts)[:wanted]:
        chosen.append(name)
        seen += covered[name] > 0
    while len(chosen) < min(wanted, len(left)):
        rest = [name for name in left if name not in chosen]
        best = max(rest, key=lambda name: (_gain(seen, covered[name]), tilts[name].angle))
        chosen.append(best)
        seen += covered[best] > 0
    return chosen


def tilt_of(view: BoardView, size: tuple[int, int]) -> Tilt:
    """The tilt by a focal length of the picture's longer side."""
    focal = float(max(size))
    matrix = np.array([[focal, 0, (size[0] - 1) / 2], [0, focal, (size[1] - 1) / 2], [0, 0, 1]])
    found, rvec, tvec = cv2.solvePnP(view.points, view.pixels, matrix, None, flags=cv2.SOLVEPNP_IPPE)
    if not found or not np.isfinite(rvec).all():
        return Tilt(0.0, 0.0)
    return tilt_at(rvec.ravel().astype(np.float64), tvec.ravel().astype(np.float64))


def tilt_at(rvec: Floats, tvec: Floats) -> Tilt:
    """The tilt of a board at a pose, board to camera, against the line of sight to it."""
    normal = cv2.Rodrigues(np.asarray(rvec, dtype=np.float64))[0][:, 2]
    sight = tvec / np.linalg.norm(tvec)
    normal = normal if normal @ sight > 0 else -normal
    angle = np.degrees(np.arccos(np.clip(normal @ sight, -1, 1)))
    lean = normal - (normal @ sight) * sight
    return Tilt(float(angle), float(np.degrees(np.arctan2(lean[1], lean[0])) % 360))


def directions_of(tilts: Sequence[Tilt]) -> set[int]:
    """Into which of the eight directions boards lean."""
    return {_sector(tilt) for tilt in tilts if tilt.angle >= LEAST_TILT}


def cells_of(pixels: Floats, size: tuple[int, int]) -> NDArray[np.int64]:
    """How many points lie in each cell of the picture, (rows, columns)."""
    counts, _, _ = np.histogram2d(
        pixels[:, 1], pixels[:, 0], bins=CELLS[::-1], range=((-0.5, size[1] - 0.5), (-0.5, size[0] - 0.5))
    )
    return counts.astype(np.int64)


def coverage(views: Sequence[BoardView], size: tuple[int, int]) -> NDArray[np.int64]:
    """How many points of all views lie in each cell of the picture, (rows, columns)."""
    total = np.zeros((CELLS[1], CELLS[0]), dtype=np.int64)
    for view in views:
        total += cells_of(view.pixels, size)
    return total


def _sector(tilt: Tilt) -> int:
    width = 360 / DIRECTIONS
    return int((tilt.direction + width / 2) % 360 // width)


def _most_tilted(tilts: dict[str, Tilt]) -> list[str]:
    """Per direction the two that lean most, but none so much that its points get lost; strongest first."""
    useful = {name: tilt for name, tilt in tilts.items() if LEAST_TILT <= tilt.angle <= 65}
    by_strength = sorted(useful, key=lambda name: (-useful[name].angle, name))
    firsts: list[str] = []
    seconds: list[str] = []
    taken: dict[int, int] = {}
    for name in by_strength:
        sector = _sector(useful[name])
        taken[sector] = taken.get(sector, 0) + 1
        if taken[sector] <= 2:
            (firsts if taken[sector] == 1 else seconds).append(name)
    return firsts + seconds[: max(0, DIRECTIONS - len(firsts))]


def _gain(seen: NDArray[np.int64], cells: NDArray[np.int64]) -> float:
    """New cells count most; then those seen least."""
    return float((1 / (1 + seen[cells > 0].astype(np.float64)) ** 2).sum())
