"""What holds the world in place.

Clicks alone say nothing of where the world is, how it is turned and how large it is: seven numbers. Measured
points do; without them seven numbers of the cameras have to stay, and whoever reads the result is told.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.parameters import packed
from gtm_hit.calibration.adjustment.problem import POSE, Problem
from gtm_hit.calibration.adjustment.residuals import Seen

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

FLAT = 1e-3  # of their extent: points closer to one line than this do not hold the world
TOGETHER = 1e-3  # metres: cameras this close give no scale


@dataclass(frozen=True, eq=False)
class Gauge:
    """held : (C, K) numbers that stay for no other reason than to hold the world."""

    held: Flags
    notices: tuple[str, ...] = ()
    pair: tuple[int, int, float] | None = None  # two views, and the metres between them that are to stay

    def restored(self, rows: Floats, points: Floats) -> tuple[Floats, Floats]:
        """The same world, enlarged so that the distance is again what it was."""
        if self.pair is None:
            return rows, points
        first, second, metres = self.pair
        turns = [cv2.Rodrigues(row[:3])[0] for row in rows]
        centres = [-turn.T @ row[3:6] for turn, row in zip(turns, rows, strict=True)]
        factor = metres / float(np.linalg.norm(centres[second] - centres[first]))
        about = centres[first]
        moved = rows.copy()
        for row, turn, centre in zip(moved, turns, centres, strict=True):
            row[3:6] = -turn @ (about + factor * (centre - about))
        return moved, about + factor * (points - about)


def chosen(problem: Problem, seen: Seen) -> Gauge:
    """AdjustmentError where measured points are too few to hold the world, yet there are some."""
    rows = packed(problem.views)
    nothing = Gauge(np.zeros(rows.shape, dtype=bool))
    if _known_points_hold(problem, seen):
        return nothing
    if len(np.unique(seen.points[seen.points >= len(problem.points)])):
        raise AdjustmentError(
            "The measured points that were clicked are fewer than three or lie in one line: the world could "
            "turn about them. Click more of them, or leave them all out; then the cameras hold the world."
        )
    still = [number for number, view in enumerate(problem.views) if _stands(view.stays)]
    centres = [view.camera().centre for view in problem.views]
    first = still[0] if still else int(np.bincount(seen.cameras, minlength=len(rows)).argmax())
    away = [float(np.linalg.norm(centre - centres[first])) for centre in centres]
    if len(still) > 1 and max(away[number] for number in still) > TOGETHER:
        return nothing
    if max(away) <= TOGETHER:
        raise AdjustmentError("All cameras stand at the same place: nothing tells how large the world is.")
    return _held_by_two(problem, nothing.held, first, int(np.argmax(away)), away)


def _held_by_two(problem: Problem, held: Flags, first: int, second: int, away: list[float]) -> Gauge:
    one, other = problem.views[first], problem.views[second].camera()
    held[first, : len(POSE)] = True
    # Of the numbers of the other's translation, the one that says most about how far it is away.
    along = other.rotation @ (other.centre - one.camera().centre)
    held[second, 3 + int(np.abs(along).argmax())] = True
    notice = (
        f"There is no measured point: the place and direction of {one.name} and the {away[second]:.3f} m "
        f"from it to {other.name} were kept (7 numbers). The world stays where the first poses have it, and "
        "is as right as they are."
    )
    return Gauge(held, (notice,), (first, second, away[second]))


def _known_points_hold(problem: Problem, seen: Seen) -> bool:
    known = np.zeros(len(problem.points) + len(problem.measured), dtype=bool)
    known[len(problem.points) :] = True
    if problem.point_sigmas is not None:
        known[: len(problem.points)] = np.isfinite(problem.point_sigmas).all(axis=1)
    used = np.unique(seen.points)
    return spans_plane(np.concatenate((problem.points, problem.measured))[used[known[used]]])


def spans_plane(points: Floats) -> bool:
    """Three or more points that do not lie in one line."""
    if len(points) < 3:
        return False
    sizes = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return bool(sizes[1] > FLAT * sizes[0])


def _stands(stays: frozenset[str]) -> bool:
    return "pose" in stays or stays >= set(POSE)
