"""A campaign in the square with a hidden truth: eight people walk through 20 frames, two batches of ten."""

from __future__ import annotations

import uuid
from typing import Any

from gtm_hit.models import Annotation, Assignment, Batch, Campaign, Dataset, Frame, Layer, LayerFrame, Worker
from gtm_hit.ops.frames import saving
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.gold import planting
from gtm_hit.ops.work import assignments
from gtm_hit.ops.work.pools import Pool
from gtm_hit.scoring.faults import ALL_KINDS, Positions
from tests.scoring.people import walking
from tests.work_scene import make_dataset, make_layer, make_worker, minutes_pass

FRAMES = 20


def truth_of_square(frames: int = FRAMES) -> dict[int, Positions]:
    return walking(people=8, frames=frames)


def put(layer: Layer, people: dict[int, Positions]) -> None:
    """As if it had been imported."""
    frames = {frame.number: frame for frame in layer.dataset.frames.filter(number__in=people)}
    LayerFrame.objects.bulk_create(
        LayerFrame(layer=layer, frame=frame, revision=1, done=True) for frame in frames.values()
    )
    Annotation.objects.bulk_create(
        Annotation(layer=layer, frame=frames[number], person=person, position=place, origin="imported")
        for number, places in people.items()
        for person, place in places.items()
    )


def make_truth(dataset: Dataset, name: str = "truth") -> Layer:
    layer = make_layer(dataset, name, Layer.Kind.GROUND_TRUTH, hidden=True)
    put(layer, truth_of_square(dataset.frames.count()))
    return layer


def make_campaign(dataset: Dataset, copies: int = 1, size: int = 10, **values: Any) -> Campaign:
    """Open, with batches of `size` frames over the whole dataset."""
    campaign = Campaign.objects.create(dataset=dataset, name="street", state="open", **values)
    frames = list(dataset.frames.order_by("number"))
    for copy in range(1, copies + 1):
        for number, start in enumerate(range(0, len(frames), size), start=1):
            batch = Batch.objects.create(dataset=dataset, campaign=campaign, number=number, copy=copy)
            batch.frames.set(frames[start : start + size])
    return campaign


def make_scene(images: bool = False, **values: Any) -> tuple[Campaign, Layer]:
    dataset = make_dataset(frames=FRAMES, images=images)
    return make_campaign(dataset, **values), make_truth(dataset)


def plant_everywhere(campaign: Campaign, layer: Layer, faults: int = 3, **values: Any) -> None:
    planting.settle(campaign, layer, 1.0, faults, values.pop("kinds", ALL_KINDS), **values)


def take(campaign: Campaign, name: str = "alice") -> Assignment:
    """The next free batch, for a worker of that name."""
    worker = Worker.objects.filter(external_id=name).first() or make_worker(name)
    taken = assignments.claim(worker, Pool(campaign.dataset, campaign))
    minutes_pass(taken, 30)
    return taken


def places(layer: Layer) -> dict[int, Positions]:
    found: dict[int, Positions] = {}
    for number, person, place in Annotation.objects.filter(layer=layer).values_list(
        "frame__number", "person", "position"
    ):
        found.setdefault(number, {})[person] = place
    return found


def annotate(
    assignment: Assignment, people: dict[int, Positions], seconds: float = 60.0, origin: str = "clicked"
) -> None:
    """Save every frame of the batch as done, with these people."""
    for frame in assignment.batch.frames.order_by("number"):
        save(assignment, frame, people.get(frame.number, {}), seconds, origin)


def save(
    assignment: Assignment, frame: Frame, people: Positions, seconds: float = 60.0, origin: str = "clicked"
) -> None:
    revision = saving.read_frame(assignment.layer, frame).revision
    rows = [Row(person, place, origin=origin).as_dict() for person, place in sorted(people.items())]
    saving.save_frame(
        assignment.layer,
        frame,
        assignment.worker,
        uuid.uuid4(),
        revision,
        rows,
        done=True,
        nobody=not rows,
        seconds=seconds,
    )


def confirm(assignment: Assignment, seconds: float = 1.0) -> None:
    """What somebody does who only presses “next”: everybody stays where he was put."""
    annotate(assignment, places(assignment.layer), seconds, "proposed")


def hand_in(assignment: Assignment, people: dict[int, Positions], **values: Any) -> Assignment:
    annotate(assignment, people, **values)
    return assignments.submit(assignment)
