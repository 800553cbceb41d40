"""Who on one side is whom on the other: pairs of places closer than a radius."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from gtm_hit.metrics.annotations import Annotations, Floats, Ids, MetricsError, by_frame

RADIUS = 0.5  # metres, the WILDTRACK paper's

# Two places of a grid that lie exactly the radius apart must not be matched or refused by the last bit of a
# floating point subtraction, which depends on where the origin is.
SLACK = 1e-9  # metres


@dataclass(frozen=True, eq=False)
class Matches:
    """Pairs (K,) of rows of the two sides, frame by frame."""

    truth: Ids
    found: Ids
    distances: Floats  # (K,) metres


def match(truth: Annotations, found: Annotations, radius: float = RADIUS) -> Matches:
    """The best one-to-one pairs within every frame, see `match_places`."""
    check_radius(radius)
    pairs = []
    for _, truth_rows, found_rows in by_frame(truth, found):
        if len(truth_rows) and len(found_rows):
            first, second, distances = match_places(truth.xy[truth_rows], found.xy[found_rows], radius)
            pairs.append((truth_rows[first], found_rows[second], distances))
    if not pairs:
        return Matches(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0))
    return Matches(*(np.concatenate(parts) for parts in zip(*pairs, strict=True)))


def match_places(truth_xy: Floats, found_xy: Floats, radius: float) -> tuple[Ids, Ids, Floats]:
    """Rows (K,) of both sides and the distances between them, of places (N, 2) and (M, 2) in metres.

    Pairs at `radius` or more are ruled out before the assignment, so that a far pair never takes the partner
    of a near one. Of the rest as many as possible are matched, and of all ways to do that the one with the
    smallest sum of distances is taken: what the evaluation tool of the paper and of MVDet computes by pricing
    a far pair higher than all near ones together.
    """
    distances = distances_between(truth_xy, found_xy)
    near = is_near(distances, radius)
    # A near pair costs less than nothing and one more of them outweighs every saving of distance.
    reward = radius * (min(distances.shape) + 1)
    first, second = linear_sum_assignment(np.where(near, distances - reward, 0.0))
    kept = near[first, second]
    first, second = first[kept], second[kept]
    return first, second, distances[first, second]


def distances_between(truth_xy: Floats, found_xy: Floats) -> Floats:
    """(N, M) metres."""
    difference = truth_xy[:, None, :] - found_xy[None, :, :]
    distances: Floats = np.hypot(difference[..., 0], difference[..., 1])
    return distances


def is_near(distances: Floats, radius: float) -> np.ndarray:
    near: np.ndarray = distances < radius - SLACK
    return near


def check_radius(radius: float) -> None:
    if not (math.isfinite(radius) and radius > 0):
        raise MetricsError(f"radius must be a positive number of metres, not {radius}")
