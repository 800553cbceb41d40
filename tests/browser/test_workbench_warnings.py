"""Warnings where physics is broken: told, shown, gone to, dismissed; never in the way."""

from __future__ import annotations

import json
import re
import uuid
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from gtm_hit.ops.frames.saving import save_frame
from tests.browser.bench import Bench
from tests.browser.modules import run
from tests.browser.street import GRID
from tests.browser.test_workbench_identity import saved_with

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

MIDDLE = (3.0, 9.0)


def found(
    page: Page, frames: Sequence[Mapping[int, tuple[float, float]]], border: float = 10.0
) -> list[list[Any]]:
    """Kind, frame and persons of the warnings for people at places (metres), half a second between frames."""
    return run(
        page,
        {"truth/plausibility": "findWarnings"},
        f"""
        const frames = {[[[person, list(at)] for person, at in frame.items()] for frame in frames]};
        const inMiddle = ({{ x, y }}) => Math.max(Math.abs(x), Math.abs(y)) < {border} - 0.5;
        return findWarnings(
          frames.map((people, index) => ({{ number: 5 * index, time: index / 2,
            people: new Map(people.map(([person, position]) => [person, {{ position }}])) }})),
          {{ metres: ([x, y]) => ({{ x, y }}), inMiddle }},
        ).map(({{ kind, frame, persons }}) => [kind, frame, persons]);
        """,
    )


def test_two_bodies_do_not_fit_within_thirty_centimetres(module_page: Page) -> None:
    assert found(module_page, [{1: (0, 0), 2: (0.29, 0), 3: (0.6, 0)}]) == [["close", 0, [1, 2]]]


def test_nobody_is_faster_than_three_metres_a_second(module_page: Page) -> None:
    frames: list[dict[int, tuple[float, float]]] = [{1: (0, 0), 2: (5, 5)}, {1: (1.51, 0), 2: (6.49, 5)}]
    assert found(module_page, frames) == [["fast", 5, [1]]]


def test_who_vanishes_in_the_middle_and_appears_as_another_is_one_person(module_page: Page) -> None:
    frames: list[dict[int, tuple[float, float]]] = [
        {1: (0, 0), 9: (8, 8)},
        {1: (0.5, 0), 9: (8, 8)},
        {9: (8, 8)},
        {2: (1.6, 0), 9: (8, 8)},
    ]
    assert found(module_page, frames) == [["renumbered", 15, [1, 2]]]


def test_who_leaves_over_the_border_is_not_missed(module_page: Page) -> None:
    assert found(module_page, [{1: (9.7, 0)}, {2: (9.7, 0.3)}]) == []


def test_who_appears_too_far_away_is_somebody_else(module_page: Page) -> None:
    assert found(module_page, [{1: (0, 0), 3: (5, 5)}, {2: (1.2, 0), 3: (5, 5)}]) == []


def test_two_who_were_seen_together_are_not_one(module_page: Page) -> None:
    assert found(module_page, [{1: (0, 0), 2: (1, 0)}, {1: (0, 0), 2: (1, 0)}, {2: (1, 0)}]) == []


def test_people_in_one_place_are_listed_and_the_warning_goes_when_they_part(
    bench: Callable[..., Bench],
) -> None:
    opened = standing(bench, [[MIDDLE, (3.2, 9.0)], [MIDDLE, (4.2, 9.0)]])
    expect(warnings(opened)).to_have_text([re.compile(r"Frame 1: 1 and 2 are 0\.20 m apart")])
    opened.press("Tab", *["Shift+ArrowLeft"] * 2)
    expect(warnings(opened)).to_have_count(0)
    opened.press("n")
    expect(opened.page.locator("strong.place")).to_have_text("Frame 2 of 2")


def test_clicking_a_warning_goes_there(bench: Callable[..., Bench]) -> None:
    opened = standing(bench, [[MIDDLE], [(3.0, 11.5)]])
    opened.page.get_by_role("button", name="Frame 2: 1 comes here at 5.0 m/s").click()
    expect(opened.page.locator("strong.place")).to_have_text("Frame 2 of 2")
    assert opened.selected() == "1"
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r1")


