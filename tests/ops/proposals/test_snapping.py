"""Snapping with what is stored: kept boxes of the run in use, and layers of people marked roughly."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.models import Annotation, Dataset, Frame, Layer, PictureBoxes, ProposalFrame
from gtm_hit.ops.frames import saving
from gtm_hit.ops.proposals import foregrounds, runs, snapping
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.pictures import pictures_of
from gtm_hit.ops.proposals.snapping import Mark
from gtm_hit.vision.bodies import body_boxes
from tests.ops.proposals.watcher import make_run
from tests.work_scene import make_layer

PLACE = (0.5, 0.25)
APART = 0.03  # metres


@pytest.fixture
def frame(dataset: Dataset) -> Frame:
    """Somebody whom both cameras' boxes show, in the first frame; in the run that is in use."""
    run = make_run(dataset)
    runs.use(run)
    first = dataset.frames.order_by("number")[0]
    digests = pictures_of([first])[first.pk].digests
    for camera in dataset.calibrated_cameras():
        sides = body_boxes(camera, np.array([PLACE]), 0.2, 1.72).boxes[0]
        boxes = [[*sides.tolist(), 0.9]]
        PictureBoxes.objects.create(picture=digests[camera.name], model=run.model, boxes=boxes)
    return first


@pytest.fixture
def layer(dataset: Dataset) -> Layer:
    return make_layer(dataset, "rough")


def position(dataset: Dataset, x: float, y: float) -> int:
    return int(dataset.grid.position([(x, y)])[0])


def away(dataset: Dataset, where: int) -> float:
    return float(np.hypot(*(dataset.grid.metres([where])[0] - PLACE)))


def test_a_mark_moves_to_whom_the_boxes_show(dataset: Dataset, layer: Layer, frame: Frame) -> None:
    mark = Mark(position(dataset, PLACE[0] + 0.3, PLACE[1] - 0.1))
    found = snapping.snap_mark(layer, frame, mark, [])
    assert found.refused == "" and away(dataset, found.position) < APART
    assert found.metres == pytest.approx(0.316, abs=APART)


def test_a_frame_nobody_looked_at_moves_nobody(dataset: Dataset, layer: Layer, frame: Frame) -> None:
    mark = Mark(position(dataset, *PLACE))
    other = dataset.frames.order_by("number")[1]
    assert snapping.snap_mark(layer, other, mark, []).refused == "unseen"
    runs.use_none(dataset)
    assert snapping.snap_mark(layer, frame, mark, []).refused == "unseen"


def test_cameras_that_contradict_all_others_are_not_believed(
    dataset: Dataset, layer: Layer, frame: Frame
) -> None:
    run = runs.runs(dataset)[0]
    wrong = [{"camera": name, "metres": 3.0, "why": ""} for name in ("C1", "C2")]
    ProposalFrame.objects.create(run=run, frame=frame, pictures="", suspicious=wrong)
    assert snapping.snap_mark(layer, frame, Mark(position(dataset, *PLACE)), []).refused == "unseen"


@pytest.mark.parametrize("other", [False, True])
def test_positions_off_the_grid_are_refused(
    dataset: Dataset, layer: Layer, frame: Frame, other: bool
) -> None:
    good, bad = Mark(position(dataset, *PLACE)), Mark(dataset.grid.count)
    with pytest.raises(ProposalError, match="not on the grid"):
        snapping.snap_mark(layer, frame, *((good, [bad]) if other else (bad, [])))


def snaplayer(*options: str) -> dict[str, Any]:
    stream = io.StringIO()
    call_command("snaplayer", "square", "rough", "--json", *options, stdout=stream, stderr=io.StringIO())
    told: dict[str, Any] = json.loads(stream.getvalue())
    return told


def test_a_layer_is_snapped_by_saves_that_can_be_taken_back(
    dataset: Dataset, layer: Layer, frame: Frame
) -> None:
    rough, far = position(dataset, PLACE[0] + 0.3, PLACE[1]), position(dataset, PLACE[0] - 2, PLACE[1])
    for number in (0, 5):
        for person, where in ((1, rough), (2, far)):
            Annotation.objects.create(
                layer=layer, frame=dataset.frames.get(number=number), person=person, position=where
            )
    told = snaplayer()
    assert (told["frames"], told["people"], told["moved"]) == (2, 4, 1)
    rows = {row.person: row for row in saving.read_frame(layer, frame).annotations}
    assert away(dataset, rows[1].position) < APART and rows[2].position == far
    assert saving.history(layer, frame)
    assert snaplayer()["moved"] == 0


def test_a_layer_cannot_be_snapped_where_nothing_is_proposed(dataset: Dataset, layer: Layer) -> None:
    with pytest.raises(CommandError, match="no boxes to go by"):
        snaplayer()


def test_the_kept_foreground_has_a_say_and_without_it_the_boxes_are_said_to_be_alone(
    dataset: Dataset, layer: Layer, frame: Frame
) -> None:
    mark = Mark(position(dataset, PLACE[0] + 0.3, PLACE[1] - 0.1))
    assert not snapping.snap_mark(layer, frame, mark, []).background
    Annotation.objects.create(layer=layer, frame=frame, person=1, position=mark.position)
    assert snaplayer()["boxes_alone"] == 1
    masks = {camera.name: np.full((54, 96), 0.5, np.float32) for camera in dataset.calibrated_cameras()}
    foregrounds.keep(runs.runs(dataset)[0], pictures_of([frame])[frame.pk].digest, masks)
    found = snapping.snap_mark(layer, frame, mark, [])
    assert found.background and away(dataset, found.position) < APART
    assert snaplayer()["boxes_alone"] == 0
