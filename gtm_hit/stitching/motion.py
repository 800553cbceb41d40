"""Where somebody is and how he moves at an end of his track, told by the frames before or after it.

A Kalman filter of constant velocity with white acceleration. How much each frame counts depends on the
pattern of frames alone, so that it is worked out once per pattern, not once per person.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gtm_hit.stitching.rules import Rules
from gtm_hit.stitching.tracks import Floats, Ids, Track

REACH = 8  # frames an end is told by
RESTLESS = 0.45  # m/s in one second: by how much walking people change their velocity
SPEED = 1.2  # m/s in X and in Y, of people nobody has seen move
ANYWHERE = 1e4  # square metres


@dataclass(frozen=True, eq=False)
class Ends:
    """One row per person: state at the time of the track's last (or first) place, per axis."""

    frames: Ids  # (N,)
    xy: Floats  # (N, 2) metres
    velocity: Floats  # (N, 2) metres per second
    spread: Floats  # (N, 2, 2) covariance of place and velocity, the same in X and in Y


def ends(tracks: Sequence[Track], rules: Rules) -> Ends:
    """How tracks end."""
    return _told([(track.frames[-REACH:], track.xy[-REACH:]) for track in tracks], 1, rules)


def beginnings(tracks: Sequence[Track], rules: Rules) -> Ends:
    """How tracks begin: the same, with time turned back and the velocity forward again."""
    return _told([(track.frames[:REACH][::-1], track.xy[:REACH][::-1]) for track in tracks], -1, rules)


def advanced(spread: Floats, seconds: Floats) -> Floats:
    """The covariance (..., 2, 2) after (or, negative, before) some time."""
    step = np.zeros((*seconds.shape, 2, 2))
    step[..., 0, 0] = step[..., 1, 1] = 1.0
    step[..., 0, 1] = seconds
    moved: Floats = step @ spread @ np.swapaxes(step, -1, -2) + _unrest(seconds)
    return moved


def _unrest(seconds: Floats) -> Floats:
    time = np.abs(seconds)
    sign = np.sign(seconds)
    unrest = np.empty((*seconds.shape, 2, 2))
    unrest[..., 0, 0] = time**3 / 3
    unrest[..., 0, 1] = unrest[..., 1, 0] = sign * time**2 / 2
    unrest[..., 1, 1] = time
    return RESTLESS**2 * unrest


def _told(pieces: Sequence[tuple[Ids, Floats]], direction: int, rules: Rules) -> Ends:
    states, spreads = np.zeros((len(pieces), 2, 2)), np.zeros((len(pieces), 2, 2))
    for row, (frames, xy) in enumerate(pieces):
        pattern = tuple(np.abs(frames - frames[-1]).tolist())
        gain, spread = _filter(pattern, rules.seconds, rules.noise)
        # Places against the last one: the filter begins anywhere, and forgets it to some digits only.
        states[row] = gain @ (xy - xy[-1]) + [xy[-1], (0.0, 0.0)]
        spreads[row] = spread
    if direction < 0:
        states[:, 1] *= -1
        spreads[:, 0, 1] *= -1
        spreads[:, 1, 0] *= -1
    last = np.array([int(frames[-1]) for frames, _ in pieces], dtype=np.int64)
    return Ends(last, states[:, 0], states[:, 1], spreads)


@lru_cache(maxsize=4096)
def _filter(pattern: tuple[int, ...], seconds: float, noise: float) -> tuple[Floats, Floats]:
    """Weights (2, K) of the places in the last place and velocity, and their covariance.

    pattern : how many frames before the last one each place is, descending to 0
    """
    count = len(pattern)
    gain, spread = np.zeros((2, count)), np.diag([ANYWHERE, SPEED**2])
    for index, before in enumerate(pattern):
        if index:
            time = (pattern[index - 1] - before) * seconds
            gain = np.array([[1.0, time], [0.0, 1.0]]) @ gain
            spread = advanced(spread, np.array(time))
        weight = spread[:, 0] / (spread[0, 0] + noise**2)
        seen = np.zeros(count)
        seen[index] = 1.0
        gain = gain + np.outer(weight, seen - gain[0])
        spread = spread - np.outer(weight, spread[0])
    return gain, spread