def test_a_warning_is_drawn_at_the_feet(bench: Callable[..., Bench]) -> None:
    opened = standing(bench, [[MIDDLE, (3.2, 9.0)]])
    expect(warnings(opened)).to_have_count(1)
    assert signs(opened) > 0
    opened.press("q", "Shift+Q")
    expect(warnings(opened)).to_have_count(0)
    opened.press("Escape")
    assert signs(opened) == 0


def test_a_dismissed_warning_stays_dismissed_over_a_reload(bench: Callable[..., Bench]) -> None:
    opened = standing(bench, [[MIDDLE, (3.2, 9.0)], [MIDDLE, (3.2, 9.0)]])
    expect(warnings(opened)).to_have_count(2)
    opened.page.get_by_role("button", name="Dismiss: 1 and 2 are 0.20 m apart").first.click()
    expect(warnings(opened)).to_have_count(1)
    opened.page.wait_for_timeout(100)
    opened.open()
    expect(warnings(opened)).to_have_text([re.compile("^Frame 2:")])
    opened.page.get_by_role("button", name="1 dismissed: show it again").click()
    expect(warnings(opened)).to_have_count(2)


def test_a_person_who_changed_numbers_can_be_joined_from_the_warning(bench: Callable[..., Bench]) -> None:
    opened = standing(bench, [[MIDDLE, (0.0, 5.0)], [None, (0.0, 5.0), (3.3, 9.0)]])
    expect(warnings(opened)).to_have_text([re.compile(r"Frame 2: 1 vanishes, 3 appears 0\.30 m away")])
    opened.page.get_by_role("button", name="Join…").click()
    dialog = opened.page.get_by_role("dialog")
    expect(dialog.locator(".change-list")).to_have_text("Frame 2: 3 becomes 1")
    dialog.get_by_role("button", name="Join").click()
    saved_with(opened, [[1, 2], [1, 2]])
    expect(warnings(opened)).to_have_count(0)
    opened.press("Control+z")
    expect(warnings(opened)).to_have_count(1)


def standing(bench: Callable[..., Bench], frames: list[list[tuple[float, float] | None]]) -> Bench:
    """A batch with people 1, 2, 3 … standing where said (metres), validated."""
    made = bench(people=1, frames=len(frames), marked=False)
    for frame, places in zip(made.street.frames, frames, strict=True):
        rows = [
            {"person": index + 1, "position": int(GRID.nearest(np.array([at]))[0])}
            for index, at in enumerate(places)
            if at
        ]
        save_frame(made.assignment.layer, frame, made.assignment.worker, uuid.uuid4(), 0, rows)
    return made.open()


def warnings(opened: Bench) -> Any:
    return opened.page.locator(".warnings li")


def signs(opened: Bench) -> int:
    """Views with pixels in the yellow of a warning; nothing else is yellow where everybody is validated."""
    opened.painted()
    return int(
        opened.page.evaluate(
            """() => [...document.querySelectorAll(".pane-marks")].filter((canvas) => {
                 const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
                 const yellow = new Uint32Array(new Uint8Array([255, 210, 31, 255]).buffer)[0];
                 return new Uint32Array(data.buffer).includes(yellow);
               }).length"""
        )
    )


def test_a_number_that_changes_in_published_data_is_found_and_nothing_else(
    module_page: Page, shared_data: Path
) -> None:
    """MultiviewX, five frames of 20 people: number 0 ends 1.2 m inside, number 22 begins 0.3 m beside."""
    files = sorted((shared_data / "multiviewx" / "annotations_positions").glob("*.json"))
    columns, step = 1000, 0.025
    frames = [
        {
            one["personID"]: (one["positionID"] % columns * step, one["positionID"] // columns * step)
            for one in json.loads(file.read_text())
        }
        for file in files
    ]
    centred = [{person: (x - 12.5, y - 8.0) for person, (x, y) in frame.items()} for frame in frames]
    assert found(module_page, centred, border=12.5) == [["renumbered", 10, [0, 22]]]
