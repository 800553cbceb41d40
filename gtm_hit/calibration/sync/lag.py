"""How much later one series tells what another one tells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from gtm_hit.calibration.sync.series import Floats, Series, SyncError

SLOW = 4.0  # seconds; what changes more slowly, as light does, is not compared
CHANNELS_AT_ONCE = 128
AROUND_PEAK = 3  # samples on both sides of the peak that tell its top
NEAR = 0.4  # seconds
OTHER_PEAK = 1.5  # seconds from the peak; what is as good there makes it doubtful
LEAST_SHARED = 4.0  # seconds both must last side by side
SURE, CLEAR = 7.0, 1.25


@dataclass(frozen=True)
class Lag:
    """What the first video has at t, the second one has at `t + seconds`."""

    seconds: float
    alike: float  # correlation, 0 … 1
    outstanding: float  # how many deviations of chance the peak is high
    clear: float  # the peak relative to the best one elsewhere

    @property
    def sure(self) -> bool:
        return self.outstanding >= SURE and self.clear >= CLEAR


def lag_between(first: Series, second: Series, about: float | None = None) -> Lag:
    """`about`: the peak is looked for near these seconds only.

    Raises SyncError where they have no channel in common or are too short.
    """
    step = first.step
    both = first.known & second.known
    if not both.any():
        raise SyncError("they share no ground")
    one, other = _fast(first.values[:, both], step), _fast(second.values[:, both], step)
    alike, shared = _correlogram(one, other)
    usable = shared * step >= LEAST_SHARED
    if not usable.any():
        raise SyncError(f"they are shorter than {LEAST_SHARED:.0f} s")
    # Few shared seconds are alike by chance: what the correlation is worth grows with their square root.
    worth = np.where(usable, alike * np.sqrt(shared * step), 0)
    begin = second.start - first.start - (len(one) - 1) * step  # seconds of the first shift
    near = worth if about is None else np.where(_near(len(worth), step, about - begin), worth, -np.inf)
    top = int(np.argmax(near))
    seconds = begin + _summit(alike, top) * step
    return Lag(seconds, float(alike[top]), *_standing_out(worth, usable, top, step))


def _fast(values: Floats, step: float) -> Floats:
    """Without what changes slowly."""
    window = max(round(SLOW / step), 1)
    padded = np.concatenate((np.zeros((1, values.shape[1])), values.cumsum(axis=0, dtype=np.float64)))
    at = np.arange(len(values))
    low, high = np.maximum(at - window // 2, 0), np.minimum(at + window // 2 + 1, len(values))
    means = (padded[high] - padded[low]) / (high - low)[:, None]
    return (values - means).astype(np.float32)


def _correlogram(one: Floats, other: Floats) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Correlation for all shifts of `other`, from `-(len(one) - 1)` on, and how many samples they share."""
    size = next_fast_len(len(one) + len(other) - 1, real=True)
    spectrum = np.zeros(size // 2 + 1, np.complex128)
    for start in range(0, one.shape[1], CHANNELS_AT_ONCE):
        part = slice(start, start + CHANNELS_AT_ONCE)
        # Along rows that lie together in memory this takes a fraction of the time.
        ahead, behind = (rfft(np.ascontiguousarray(values[:, part].T), size) for values in (one, other))
        spectrum += (np.conj(ahead) * behind).sum(axis=0)
    sums = irfft(spectrum, size)
    shifts = np.arange(-(len(one) - 1), len(other))
    # Sample t of `one` lies beside t + shift of `other`.
    first, last = np.maximum(0, -shifts), np.minimum(len(one), len(other) - shifts)
    energy = _energy(one, first, last) * _energy(other, first + shifts, last + shifts)
    alike = np.where(energy > 0, sums[shifts % size] / np.sqrt(np.maximum(energy, 1e-30)), 0)
    return np.clip(alike, -1, 1), last - first


def _energy(values: Floats, first: NDArray[np.int64], last: NDArray[np.int64]) -> NDArray[np.float64]:
    squares = np.concatenate(([0.0], np.square(values, dtype=np.float64).sum(axis=1).cumsum()))
    return np.asarray(squares[last] - squares[first])


def _near(count: int, step: float, seconds: float) -> NDArray[np.bool_]:
    return np.asarray(np.abs(np.arange(count) * step - seconds) <= NEAR)


def _summit(alike: NDArray[np.float64], top: int) -> float:
    """Where a parabola through the values around the peak has its top, in samples."""
    reach = AROUND_PEAK
    at = np.arange(max(top - reach, 0), min(top + reach + 1, len(alike)))
    if len(at) < 3:
        return float(top)
    bend, slope, _ = np.polyfit(at - top, alike[at], 2)
    return top + float(np.clip(-slope / (2 * bend), -reach, reach)) if bend < 0 else float(top)


def _standing_out(
    worth: NDArray[np.float64], usable: NDArray[np.bool_], top: int, step: float
) -> tuple[float, float]:
    away = usable & (np.abs(np.arange(len(worth)) - top) > OTHER_PEAK / step)
    if not away.any():
        return 0.0, 0.0
    others = worth[away]
    middle = float(np.median(others))
    spread = 1.48 * float(np.median(np.abs(others - middle)))
    height = float(worth[top])
    return (height - middle) / max(spread, 1e-9), height / max(float(others.max()), 1e-9)
