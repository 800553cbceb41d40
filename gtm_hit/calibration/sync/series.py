"""What a video does over its own time, as numbers on a steady clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float32]
Flags = NDArray[np.bool_]


class SyncError(ValueError):
    """Videos whose clocks cannot be told from what they show; says why."""


@dataclass(frozen=True, eq=False)
class Series:
    """Value n is at the second `start + n * step` of the video."""

    start: float  # seconds
    step: float  # seconds
    values: Floats  # (N, channels)
    known: Flags  # (channels,) those the video has anything to say about

    @property
    def seconds(self) -> float:
        return len(self.values) * self.step


def steady(times: Sequence[float], values: ArrayLike, step: float, known: Flags | None = None) -> Series:
    """Values (N, channels) at ascending, perhaps uneven times, interpolated onto a steady clock."""
    given = np.asarray(values, np.float32)
    if len(times) < 2:
        raise SyncError("there are fewer than two pictures to compare")
    at = np.asarray(times, np.float64)
    clock = np.arange(at[0], at[-1], step)
    after = np.clip(np.searchsorted(at, clock, side="right"), 1, len(at) - 1)
    share = ((clock - at[after - 1]) / (at[after] - at[after - 1])).astype(np.float32)[:, None]
    mixed = given[after - 1] * (1 - share) + given[after] * share
    return Series(float(at[0]), step, mixed, np.ones(given.shape[1], bool) if known is None else known)
