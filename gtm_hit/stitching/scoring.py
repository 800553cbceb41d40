"""How well a track goes on in another: log odds of one person against two."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gtm_hit.stitching.motion import SPEED, Ends, advanced, beginnings, ends
from gtm_hit.stitching.rules import Rules
from gtm_hit.stitching.tracks import Floats, Ids, Track

NEWCOMERS = 0.01  # people per square metre who could have been there instead
TAILS = 5.0  # degrees of freedom: people turn, and workers slip, more often than a normal distribution allows
# Log odds where two workers would have had to overlook one each, 3 % of the time, in a frame they share.
BOTH_MISSED = 7.0
STRIDE = 2.5  # metres per second nobody who is predicted deviates by


def log_odds(before: Sequence[Track], after: Sequence[Track], rules: Rules) -> Floats:
    """(N, M); -inf where a pair is out of the question."""
    last, first = ends(before, rules), beginnings(after, rules)
    odds, away = _by_motion(last, first, rules)
    waited = first.frames[None, :] - last.frames[:, None]
    odds[(waited > rules.gap + 1) | (away > _reach(waited, rules))] = -np.inf
    for row, column in np.argwhere((waited <= 0) & np.isfinite(odds)).tolist():
        if (apart := mean_distance(before[row], after[column])) is not None:
            odds[row, column] = _by_common_frames(apart, last, first, row, column, rules)
        elif _contradict(before[row], after[column]):
            odds[row, column] = -np.inf
    return odds


def mean_distance(one: Track, other: Track) -> float | None:
    """Metres over the common frames; None without."""
    _, rows, others = np.intersect1d(one.frames, other.frames, assume_unique=True, return_indices=True)
    if not len(rows):
        return None
    return float(np.hypot(*(one.xy[rows] - other.xy[others]).T).mean())


def _by_motion(last: Ends, first: Ends, rules: Rules) -> tuple[Floats, Floats]:
    """Log odds, and the metres between where one is expected and the other is found."""
    waited = (first.frames[None, :] - last.frames[:, None]).astype(np.float64)
    seconds: Floats = waited * rules.seconds
    expected = last.xy[:, None] + last.velocity[:, None] * seconds[..., None]
    apart = np.stack((first.xy[None] - expected, first.velocity[None] - last.velocity[:, None]), axis=-1)
    spread = advanced(last.spread[:, None], seconds) + first.spread[None]
    off = np.einsum("...ai,...ij,...aj->...", apart, np.linalg.inv(spread), apart)
    found = _density(off, np.linalg.det(spread)) - _chance(first.velocity)[None]
    return found, np.hypot(*np.moveaxis(apart[..., 0], -1, 0))


def _by_common_frames(apart: float, last: Ends, first: Ends, row: int, column: int, rules: Rules) -> float:
    """Two workers saw them at once: as far apart as they put them, and moving as differently."""
    if apart > rules.gate:
        return -math.inf
    waited = abs(int(first.frames[column] - last.frames[row])) * rules.seconds
    place = 2 * rules.noise**2
    speed = float(last.spread[row, 1, 1] + first.spread[column, 1, 1]) + SPEED**2 * waited
    faster = float(((first.velocity[column] - last.velocity[row]) ** 2).sum())
    off = np.array(apart**2 / place + faster / speed)
    return float(_density(off, np.array(place * speed)) - _chance(first.velocity[column])) + BOTH_MISSED


def _density(off: Floats, determinant: Floats) -> Floats:
    """Log of a t distribution in four dimensions, whose two axes share one covariance."""
    constant = math.lgamma((TAILS + 4) / 2) - math.lgamma(TAILS / 2) - 2 * math.log(TAILS * math.pi)
    logs: Floats = constant - np.log(determinant) - (TAILS + 4) / 2 * np.log1p(off / TAILS)
    return logs


def _chance(velocity: Floats) -> Floats:
    """Log density of somebody else who happens to begin there, moving so."""
    speeds = (velocity**2).sum(axis=-1)
    logs: Floats = math.log(NEWCOMERS) - math.log(2 * math.pi * SPEED**2) - speeds / (2 * SPEED**2)
    return logs


def _reach(waited: Ids, rules: Rules) -> Floats:
    reach: Floats = rules.gate + STRIDE * np.abs(waited) * rules.seconds
    return reach


def _contradict(one: Track, other: Track) -> bool:
    """Interleaved over more than a slip: nobody is in one place for one worker only, again and again."""
    begin, end = max(one.first, other.first), min(one.last, other.last)
    inside = ((one.frames >= begin) & (one.frames <= end)).sum()
    return bool(inside + ((other.frames >= begin) & (other.frames <= end)).sum() > 3)
