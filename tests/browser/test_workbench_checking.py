"""A batch with the built-in detector's proposals is checked by somebody who sees only the screen."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Page
from pytest_django.live_server_helper import LiveServer

from gtm_hit.metrics import detection
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.models import Annotation, Assignment, Camera, Dataset, Frame, Image
from gtm_hit.ops.files import images
from gtm_hit.ops.proposals import runs
from gtm_hit.ops.proposals.proposing import keep
from gtm_hit.ops.proposals.tracks import link_run
from gtm_hit.ops.work import assignments, batches, workers
from tests.browser.scripted import Checker, Clicker, Feet
from tests.browser.street import GRID, workbench_path
from tests.demo_frames import LookedAt

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

FRAMES = 2


@pytest.fixture
def dataset(demo_frames: LookedAt) -> Dataset:
    """The first frames, to be done twice."""
    made = Dataset.objects.create(slug="demo", name="Demo scene")
    for camera in demo_frames.example.scene.cameras.values():
        values = {name: getattr(camera, name).tolist() for name in ("matrix", "rvec", "tvec", "distortion")}
        size = {"width": camera.width, "height": camera.height}
        Camera.objects.create(dataset=made, index=camera.index, name=camera.name, **size, **values)
    for index in range(FRAMES):
        frame = Frame.objects.create(dataset=made, number=5 * index)
        for camera in made.cameras.all():
            Image.objects.create(frame=frame, camera=camera, **stored(demo_frames, index, camera.name))
    batches.make_batches(made, copies=2)
    return made


def stored(looked: LookedAt, index: int, camera: str) -> dict[str, str | int]:
    path: Path = looked.example.frames.paths[index][camera]
    light = cv2.resize(cv2.imread(str(path)), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    small = cv2.imencode(".jpg", light)[1].tobytes()
    full = path.read_bytes()
    return {
        "source_digest": "0" * 64,
        "light_digest": images.store(small),
        "full_digest": images.store(full),
        "light_bytes": len(small),
        "full_bytes": len(full),
    }


def propose(dataset: Dataset, looked: LookedAt) -> None:
    run = runs.find_or_make(dataset, "cover", looked.model, {"detector": "built in"})
    for index, frame in enumerate(dataset.frames.order_by("number")):
        keep(run, frame, "pictures", looked.found[index], 1.0)
    link_run(run)
    runs.use(run)


def claim(dataset: Dataset, worker: str) -> Assignment:
    return assignments.claim(workers.enter("link", worker), dataset)


def feet(looked: LookedAt) -> list[list[Feet]]:
    return [
        [
            Feet(int(person), int(place))
            for person, place in zip(known.persons, GRID.position(known.xy), strict=True)
        ]
        for known in (looked.example.known[index] for index in range(FRAMES))
    ]


def moda(assignment: Assignment, truth: Sequence[Sequence[Feet]]) -> float:
    numbers = [5 * index for index, people in enumerate(truth) for _ in people]
    places = [each.position for people in truth for each in people]
    rows = list(Annotation.objects.filter(layer=assignment.layer).values_list("frame__number", "position"))
    return detection.evaluate(
        Annotations(np.array(numbers), GRID.metres(places)),
        Annotations(np.array([row[0] for row in rows]), GRID.metres([row[1] for row in rows])),
    ).moda


def test_checking_proposals_takes_a_fraction_of_the_actions_of_placing_everybody(
    page: Page, live_server: LiveServer, dataset: Dataset, demo_frames: LookedAt
) -> None:
    page.set_viewport_size({"width": 1920, "height": 1080})
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    truth = feet(demo_frames)
    people = sum(map(len, truth))

    propose(dataset, demo_frames)
    checked = claim(dataset, "checker")
    checker = Checker(page, FRAMES)
    checker.open(live_server.url + workbench_path(checked))
    checker.do_batch()

    runs.use_none(dataset)
    clicked = claim(dataset, "clicker")
    clicker = Clicker(page, truth)
    clicker.open(live_server.url + workbench_path(clicked))
    clicker.do_batch()

    assert errors == []
    assert moda(checked, truth) >= 0.83
    assert moda(clicked, truth) >= 0.95  # else the comparison would say nothing
    assert checker.hands.actions / people <= 0.5
    assert checker.hands.actions < 0.5 * clicker.hands.actions
