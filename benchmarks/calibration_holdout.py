"""One view left out as it is done elsewhere: the others' clicks triangulated linearly, few points drawn.

The reference figures are of 250 points, and nobody knows of which. So as many are drawn a thousand times.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.parameters import packed
from gtm_hit.calibration.adjustment.problem import View
from gtm_hit.calibration.adjustment.residuals import Seen, misses
from gtm_hit.geometry import lens

Floats = NDArray[np.float64]

POINTS, DRAWS, SEED = 250, 1000, 0
FEWEST_VIEWS = 3


@dataclass(frozen=True)
class Drawn:
    """Medians of the misses, pixels: the middle of all draws, and between which 95 of 100 lie."""

    median: float
    low: float
    high: float


def drawn(views: Sequence[View], seen: Seen, free: int) -> Drawn:
    counts = np.bincount(seen.points, minlength=free)[:free]
    asked = np.flatnonzero(counts >= FEWEST_VIEWS)
    of_point = [np.flatnonzero(seen.points == point) for point in asked]
    found = linear_misses(packed(views), seen, of_point)
    rng = np.random.default_rng(SEED)
    count = min(POINTS, len(asked))
    medians = [
        np.median(np.concatenate([found[place] for place in rng.choice(len(asked), count, replace=False)]))
        for _ in range(DRAWS)
    ]
    return Drawn(*(float(np.percentile(medians, share)) for share in (50, 2.5, 97.5)))


def linear_misses(rows: Floats, seen: Seen, of_point: Sequence[NDArray[np.int64]]) -> list[Floats]:
    """Of each point, pixels by which each of its views is missed by what the others triangulate."""
    equations = _equations(rows, seen)
    left, places = [], []
    for clicks in of_point:
        for click in clicks:
            others = equations[clicks[clicks != click]].reshape(-1, 4)
            point = np.linalg.svd(others)[2][-1]
            left.append(click)
            places.append(point[:3] / point[3])
    order = np.lexsort((left, seen.cameras[left]))
    rows_left = np.array(left)[order]
    ones = np.ones(len(order))
    asked = Seen(seen.cameras[rows_left], np.arange(len(order)), seen.pixels[rows_left], ones)
    lengths = np.empty(len(order))
    lengths[order] = np.hypot(*misses(rows, np.array(places)[order], asked).T)
    return np.split(lengths, np.cumsum([len(clicks) for clicks in of_point])[:-1])


def _equations(rows: Floats, seen: Seen) -> Floats:
    """(N, 2, 4) of each click, two planes in which its point lies; zeros beyond a lens's fold."""
    found = np.zeros((len(seen.pixels), 2, 4))
    for number, row in enumerate(rows):
        part = seen.of(number)
        pose = np.column_stack((cv2.Rodrigues(row[:3])[0], row[3:6]))
        plane = (seen.pixels[part] - row[8:10]) / row[6:8]
        x, y = lens.undistort(plane[:, 0], plane[:, 1], row[10:])
        found[part, 0] = x[:, None] * pose[2] - pose[0]
        found[part, 1] = y[:, None] * pose[2] - pose[1]
    return np.nan_to_num(found)
