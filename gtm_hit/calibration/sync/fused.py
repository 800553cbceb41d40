"""Several series whose clocks are known to each other, as one: what they agree on."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from gtm_hit.calibration.sync.series import Flags, Floats, Series

FLOOR = 0.02  # somebody hidden in one view is not nobody


def fused(members: Mapping[int, Series], offsets: Mapping[int, float]) -> Series:
    """The geometric mean of those who know, instant by instant and channel by channel, on the shared clock.

    A person's motion fills in one view every cell along a line; where the lines of two views cross, it was.
    """
    step = next(iter(members.values())).step
    begins = {key: each.start - offsets[key] for key, each in members.items()}
    start = min(begins.values())
    end = max(begins[key] + each.seconds for key, each in members.items())
    count = round((end - start) / step)
    channels = next(iter(members.values())).values.shape[1]
    total, voices = np.zeros((count, channels), np.float32), np.zeros((count, channels), np.uint8)
    for key, each in members.items():
        first, moved = _moved(each, begins[key] - start)
        part = slice(max(first, 0), min(first + len(moved), count))
        moved = moved[part.start - first : part.stop - first]
        total[part] += np.log(moved + np.float32(FLOOR)) * each.known
        voices[part] += each.known
    several = voices > 0
    mean = np.exp(total / np.maximum(voices, 1)) - np.float32(FLOOR)
    return Series(start, step, np.where(several, np.maximum(mean, 0), 0).astype(np.float32), _known(members))


def _known(members: Mapping[int, Series]) -> Flags:
    return np.any([each.known for each in members.values()], axis=0)


def _moved(each: Series, away: float) -> tuple[int, Floats]:
    """The values on a clock that begins `away` seconds earlier: the first one's index there, and all."""
    first = int(np.ceil(away / each.step - 1e-9))
    share = np.float32(first - away / each.step)
    values = each.values
    if share < 1e-6:
        return first, values
    return first, values[:-1] * (1 - share) + values[1:] * share
