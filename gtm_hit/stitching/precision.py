"""How exactly each worker of a batch places people, told by how far he is from the others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gtm_hit.stitching.replicas import People
from gtm_hit.stitching.tracks import Floats

LEAST = 30  # common places that tell anything
LIMITS = (0.25, 6.0)  # of the middle variance: nobody counts for everything or for nothing
SLIP = 0.3  # metres: no noise but a slip


def variances(people: Sequence[People], replicas: int, noise: float) -> Floats:
    """Square metres per worker (R,), in X and in Y; all alike where too little is known.

    Two workers only tell how exact they are together. Of three or more each pair's differences are the sum of
    two variances, so that all of them together tell each one's.
    """
    alike = np.full(replicas, noise**2)
    if replicas < 3:
        return alike
    sums, counts = _differences(people, replicas)
    first, second = np.triu_indices(replicas, 1)
    known = counts[first, second] >= LEAST
    equations = np.zeros((int(known.sum()), replicas))
    rows = np.arange(len(equations))
    equations[rows, first[known]] = equations[rows, second[known]] = 1.0
    if len(equations) < replicas or np.linalg.matrix_rank(equations) < replicas:
        return alike
    means = (sums / np.maximum(counts, 1))[first, second][known]
    found = np.linalg.lstsq(equations, means, rcond=None)[0]
    middle = max(float(np.median(found)), (noise / 4) ** 2)
    limited: Floats = np.clip(found, LIMITS[0] * middle, LIMITS[1] * middle)
    return limited


def _differences(people: Sequence[People], replicas: int) -> tuple[Floats, Floats]:
    """Sums (R, R) of squared differences per axis over common places, and their number."""
    sums, counts = np.zeros((replicas, replicas)), np.zeros((replicas, replicas))
    for person in people:
        for points in person.values():
            for index, one in enumerate(points):
                for other in points[index + 1 :]:
                    apart = float(((one.xy - other.xy) ** 2).sum()) / 2
                    if apart < SLIP**2 / 2:
                        pair = tuple(sorted((one.replica, other.replica)))
                        sums[pair] += apart
                        counts[pair] += 1
    return sums, counts
