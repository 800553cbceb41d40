"""Going through a comparison in a real Chromium: what is drawn, and by which keys one gets there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.geometry.cylinder import FootRule, rectangles
from gtm_hit.models import Layer
from tests.browser.bench import TWO_FRAMES, pane_of, place_on_page, well_seen
from tests.browser.street import CYLINDER, GRID, Street, make_street
from tests.browser.street import cameras as street_cameras
from tests.browser.test_workbench_touch import touch
from tests.work_scene import make_layer, row, save

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

ASIDE = 0.2  # metres
KINDS = ["missed", "extra", "swapped", "matched"]


@pytest.fixture
def street() -> Street:
    return make_street(people=5, frames=3)


@pytest.fixture
def layers(street: Street) -> tuple[Layer, Layer]:
    """Frame 0 found 20 cm aside; in 5 two swap their numbers; in 10 two are missed and one is invented."""
    truth, found = make_layer(street.dataset, "truth", hidden=True), make_layer(street.dataset, "found")
    numbers = [[1, 2, 3, 4, 5], [2, 1, 3, 4, 5], [2, 1, 3, 4, 9]]
    for frame, positions, persons in zip(street.frames, street.truth, numbers, strict=True):
        save(truth, frame, [row(index + 1, int(one)) for index, one in enumerate(positions)])
        aside = GRID.nearest(GRID.metres(positions) + np.array([ASIDE, 0.0]))
        if 9 in persons:
            aside[-1] = GRID.nearest([[4.0, 20.0]])[0]
        rows = [row(person, int(one)) for person, one in zip(persons, aside, strict=True)]
        save(found, frame, [one for one in rows if 9 not in persons or one["person"] != 4])
    return truth, found


@pytest.fixture
def staff_page(page: Page, live_server: LiveServer, tmp_path: Path, settings: Any) -> Iterator[Page]:
    settings.TABLES_ROOT = tmp_path
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1920, "height": 1080})
    client = Client()
    client.force_login(User.objects.create_user("vera", is_superuser=True))
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    yield page
    assert errors == []


@pytest.fixture
def viewer(staff_page: Page, live_server: LiveServer, layers: tuple[Layer, Layer]) -> Page:
    staff_page.goto(f"{live_server.url}/datasets/street/compare/view/?a=truth&b=found")
    expect(staff_page.locator("#viewer")).to_have_attribute("data-ready", "true")
    return staff_page


def kinds(page: Page) -> list[int]:
    return [page.locator(f'.marks li[data-kind="{kind}"]').count() for kind in KINDS]


def drawn(page: Page, view: str) -> set[tuple[int, ...]]:
    """The colours that are on a pane's canvas of marks."""
    pixels = page.locator(f'[data-view="{view}"] .pane-marks').evaluate(
        """canvas => {
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            const seen = new Set();
            for (let at = 0; at < data.length; at += 4) {
              if (data[at + 3] === 255) seen.add(`${data[at]},${data[at + 1]},${data[at + 2]}`);
            }
            return [...seen];
        }"""
    )
    return {tuple(int(part) for part in pixel.split(",")) for pixel in pixels}


def test_the_worst_frame_comes_first_with_everybody_in_it(viewer: Page) -> None:
    expect(viewer.locator(".place")).to_contain_text("00000010")
    expect(viewer.locator(".marks li")).to_have_count(6)
    assert kinds(viewer) == [2, 1, 0, 3]


def test_n_and_p_go_through_the_frames_worst_first(viewer: Page) -> None:
    for key, frame in [("n", "00000005"), ("n", "00000000"), ("n", "00000000"), ("p", "00000005")]:
        viewer.keyboard.press(key)
        expect(viewer.locator(".place")).to_contain_text(frame)
    expect(viewer.locator('.marks li[data-kind="swapped"]')).to_have_count(2)
    expect(viewer.locator('.marks li[data-kind="swapped"]').first).to_contain_text("was 1, now 2, 20 cm off")


