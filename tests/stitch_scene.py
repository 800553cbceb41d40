"""Accepted batches of people who walk, as stitching finds them in the database."""

from __future__ import annotations

import uuid
from collections.abc import Mapping, Sequence

from django.utils import timezone

from gtm_hit.models import Assignment, Batch, Campaign, Dataset, Frame, Layer
from gtm_hit.ops.frames import saving
from tests.work_scene import make_dataset, make_layer, make_worker, row

COLUMNS = 400
Walks = Mapping[int, tuple[int, int, int, int]]  # column, row at the first frame; steps of both per frame

TWO: Walks = {1: (100, 100, 10, 0), 2: (100, 200, 10, 0)}


def position(walk: tuple[int, int, int, int], index: int) -> int:
    column, line, right, up = walk
    return (line + up * index) * COLUMNS + column + right * index


def accept(
    dataset: Dataset,
    number: int,
    indices: Sequence[int],
    walks: Walks,
    *,
    names: Mapping[int, int] | None = None,
    copy: int = 1,
    campaign: Campaign | None = None,
    shift: int = 0,
) -> Assignment:
    """A worker's accepted batch: the frames with these indices; everybody `shift` columns to the right."""
    frames = list(dataset.frames.order_by("number"))
    batch = Batch.objects.create(dataset=dataset, campaign=campaign, number=number, copy=copy)
    batch.frames.set([frames[index] for index in indices])
    worker = make_worker(f"worker-{number}-{copy}-{campaign}")
    layer = make_layer(dataset, f"work-{uuid.uuid4().hex[:8]}")
    for index in indices:
        people = [
            row(names[person] if names else person, position(walk, index) + shift)
            for person, walk in walks.items()
        ]
        saving.save_frame(layer, frames[index], None, uuid.uuid4(), 0, people, done=True, nobody=not people)
    Layer.objects.filter(pk=layer.pk).update(kind=Layer.Kind.ASSIGNMENT)
    now = timezone.now()
    return Assignment.objects.create(
        batch=batch,
        worker=worker,
        layer=layer,
        state=Assignment.State.ACCEPTED,
        expires_at=now,
        submitted_at=now,
    )


def two_batches(dataset: Dataset | None = None) -> tuple[Dataset, list[Assignment]]:
    """Neighbours that share frame 9; the second worker numbers people the other way round."""
    dataset = dataset or make_dataset(images=True)
    return dataset, [
        accept(dataset, 1, range(0, 10), TWO),
        accept(dataset, 2, range(9, 20), TWO, names={1: 2, 2: 1}),
    ]


def doubtful(dataset: Dataset | None = None, pairs: int = 1) -> Dataset:
    """Per pair somebody who could go on as either of two."""
    dataset = dataset or make_dataset(images=True)
    before = {n: (100, 40 + 60 * n, 0, 0) for n in range(pairs)}
    after = {
        2 * n + side: (100 + 7 * (2 * side - 1), 40 + 60 * n, 0, 0) for n in range(pairs) for side in (0, 1)
    }
    accept(dataset, 1, range(0, 10), before)
    accept(dataset, 2, range(10, 20), after)
    return dataset


def frame_at(dataset: Dataset, index: int) -> Frame:
    return dataset.frames.order_by("number")[index]
