"""People just outside a batch, for carrying over across its border: only from accepted assignments."""

from __future__ import annotations

from dataclasses import dataclass, field

from gtm_hit.models import Annotation, Assignment, Batch, Frame
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.frames.saving import rows_by_frame
from gtm_hit.ops.review.mending import layer_that_counts

# Frames on each side: as many as a movement is read from.
REACH = 4


@dataclass(frozen=True)
class NeighbourFrame:
    number: int
    annotations: list[Row]


@dataclass(frozen=True)
class Neighbours:
    """Frames beside a batch, nearest first."""

    before: list[NeighbourFrame] = field(default_factory=list)
    after: list[NeighbourFrame] = field(default_factory=list)


def neighbours(batch: Batch) -> Neighbours:
    """At most five queries; one when nothing beside the batch is accepted."""
    accepted = accepted_beside(batch)
    return Neighbours(
        before=nearest_frames(batch, accepted.get(batch.number - 1), "-number"),
        after=nearest_frames(batch, accepted.get(batch.number + 1), "number"),
    )


def accepted_beside(batch: Batch) -> dict[int, Assignment]:
    """By batch number; where several copies were accepted, the one of this batch's own copy."""
    found = Assignment.objects.select_related("batch", "mend").filter(
        batch__dataset=batch.dataset_id,
        batch__campaign=batch.campaign_id,
        batch__number__in=[batch.number - 1, batch.number + 1],
        state=Assignment.State.ACCEPTED,
    )
    own_copy_last = sorted(found, key=lambda one: (one.batch.copy == batch.copy, -one.batch.copy))
    return {one.batch.number: one for one in own_copy_last}


def nearest_frames(batch: Batch, assignment: Assignment | None, order: str) -> list[NeighbourFrame]:
    """Outside the batch: what neighbours overlap in, every one of them annotates for himself."""
    if assignment is None:
        return []
    beside = Frame.objects.filter(batches=assignment.batch_id).exclude(batches=batch.pk)
    frames = list(beside.order_by(order)[:REACH])
    annotations = Annotation.objects.filter(layer=layer_that_counts(assignment))
    people = rows_by_frame(annotations, [frame.pk for frame in frames])
    return [NeighbourFrame(frame.number, people[frame.pk]) for frame in frames]
