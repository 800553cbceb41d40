"""Accepted assignments as the batches of the pure room."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from gtm_hit.models import Annotation, Assignment, Batch, Frame
from gtm_hit.ops.jobs.progress import Progress
from gtm_hit.ops.review.mending import layer_that_counts
from gtm_hit.ops.stitching.scope import Scope
from gtm_hit.stitching import tracks
from gtm_hit.stitching.tracks import Ids

READING = "reading accepted batches"
BATCHES_AT_ONCE = 100
ROWS_AT_ONCE = 10_000
ROW = np.dtype([(name, "i8") for name in ("layer", "frame", "person", "position")])


@dataclass(frozen=True, eq=False)
class Accepted:
    assignments: list[Assignment]
    groups: list[list[tracks.Batch]]  # the replicas of each batch
    layers: list[list[int]]  # whose they are, in the same order
    frames: list[int]  # ids of the dataset's frames; the index is the instant


def read(scope: Scope, report: Progress) -> Accepted:
    ordered = Frame.objects.filter(dataset=scope.dataset).order_by("number")
    frames = list(ordered.values_list("pk", flat=True))
    instant = {pk: index for index, pk in enumerate(frames)}
    assignments = list(scope.accepted())
    made: dict[int, tracks.Batch] = {}
    for start in range(0, len(assignments), BATCHES_AT_ONCE):
        report(READING, start, len(assignments))
        made |= _batches(assignments[start : start + BATCHES_AT_ONCE], scope, instant)
    report(READING, len(assignments), len(assignments))
    replicas = [list(each) for _, each in groupby(assignments, key=lambda one: one.batch.number)]
    return Accepted(
        assignments,
        [[made[layer_that_counts(one)] for one in group] for group in replicas],
        [[layer_that_counts(one) for one in group] for group in replicas],
        frames,
    )


def _batches(
    assignments: Sequence[Assignment], scope: Scope, instant: dict[int, int]
) -> dict[int, tracks.Batch]:
    """By layer."""
    covered: dict[int, list[int]] = {one.batch_id: [] for one in assignments}
    links = Batch.frames.through.objects.filter(batch__in=list(covered))
    for batch, frame in links.values_list("batch_id", "frame_id"):
        covered[batch].append(instant[frame])
    rows = Annotation.objects.filter(layer__in=[layer_that_counts(one) for one in assignments]).order_by()
    found = rows.values_list("layer_id", "frame_id", "person", "position")
    table = np.fromiter(found.iterator(ROWS_AT_ONCE), ROW)
    xy = scope.dataset.grid.metres(table["position"])
    instants: Ids = np.fromiter((instant[pk] for pk in table["frame"].tolist()), np.int64, len(table))
    made = {}
    for one in assignments:
        inside = np.isin(instants, covered[one.batch_id])
        layer = layer_that_counts(one)
        mine = np.flatnonzero((table["layer"] == layer) & inside)
        made[layer] = tracks.batch(
            layer, covered[one.batch_id], instants[mine], table["person"][mine], xy[mine]
        )
    return made
