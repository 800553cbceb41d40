"""Places of one person in the frames of one batch, each helped by the frames around it.

People do not jump: of several noisy places along a way the true one is known better than from its own frame
alone. How restless somebody is, is told by his own track, so that who turns is not pulled straight.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from gtm_hit.stitching.motion import SPEED
from gtm_hit.stitching.tracks import Floats, Ids

UNRESTS = (0.03, 0.1, 0.2, 0.4, 0.8, 1.6)  # m/s in one second, from standing to running about
LEAST = 4  # frames from which anything can be told
FAR = 1e4  # square metres: somebody can begin anywhere


def smoothed(frames: Ids, xy: Floats, noise: Floats, seconds: float) -> Floats:
    """Places (K, 2), each drawn towards the way all tell; `noise` (K,) are their deviations in metres."""
    if len(frames) < LEAST:
        return xy
    pattern = tuple((frames - frames[0]).tolist())
    spread = tuple(np.round(noise, 4).tolist())
    middle = xy.mean(axis=0)
    likely = [_fit(pattern, spread, seconds, unrest) for unrest in UNRESTS]
    costs = [float(((xy - middle) * (inverse @ (xy - middle))).sum()) + 2 * log for _, inverse, log in likely]
    drawn: Floats = middle + likely[int(np.argmin(costs))][0] @ (xy - middle)
    return drawn


@lru_cache(maxsize=8192)
def _fit(
    pattern: tuple[int, ...], noise: tuple[float, ...], seconds: float, unrest: float
) -> tuple[Floats, Floats, float]:
    """The smoother (K, K), the inverse covariance of what is seen, and the log of its determinant."""
    times = np.array(pattern) * seconds
    early, late = np.minimum.outer(times, times), np.maximum.outer(times, times)
    way: Floats = FAR + SPEED**2 * np.outer(times, times) + unrest**2 * (early**2 * late / 2 - early**3 / 6)
    seen = way + np.diag(np.array(noise) ** 2)
    inverse: Floats = np.linalg.inv(seen).astype(np.float64)
    return way @ inverse, inverse, float(np.linalg.slogdet(seen)[1])
