"""Going through a comparison in a real Chromium: what is drawn, and by which keys one gets there."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Layer
from tests.browser.street import GRID, Street, make_street
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
    client.force_login(User.objects.create_user("vera", is_staff=True))
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