def test_arrows_go_through_the_frames_in_time(viewer: Page) -> None:
    viewer.keyboard.press("ArrowLeft")
    expect(viewer.locator(".place")).to_contain_text("00000005")
    viewer.keyboard.press("ArrowLeft")
    expect(viewer.locator(".place")).to_contain_text("00000000")


def test_the_address_leads_back_to_the_frame(viewer: Page) -> None:
    viewer.keyboard.press("n")
    expect(viewer.locator(".place")).to_contain_text("00000005")
    viewer.reload()
    expect(viewer.locator(".place")).to_contain_text("00000005")


def test_each_kind_is_drawn_in_its_colour_from_above(viewer: Page) -> None:
    expect(viewer.locator(".marks li")).to_have_count(6)
    viewer.wait_for_timeout(200)
    missed, extra, swapped = (255, 143, 134), (255, 210, 31), (211, 163, 255)
    assert {missed, extra} <= drawn(viewer, "map")
    viewer.keyboard.press("n")
    expect(viewer.locator('.marks li[data-kind="swapped"]')).to_have_count(2)
    viewer.wait_for_timeout(200)
    colours = drawn(viewer, "map")
    assert swapped in colours and not {missed, extra} & colours


def test_choosing_a_person_zooms_to_it_and_escape_lets_go(viewer: Page) -> None:
    row_of = viewer.locator('.marks li[data-kind="missed"]').first
    row_of.click()
    expect(row_of).to_have_attribute("aria-selected", "true")
    viewer.keyboard.press("Escape")
    expect(row_of).to_have_attribute("aria-selected", "false")
    viewer.keyboard.press("Tab")
    expect(row_of).to_have_attribute("aria-selected", "true")


def test_a_server_that_refuses_is_told_in_words(viewer: Page) -> None:
    viewer.route("**/evaluation/frames/**", lambda route: route.fulfill(status=403, body="{}"))
    viewer.reload()
    expect(viewer.get_by_role("alert")).to_contain_text("The server did not answer")


def test_the_page_of_scores_leads_to_the_frame_clicked_on(
    staff_page: Page, live_server: LiveServer, layers: tuple[Layer, Layer]
) -> None:
    staff_page.goto(f"{live_server.url}/datasets/street/compare/?a=truth&b=found")
    staff_page.get_by_role("link", name="00000005").click()
    expect(staff_page.locator(".place")).to_contain_text("00000005")


def test_a_figure_is_saved_as_a_picture(
    staff_page: Page, live_server: LiveServer, layers: tuple[Layer, Layer]
) -> None:
    staff_page.goto(f"{live_server.url}/datasets/street/statistics/?layer=truth")
    with staff_page.expect_download() as download:
        staff_page.locator('[data-figure="street-truth-coverage"] [data-png]').click()
    saved = download.value
    assert saved.suggested_filename == "street-truth-coverage.png"
    assert Path(saved.path()).read_bytes().startswith(b"\x89PNG\r\n\x1a\n")


def place_of(street: Street, page: Page, view: int, person: int) -> tuple[float, float]:
    """A pixel on the truth's box of somebody in the last frame, away from the foot."""
    x, y = place_on_page(page, view, int(street.truth[2][person]))
    return x, y - 12


def seen_person(street: Street) -> tuple[int, int]:
    """A view and somebody of the last frame who is seen well there and was found."""
    return well_seen(street, 2)


def zoom_of(page: Page, view: int) -> float:
    page.evaluate(TWO_FRAMES)
    return float(pane_of(page, view).get_attribute("data-zoom") or 0)


def test_a_double_click_makes_a_view_large_and_alike_again(viewer: Page) -> None:
    pane = pane_of(viewer, 1)
    before = pane.bounding_box()
    pane.dblclick(position={"x": 40, "y": 40})
    expect(pane).to_have_class(re.compile(r"\blarge\b"))
    after = pane.bounding_box()
    assert before and after and after["width"] > 1.5 * before["width"]
    pane.dblclick(position={"x": 40, "y": 40})
    expect(pane).not_to_have_class(re.compile(r"\blarge\b"))


