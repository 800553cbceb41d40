"""Whom an assignment starts with, with the faults planted there.

All batches of a campaign that plants start with people, whether they have faults or not, and each frame looks
alike: revision 1, saved by nobody, everybody carried over and to be looked at.
"""

from __future__ import annotations

import uuid
from collections.abc import Iterable

import numpy as np

from gtm_hit.models import (
    Annotation,
    Assignment,
    Batch,
    Frame,
    Layer,
    LayerFrame,
    PlantedFault,
    Planting,
    Save,
)
from gtm_hit.ops.calibration.versions import in_place_id
from gtm_hit.ops.frames.neighbours import accepted_beside
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.frames.saving import rows_by_frame
from gtm_hit.ops.review.mending import layer_that_counts
from gtm_hit.scoring.faults import Fault, FaultKind, Positions, plant, planted

CARRIED, PROPOSED = Annotation.State.CARRIED.value, Annotation.Origin.PROPOSED.value


def prepare(assignment: Assignment) -> list[PlantedFault]:
    """Fill a new assignment's frames; once: again it changes nothing."""
    batch = assignment.batch
    planting = Planting.objects.filter(campaign=batch.campaign_id).first()
    if planting is None or LayerFrame.objects.filter(layer=assignment.layer_id).exists():
        return []
    frames = list(Frame.objects.filter(batches=batch).order_by("number"))
    people = starting_people(planting, batch, frames)
    if not people:
        return []
    faults = chosen_faults(planting, assignment, people)
    write(assignment, frames, with_faults(people, faults))
    return keep(assignment, frames, faults)


def starting_people(planting: Planting, batch: Batch, frames: list[Frame]) -> dict[int, list[Row]]:
    """By frame number, of the frames that have somebody."""
    chosen = planting.starting_layer_id
    sources = [chosen] if chosen else shared_work(batch)
    number_of = {frame.pk: frame.number for frame in frames}
    people: dict[int, list[Row]] = {}
    for layer in sources:
        found = rows_by_frame(Annotation.objects.filter(layer=layer), number_of)
        for frame_id, rows in found.items():
            if rows:
                people.setdefault(number_of[frame_id], [to_look_at(row) for row in rows])
    return people


def shared_work(batch: Batch) -> list[int]:
    """Layers of accepted work beside it: their frames that are this batch's too begin with it."""
    return [layer_that_counts(assignment) for _number, assignment in sorted(accepted_beside(batch).items())]


def to_look_at(row: Row) -> Row:
    return Row(row.person, row.position, CARRIED, PROPOSED, row.height, row.radius)


def chosen_faults(planting: Planting, assignment: Assignment, people: dict[int, list[Row]]) -> list[Fault]:
    """The same for the same batch and worker."""
    batch = assignment.batch
    rng = np.random.default_rng([planting.seed, batch.number, batch.copy, assignment.worker_id])
    if rng.random() >= planting.share:
        return []
    kinds = [FaultKind(kind) for kind in planting.kinds]
    places = {number: positions(rows) for number, rows in people.items()}
    return plant(places, batch.dataset.grid, kinds, planting.faults, rng)


def positions(rows: Iterable[Row]) -> Positions:
    return {row.person: row.position for row in rows}


def with_faults(people: dict[int, list[Row]], faults: list[Fault]) -> dict[int, list[Row]]:
    """Sizes belong to bodies: where numbers are exchanged they stay with the place."""
    shown = planted({number: positions(rows) for number, rows in people.items()}, faults)
    return {
        number: [
            moved(whose(people[number], person, place), person, place)
            for person, place in sorted(places.items())
        ]
        for number, places in shown.items()
    }


def whose(rows: list[Row], person: int, place: int) -> Row:
    """Whose size somebody has: an invented person is as large as one of the others."""
    here = [row for row in rows if row.position == place]
    same = [row for row in rows if row.person == person]
    return next(iter(here or same), rows[person % len(rows)])


def moved(row: Row, person: int, position: int) -> Row:
    return Row(person, position, CARRIED, PROPOSED, row.height, row.radius)


def write(assignment: Assignment, frames: list[Frame], people: dict[int, list[Row]]) -> None:
    """Every frame of the batch gets its first revision when any does, so that none stands out."""
    layer = assignment.layer
    heads = LayerFrame.objects.bulk_create(
        LayerFrame(layer=layer, frame=frame, revision=1) for frame in frames
    )
    version = in_place_id(layer.dataset_id)
    Save.objects.bulk_create(
        Save(
            layer_frame=head,
            revision=1,
            save_id=uuid.uuid4(),
            annotations=[row.as_dict() for row in people.get(frame.number, [])],
            calibration_id=version,
        )
        for head, frame in zip(heads, frames, strict=True)
    )
    Annotation.objects.bulk_create(
        Annotation(layer=layer, frame=frame, **row.as_dict())
        for frame in frames
        for row in people.get(frame.number, [])
    )
    largest = max((row.person for rows in people.values() for row in rows), default=0)
    Layer.objects.filter(pk=layer.pk).update(last_person=largest)


def keep(assignment: Assignment, frames: list[Frame], faults: list[Fault]) -> list[PlantedFault]:
    frame_of = {frame.number: frame for frame in frames}
    return PlantedFault.objects.bulk_create(
        PlantedFault(
            assignment=assignment,
            frame=frame_of[fault.frame],
            kind=fault.kind.value,
            person=fault.person,
            other=fault.other,
            position_from=fault.right,
            position_to=fault.wrong,
        )
        for fault in faults
    )
