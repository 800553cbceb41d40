"""Offsets of all videos out of what they have in common, the surest first."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from gtm_hit.calibration.sync.fused import fused
from gtm_hit.calibration.sync.lag import Lag, lag_between
from gtm_hit.calibration.sync.series import Series, SyncError
from gtm_hit.geometry.steps import Steps


def silent(_done: int, _total: int) -> None:
    pass


KNOWN_BY = 4.0  # deviations of chance; a pair that tells less has no say in the end
ROUNDS = 20
QUARREL = 0.03  # seconds; pairs that disagree by more weigh less


@dataclass(frozen=True)
class Found:
    """One video's place: `offset` in seconds relative to the first one found, and how it was told."""

    offset: float
    lag: Lag


@dataclass(frozen=True)
class _Pair:
    first: int
    second: int
    lag: Lag


def align(series: Sequence[Series], progress: Steps = silent) -> list[Found | None]:
    """By video; None for those that have nothing in common with the others.

    Raises SyncError where no two have.
    """
    total = len(series) * (len(series) - 1)
    found = _first_two(series, lambda done: progress(done, total))
    while rest := [key for key in range(len(series)) if key not in found]:
        if (following := _next(series, found, rest)) is None:
            break
        found[following[0]] = following[1]
    pairs = list(_pairs(series, found))
    progress(total, total)
    offsets = _settled(found, pairs)
    return [replace(found[key], offset=offsets[key]) if key in found else None for key in range(len(series))]


def _first_two(series: Sequence[Series], progress: Callable[[int], object]) -> dict[int, Found]:
    lags = {}
    for done, (first, second) in enumerate(combinations(range(len(series)), 2)):
        progress(done)
        try:
            lags[first, second] = lag_between(series[first], series[second])
        except SyncError:
            continue  # two that share no ground may each share some with a third
    sure = {pair: lag for pair, lag in lags.items() if lag.sure}
    if not sure:
        raise SyncError("these videos show no common motion")
    first, second = max(sure, key=lambda pair: sure[pair].outstanding)
    lag = sure[first, second]
    return {first: Found(0.0, lag), second: Found(lag.seconds, lag)}


def _next(series: Sequence[Series], found: dict[int, Found], rest: Sequence[int]) -> tuple[int, Found] | None:
    """The surest of the rest, laid beside all that are found."""
    offsets = {key: place.offset for key, place in found.items()}
    together = fused({key: series[key] for key in found}, offsets)
    tried = {}
    for key in rest:
        try:
            tried[key] = lag_between(together, series[key])
        except SyncError:
            continue
    sure = [key for key, lag in tried.items() if lag.sure]
    if not sure:
        return None
    best = max(sure, key=lambda key: tried[key].outstanding)
    return best, Found(tried[best].seconds, tried[best])


def _pairs(series: Sequence[Series], found: dict[int, Found]) -> Iterator[_Pair]:
    """What every two say of each other near where they were put."""
    for first, second in combinations(sorted(found), 2):
        try:
            about = found[second].offset - found[first].offset
            lag = lag_between(series[first], series[second], about)
        except SyncError:
            continue
        if lag.outstanding >= KNOWN_BY:
            yield _Pair(first, second, lag)


def _settled(found: dict[int, Found], pairs: Sequence[_Pair]) -> dict[int, float]:
    """Offsets that fit all pairs; one with an error of its own loses weight, round by round."""
    keys = sorted(found)
    at = {key: column for column, key in enumerate(keys)}
    offsets = np.array([found[key].offset for key in keys])
    place = offsets.copy()
    for _ in range(ROUNDS):
        # What no pair speaks of stays where it is, and all together where they were.
        rows, wanted = [np.eye(len(keys)) * 1e-3], [offsets * 1e-3]
        for pair in pairs:
            row = np.zeros((1, len(keys)))
            row[0, at[pair.second]], row[0, at[pair.first]] = 1, -1
            quarrel = abs(pair.lag.seconds - float(row[0] @ place))
            weight = pair.lag.outstanding / max(1.0, quarrel / QUARREL) ** 0.5
            rows.append(row * weight)
            wanted.append(np.array([pair.lag.seconds * weight]))
        place = np.linalg.lstsq(np.vstack(rows), np.concatenate(wanted), rcond=None)[0]
    return dict(zip(keys, place.tolist(), strict=True))
