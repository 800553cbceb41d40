"""A worker's whole job on the demo scene: link, tutorial, ten frames, code; then the export is compared."""

from __future__ import annotations

import json
import re
from io import StringIO
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest
from django.core.management import call_command
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.models import Annotation, Assignment, Frame, Layer
from gtm_hit.ops.tutorial import lesson
from tests.browser.bench import TWO_FRAMES, best_view, click_position, metres_apart, off_centre
from tests.browser.street import GRID, cameras
from tests.browser.test_workbench_tutorial import choose, click_truth, next_step

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

PEOPLE = 5
WORKER = "5f3c0ffee0ddba11"

Truth = list[dict[int, int]]


@pytest.fixture
def truth() -> Truth:
    """The demo scene with one batch of ten frames; position by person, frame by frame."""
    call_command("makedemo", frames=10, stdout=StringIO())
    layer = Layer.objects.get(dataset__slug="demo", name="truth")
    return [
        dict(Annotation.objects.filter(layer=layer, frame=frame).values_list("person", "position"))
        for frame in Frame.objects.filter(dataset__slug="demo")
    ]


def test_a_worker_does_a_batch_and_the_export_holds_what_was_placed(
    page: Page, live_server: LiveServer, truth: Truth, tmp_path: Path
) -> None:
    errors: list[str] = []
    asked: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1920, "height": 1080})
    outside: list[str] = []
    page.on(
        "request", lambda request: outside.append(request.url) if foreign(request.url, live_server) else None
    )

    enter(page, live_server)
    learn(page)
    page.get_by_role("button", name="Start").click()
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    chosen = clear_of_each_other(truth)
    mark_first_frame(page, truth[0], chosen)
    for index in range(1, 10):
        follow(page, index, truth[index], chosen)
    page.keyboard.press("n")
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("All 10 frames are done")
    dialog.get_by_role("button", name="Submit").click()
    page.wait_for_url("**/work/*/")
    code = page.locator("#code").input_value()

    assignment = Assignment.objects.get(worker__external_id=WORKER)
    assert assignment.state == Assignment.State.SUBMITTED
    assert code == assignment.code
    assert re.fullmatch(r"[A-Z2-9]{20}", code)
    check_annotations(assignment, truth, chosen)
    call_command("exportlayer", "demo", assignment.layer.name, str(tmp_path / "out"), stdout=StringIO())
    check_export(assignment, tmp_path / "out" / "annotations_positions")
    assert errors == []
    assert not [url for url in asked if foreign(url, live_server)]


def foreign(url: str, server: LiveServer) -> bool:
    return url.startswith("http") and urlsplit(url).netloc != urlsplit(server.url).netloc


def enter(page: Page, server: LiveServer) -> None:
    out = StringIO()
    call_command("makelink", "demo", base_url=server.url, stdout=out)
    link = re.search(r"http\S+", out.getvalue())
    assert link is not None
    page.goto(f"{link[0]}?worker_id={WORKER}")
    page.get_by_role("button", name="Start").click()


def learn(page: Page) -> None:
    """The tutorial, every step by what the worker sees: the truth of the demo scene."""
    page.get_by_role("link", name="Tutorial").click()
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    exercise = lesson.load().exercise
    place(page, exercise.truth[0][exercise.missing])
    next_step(page)
    choose(page, exercise.shifted)
    click_truth(page, exercise.truth[0][exercise.shifted], button="right")
    next_step(page)
    choose(page, exercise.invented)
    page.keyboard.press("Backspace")
    next_step(page)
    page.keyboard.press("n")
    expect(page.locator(".place")).to_have_text("Frame 2 of 3")
    for person in exercise.carried:
        choose(page, person)
        click_truth(page, exercise.truth[1][person], button="right")
        page.keyboard.press("e")
    page.get_by_role("button", name="Finish the tutorial").click()
    page.wait_for_url("**/work/*/")


def place(page: Page, position: int) -> None:
    """A new person, also where somebody's box is in front of the feet."""
    page.keyboard.down("Shift")
    click_position(page, best_view(position), position)
    page.keyboard.up("Shift")


def clear_of_each_other(truth: Truth) -> list[int]:
    """People in all frames, well inside some view, and never within a metre of one another."""
    everywhere = set.intersection(*(set(frame) for frame in truth))
    chosen: list[int] = []
    for person in sorted(everywhere):
        seen = all(well_inside(frame[person]) for frame in truth)
        apart = all(metres_apart(frame[person], frame[other]) > 1 for frame in truth for other in chosen)
        if seen and apart and len(chosen) < PEOPLE:
            chosen.append(person)
    assert len(chosen) == PEOPLE
    return chosen


def well_inside(position: int) -> bool:
    return bool(np.isfinite(min(off_centre(camera, position) for camera in cameras())))


def mark_first_frame(page: Page, places: dict[int, int], chosen: list[int]) -> None:
    for count, person in enumerate(chosen, start=1):
        place(page, places[person])
        expect(page.locator(".people li")).to_have_count(count)


def follow(page: Page, index: int, places: dict[int, int], chosen: list[int]) -> None:
    """Next frame: everybody came along, yellow; move each to where he went."""
    page.keyboard.press("n")
    expect(page.locator(".place")).to_have_text(f"Frame {index + 1} of 10")
    expect(page.locator(".people li")).to_have_count(PEOPLE)
    for number, person in enumerate(chosen, start=1):
        choose(page, number)
        click_position(page, best_view(places[person]), places[person], button="right")
        page.keyboard.press("e")
    page.evaluate(TWO_FRAMES)


def check_annotations(assignment: Assignment, truth: Truth, chosen: list[int]) -> None:
    for frame, places in zip(Frame.objects.filter(dataset__slug="demo"), truth, strict=True):
        rows = Annotation.objects.filter(layer=assignment.layer, frame=frame)
        found = dict(rows.values_list("person", "position"))
        assert sorted(found) == list(range(1, PEOPLE + 1))
        assert set(rows.values_list("state", flat=True)) == {"validated"}
        for number, person in enumerate(chosen, start=1):
            assert metres_apart(found[number], places[person]) < 0.15


def check_export(assignment: Assignment, folder: Path) -> None:
    """File for file: the same people at the same positions, with the boxes of the published rule."""
    frames = list(Frame.objects.filter(dataset__slug="demo"))
    assert sorted(file.name for file in folder.iterdir()) == [f"{frame.number:08d}.json" for frame in frames]
    for frame in frames:
        people = json.loads((folder / f"{frame.number:08d}.json").read_text(encoding="utf-8"))
        rows = Annotation.objects.filter(layer=assignment.layer, frame=frame)
        assert {one["personID"]: one["positionID"] for one in people} == dict(
            rows.values_list("person", "position")
        )
        for one in people:
            assert [tuple(view.values()) for view in one["views"]] == expected_views(one["positionID"])


def expected_views(position: int) -> list[tuple[int, int, int, int, int]]:
    views = []
    for camera in cameras():
        boxes, visible = rectangles(camera, GRID, Cylinder(0.16, 1.80), FootRule.CORNERS, [position])
        box = boxes[0].tolist() if visible[0] else [-1] * 4
        views.append((camera.index, *box))
    return views
