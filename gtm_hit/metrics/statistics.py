"""What a paper prints about a dataset: how many, how long, how fast, how tall, and in how many views."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gtm_hit.metrics.annotations import Annotations, Floats, Ids, MetricsError


@dataclass(frozen=True)
class Distribution:
    """The shape of a set of values in a few numbers; NaN where there are no values."""

    count: int
    mean: float
    deviation: float
    least: float
    p05: float
    median: float
    p95: float
    most: float


@dataclass(frozen=True, eq=False)
class Visibility:
    """Of N annotations in C views."""

    per_view: Ids  # (C,) annotations visible in each view
    exactly: Ids  # (C + 1,) annotations visible in exactly 0, 1, … C views

    @property
    def mean_views(self) -> float:
        """Views per annotation."""
        annotations = int(self.exactly.sum())
        return int(self.per_view.sum()) / annotations if annotations else float("nan")


@dataclass(frozen=True, eq=False)
class Tracks:
    """One row per person."""

    persons: Ids  # ascending
    annotations: Ids  # frames the person is annotated in
    span: Ids  # frames from the first to the last, both counted, also those in between without an annotation
    path: Floats  # metres walked along the annotations


@dataclass(frozen=True)
class Summary:
    frames: int
    people: int
    annotations: int
    people_per_frame: Distribution
    track_annotations: Distribution
    track_path: Distribution  # metres
    speed: Distribution  # metres per second
    height: Distribution  # metres


def distribution(values: ArrayLike) -> Distribution:
    array = np.asarray(values, dtype=np.float64)
    if not array.size:
        return Distribution(0, *[float("nan")] * 7)
    least, p05, median, p95, most = np.percentile(array, [0, 5, 50, 95, 100]).tolist()
    return Distribution(array.size, float(array.mean()), float(array.std()), least, p05, median, p95, most)


def visibility(visible: NDArray[np.bool_]) -> Visibility:
    """`visible` (N, C): is annotation n visible in view c."""
    if visible.ndim != 2:
        raise MetricsError(f"visible must be (annotations, views), not of shape {visible.shape}")
    exactly = np.bincount(visible.sum(axis=1), minlength=visible.shape[1] + 1)
    return Visibility(visible.sum(axis=0).astype(np.int64), exactly.astype(np.int64))


def people_per_frame(annotations: Annotations, frames: ArrayLike) -> Ids:
    """(F,) in ascending order of frame numbers."""
    numbers = _ascending(frames)
    return np.bincount(_order_in(numbers, annotations), minlength=len(numbers)).astype(np.int64)


def tracks_of(annotations: Annotations, frames: ArrayLike) -> Tracks:
    persons, starts, counts = np.unique(
        np.sort(annotations.identities()), return_index=True, return_counts=True
    )
    order = _order_in(_ascending(frames), annotations)
    rows = np.lexsort((order, annotations.identities()))
    lengths = np.hypot(*np.diff(annotations.xy[rows], axis=0).T) if len(rows) else np.zeros(0)
    # A step between the last annotation of one person and the first of the next is nobody's.
    lengths = np.append(0.0, lengths)[: len(rows)]
    lengths[starts] = 0.0
    path = np.add.reduceat(lengths, starts) if len(starts) else np.zeros(0)
    ordered = order[rows]
    span = ordered[starts + counts - 1] - ordered[starts] + 1 if len(starts) else np.zeros(0, np.int64)
    return Tracks(persons, counts.astype(np.int64), span.astype(np.int64), path)


def speeds(annotations: Annotations, frames: ArrayLike, seconds_per_frame: float) -> Floats:
    """Metres per second of every person between neighbouring frames; over a gap no speed is known."""
    if not seconds_per_frame > 0:
        raise MetricsError(f"seconds per frame must be positive, not {seconds_per_frame}")
    persons = annotations.identities()
    order = _order_in(_ascending(frames), annotations)
    rows = np.lexsort((order, persons))
    neighbours = (np.diff(persons[rows]) == 0) & (np.diff(order[rows]) == 1)
    step = np.diff(annotations.xy[rows], axis=0)[neighbours]
    walked: Floats = np.hypot(step[:, 0], step[:, 1])
    return walked / seconds_per_frame


def _ascending(frames: ArrayLike) -> Ids:
    return np.unique(np.asarray(frames, dtype=np.int64))


def _order_in(numbers: Ids, annotations: Annotations) -> Ids:
    """Which of the ascending frame numbers each annotation belongs to, counted from 0."""
    order = np.searchsorted(numbers, annotations.frames)
    unknown = annotations.frames[np.isin(annotations.frames, numbers, invert=True)]
    if len(unknown):
        raise MetricsError(f"frame {int(unknown[0])} is annotated but not among the frames")
    return order