@pytest.mark.parametrize("key", ["Alt", "Control"])
def test_a_click_that_would_add_a_sighting_changes_nothing(viewer: Page, street: Street, key: str) -> None:
    viewer.locator(".marks li").first.click()
    chosen = viewer.locator('.marks li[aria-selected="true"]')
    expect(chosen).to_have_count(1)
    viewer.keyboard.down(key)
    pane_of(viewer, 0).click(position={"x": 60, "y": 60})
    viewer.keyboard.up(key)
    expect(chosen).to_have_count(1)


def test_a_drag_that_begins_on_a_person_moves_the_zoomed_picture(viewer: Page, street: Street) -> None:
    view, person = seen_person(street)
    expect(viewer.locator(".marks li")).to_have_count(6)
    x, y = place_of(street, viewer, view, person)
    viewer.mouse.move(x, y)
    viewer.mouse.wheel(0, -400)
    assert zoom_of(viewer, view) > 1.5
    before = picture_of(viewer, view)
    viewer.mouse.down()
    viewer.mouse.move(x + 30, y + 20, steps=4)
    viewer.mouse.up()
    viewer.evaluate(TWO_FRAMES)
    assert picture_of(viewer, view) != before
    assert kinds(viewer) == [2, 1, 0, 3]


def test_no_cursor_promises_that_people_can_be_moved(viewer: Page, street: Street) -> None:
    view, person = seen_person(street)
    expect(viewer.locator(".marks li")).to_have_count(6)
    viewer.mouse.move(*place_of(street, viewer, view, person))
    viewer.evaluate(TWO_FRAMES)
    assert not pane_of(viewer, view).get_attribute("data-grip")


def test_a_right_click_moves_nobody(viewer: Page, street: Street) -> None:
    viewer.locator(".marks li").first.click()
    pane_of(viewer, 0).click(position={"x": 60, "y": 60}, button="right")
    expect(viewer.locator('.marks li[aria-selected="true"]')).to_have_count(1)
    assert kinds(viewer) == [2, 1, 0, 3]


def test_two_fingers_zoom_a_view(viewer: Page) -> None:
    bounds = pane_of(viewer, 0).bounding_box()
    assert bounds is not None
    x, y = bounds["x"] + bounds["width"] / 2, bounds["y"] + bounds["height"] / 2
    session = viewer.context.new_cdp_session(viewer)
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
    touch(session, *[[(x - reach, y), (x + reach, y)] for reach in (20, 30, 40, 50, 60)])
    assert zoom_of(viewer, 0) > 1.5


def test_people_who_were_found_are_fainter_than_the_one_who_is_chosen(viewer: Page, street: Street) -> None:
    viewer.keyboard.press("n")
    viewer.keyboard.press("n")
    expect(viewer.locator('.marks li[data-kind="matched"]')).to_have_count(5)
    found = boxes_alpha(viewer, street)
    assert 0 < found < 200


def boxes_alpha(page: Page, street: Street) -> int:
    """How much of the picture a matched person's box covers, 0 to 255, at the middle of its left edge."""
    page.evaluate(TWO_FRAMES)
    view, person = well_seen(street, 0)
    camera = street_cameras()[view]
    boxes, _ = rectangles(camera, GRID, CYLINDER, FootRule.CORNERS, np.array([street.truth[0][person]]))
    xmin, ymin, _xmax, ymax = (float(one) for one in boxes[0])
    return int(
        pane_of(page, view)
        .locator(".pane-marks")
        .evaluate(
            """(canvas, [x, y, width, height]) => {
                const scale = Math.min(canvas.width / width, canvas.height / height);
                const left = (canvas.width - width * scale) / 2 + x * scale;
                const top = (canvas.height - height * scale) / 2 + y * scale;
                const { data } = canvas.getContext("2d").getImageData(left - 2, top, 4, 1);
                return Math.max(data[3], data[7], data[11], data[15]);
            }""",
            [xmin, (ymin + ymax) / 2, camera.width, camera.height],
        )
    )


def picture_of(page: Page, view: int) -> str:
    canvas = pane_of(page, view).locator(".pane-picture")
    return str(canvas.evaluate("canvas => canvas.toDataURL()"))
