"""The annotations of one layer as plain arrays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]


class MetricsError(ValueError):
    """Annotations that cannot be measured; says which value."""


@dataclass(frozen=True, eq=False)
class Annotations:
    """One row per annotation, in any order."""

    frames: Ids  # (N,) frame numbers
    xy: Floats  # (N, 2) metres on the ground
    persons: Ids | None = None  # (N,) identities; None where there are none, as in most detectors' files

    def __post_init__(self) -> None:
        frames = _whole("frames", self.frames)
        xy = np.asarray(self.xy, dtype=np.float64)
        if xy.size == 0:
            xy = xy.reshape(0, 2)
        if xy.shape != (len(frames), 2):
            raise MetricsError(f"xy has shape {xy.shape}, not ({len(frames)}, 2)")
        if not np.isfinite(xy).all():
            raise MetricsError(f"xy of row {int(np.argmin(np.isfinite(xy).all(axis=1)))} is not finite")
        object.__setattr__(self, "frames", frames)
        object.__setattr__(self, "xy", xy)
        if self.persons is not None:
            object.__setattr__(self, "persons", self._checked_persons(frames))

    def __len__(self) -> int:
        return len(self.frames)

    def _checked_persons(self, frames: Ids) -> Ids:
        persons = _whole("persons", self.persons)
        if len(persons) != len(frames):
            raise MetricsError(f"{len(persons)} persons for {len(frames)} annotations")
        pairs = np.column_stack((frames, persons))
        unique, counts = np.unique(pairs, axis=0, return_counts=True)
        if (counts > 1).any():
            frame, person = unique[counts > 1][0].tolist()
            raise MetricsError(f"person {person} is annotated more than once in frame {frame}")
        return persons

    def identities(self) -> Ids:
        """The persons; raises MetricsError where there are none."""
        if self.persons is None:
            raise MetricsError("these annotations carry no identities")
        return self.persons

    def take(self, rows: Ids) -> Annotations:
        persons = None if self.persons is None else self.persons[rows]
        return Annotations(self.frames[rows], self.xy[rows], persons)


def by_frame(truth: Annotations, found: Annotations) -> Iterator[tuple[int, Ids, Ids]]:
    """Every frame that either side knows, ascending, with the rows of each side in it."""
    numbers = np.union1d(truth.frames, found.frames)
    truth_rows, truth_ends = _grouped(truth.frames, numbers)
    found_rows, found_ends = _grouped(found.frames, numbers)
    for i, number in enumerate(numbers.tolist()):
        yield (
            number,
            truth_rows[truth_ends[i] : truth_ends[i + 1]],
            found_rows[found_ends[i] : found_ends[i + 1]],
        )


def _grouped(frames: Ids, numbers: Ids) -> tuple[Ids, Ids]:
    order = np.argsort(frames, kind="stable")
    starts = np.searchsorted(frames[order], numbers, side="left")
    return order, np.append(starts, len(frames))


def _whole(name: str, values: ArrayLike | None) -> Ids:
    array: NDArray[Any] = np.asarray(values)
    if array.size == 0:
        return np.zeros(0, dtype=np.int64)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise MetricsError(
            f"{name} must be a list of whole numbers, not {array.dtype} of shape {array.shape}"
        )
    return array.astype(np.int64)
