"""How well cameras foretell what they were not asked: a point from all views but one, seen in that one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.parameters import packed
from gtm_hit.calibration.adjustment.problem import View
from gtm_hit.calibration.adjustment.residuals import Seen, misses
from gtm_hit.calibration.adjustment.settling import NARROW, settled, widest_angles

Floats = NDArray[np.float64]

MOST_POINTS = 5000  # asked about, evenly spread over all that can be
FEWEST_VIEWS = 3


@dataclass(frozen=True, eq=False)
class HoldOut:
    """Pixels between the foretold and the clicked place, one for each view left out."""

    points: int  # that could be asked about
    misses: Floats  # (L,)
    undetermined: int = 0  # left out of a view, the others' rays being almost parallel: not in `misses`

    def share(self, percent: float) -> float | None:
        return float(np.percentile(self.misses, percent)) if self.misses.size else None


def leave_one_view_out(views: Sequence[View], seen: Seen, free: int, turn: float) -> HoldOut:
    """Of free points, the first `free` ones, that three views saw; the cameras stay as they are.

    Each is put where the other views' clicks, none of which may spoil it alone, say that it is.
    """
    counts = np.bincount(seen.points, minlength=free)[:free]
    asked = np.flatnonzero(counts >= FEWEST_VIEWS)
    if asked.size > MOST_POINTS:
        asked = asked[np.linspace(0, asked.size - 1, MOST_POINTS).round().astype(np.int64)]
    left = np.flatnonzero(np.isin(seen.points, asked))
    if not left.size:
        return HoldOut(0, np.zeros(0))
    # Each observation left out makes a point of its own, seen by the others of the same point.
    told, place = _others(seen, left)
    others = _sorted(Seen(seen.cameras[told], place, seen.pixels[told], np.ones(told.size)))
    rows = packed(views)
    sure = widest_angles(rows, others, left.size) >= NARROW
    nowhere = np.full((left.size, 3), np.nan)
    found = settled(rows, nowhere, others, sure, turn)
    asked_of = _sorted(Seen(seen.cameras[left], np.arange(left.size), seen.pixels[left], np.ones(left.size)))
    missed = misses(rows, found, asked_of)[sure[asked_of.points]]
    lengths = np.hypot(missed[:, 0], missed[:, 1])
    return HoldOut(np.unique(seen.points[left][sure]).size, lengths, int((~sure).sum()))


def _others(seen: Seen, left: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Observations of the same points by other views, and which of `left` each is for."""
    by_point: dict[int, list[int]] = {}
    for row, point in enumerate(seen.points.tolist()):
        by_point.setdefault(point, []).append(row)
    pairs = [
        (other, place)
        for place, row in enumerate(left.tolist())
        for other in by_point[int(seen.points[row])]
        if other != row
    ]
    table = np.array(pairs, dtype=np.int64)
    return table[:, 0], table[:, 1]


def _sorted(seen: Seen) -> Seen:
    order = np.lexsort((seen.points, seen.cameras))
    return Seen(seen.cameras[order], seen.points[order], seen.pixels[order], seen.weights[order])
