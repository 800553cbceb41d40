"""Planted faults are judged once, and what a worker left of them is taken out. Nobody downstream sees any."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import replace

from django.db import transaction
from django.db.models import QuerySet
from django.utils import timezone

from gtm_hit.models import Annotation, Assignment, Frame, Layer, LayerFrame, PlantedFault, Save
from gtm_hit.ops.calibration.versions import in_place_id
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.frames.saving import rows_by_frame, write_rows
from gtm_hit.ops.gold.planting import as_fault
from gtm_hit.scoring.faults import Positions, repaired, unplanted
from gtm_hit.scoring.undoing import Change, changes

Rows = dict[int, list[Row]]
"""By frame number."""


def withdraw(assignment: Assignment) -> list[PlantedFault]:
    """The assignment's faults as they were judged now; an empty list when there were none, or again.

    Called when work is submitted; whoever accepts work may call it once more. Each row says whether the fault
    was repaired, and which save took out the rest of it.
    """
    with transaction.atomic():
        rows = list(unjudged(assignment.layer).select_for_update(no_key=True, of=("self",)))
        if not rows:
            return []
        right, now = as_given(assignment.layer, rows), as_it_is(assignment.layer)
        faults = {as_fault(row): row for row in rows}
        grid = assignment.layer.dataset.grid
        places = positions(now)
        left = changes(list(faults), right, places, grid)
        saves = take_out(assignment.layer, now, [one for made in left.values() for one in made])
        for fault, row in faults.items():
            row.repaired = repaired(fault, right, places, grid)
            row.judged_at = timezone.now()
            row.withdrawn_by = next((saves[one.frame] for one in left.get(fault, [])), None)
        PlantedFault.objects.bulk_update(rows, ["repaired", "judged_at", "withdrawn_by"])
        return rows


def without_faults(layer: Layer) -> dict[int, list[Row]]:
    """Rows by frame id, of frames that still hold planted faults, as they are without; empty for most layers.

    For reading work that is not submitted yet: nothing is judged or written.
    """
    rows = list(unjudged(layer))
    if not rows:
        return {}
    now = as_it_is(layer)
    left = changes([as_fault(row) for row in rows], as_given(layer, rows), positions(now), layer.dataset.grid)
    made = [one for changed in left.values() for one in changed]
    frame_ids = dict(layer.dataset.frames.filter(number__in=list(now)).values_list("number", "pk"))
    numbers = {one.frame for one in made}
    return {frame_ids[number]: after(now, number, made) for number in numbers}


def unjudged(layer: Layer) -> QuerySet[PlantedFault]:
    return PlantedFault.objects.filter(assignment__layer=layer, judged_at=None).select_related("frame")


def as_given(layer: Layer, rows: Sequence[PlantedFault]) -> dict[int, Positions]:
    """What was right: the first revision, before the faults were planted in it."""
    first = Save.objects.filter(layer_frame__layer=layer, revision=1, worker=None, user=None)
    shown = {
        number: {one["person"]: one["position"] for one in people}
        for number, people in first.values_list("layer_frame__frame__number", "annotations")
    }
    return unplanted(shown, [as_fault(row) for row in rows])


def as_it_is(layer: Layer) -> Rows:
    frames = LayerFrame.objects.filter(layer=layer).values_list("frame_id", "frame__number")
    number_of = dict(frames)
    found = rows_by_frame(Annotation.objects.filter(layer=layer), number_of)
    return {number_of[frame_id]: rows for frame_id, rows in found.items()}


def positions(now: Rows) -> dict[int, Positions]:
    return {number: {row.person: row.position for row in rows} for number, rows in now.items()}


def after(now: Rows, number: int, made: Sequence[Change]) -> list[Row]:
    """One frame's rows after the changes; who is moved or renamed keeps everything else."""
    mine = [one for one in made if one.frame == number]
    before = {row.person: row for row in now[number]}
    kept = {person: row for person, row in before.items() if person not in {one.was for one in mine}}
    for one in mine:
        if one.person is not None and one.position is not None:
            old = before[one.was] if one.was is not None else elsewhere(now, one.person)
            kept[one.person] = replace(old, person=one.person, position=one.position)
    return sorted(kept.values(), key=lambda row: row.person)


def elsewhere(now: Rows, person: int) -> Row:
    """Somebody who comes back is as large as in another frame."""
    same = [row for rows in now.values() for row in rows if row.person == person]
    sizes = (same[0].height, same[0].radius) if same else (None, None)
    return Row(person, 0, Annotation.State.VALIDATED.value, Annotation.Origin.PROPOSED.value, *sizes)


def take_out(layer: Layer, now: Rows, made: Sequence[Change]) -> dict[int, Save]:
    """One save by nobody for each frame that changes, by frame number."""
    return {
        number: append(layer, number, after(now, number, made))
        for number in sorted({one.frame for one in made})
    }


def append(layer: Layer, number: int, rows: list[Row]) -> Save:
    frame = Frame.objects.get(dataset=layer.dataset_id, number=number)
    head = LayerFrame.objects.select_for_update(no_key=True).get(layer=layer, frame=frame)
    write_rows(layer, frame, rows)
    nobody = head.done and not rows
    save = Save.objects.create(
        layer_frame=head,
        revision=head.revision + 1,
        save_id=uuid.uuid4(),
        annotations=[row.as_dict() for row in rows],
        done=head.done,
        nobody=nobody,
        calibration_id=in_place_id(layer.dataset_id),
    )
    LayerFrame.objects.filter(pk=head.pk).update(
        revision=save.revision, nobody=nobody, changed_at=timezone.now()
    )
    return save
