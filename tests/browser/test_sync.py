"""From videos with known clocks to an import: guessed, marked, set to a frame by the keyboard, kept."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Locator, Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Job, VideoSync
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.sync import drafts
from gtm_hit.ops.sync.state import Clock
from gtm_hit.tasks import OPERATIONS
from tests.filmed_videos import RATES, STARTS, make_filmed
from tests.sync_scene import opened_draft

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

EVENT = 6.0  # seconds of the scene


@pytest.fixture(scope="module")
def filmed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("filmed")
    return make_filmed(folder, folder / "calibrations")


@pytest.fixture
def staff(page: Page, live_server: LiveServer, settings: Any, tmp_path: Path) -> Iterator[Page]:
    settings.DATA_DIR = tmp_path
    settings.INCOMING_ROOT, settings.UPLOADS_ROOT = tmp_path / "incoming", tmp_path / "uploads"
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1280, "height": 800})
    client = Client()
    client.force_login(User.objects.create_superuser("vera"))
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    yield page
    assert errors == []


def saved(page: Page) -> None:
    expect(page.locator("[data-saved]")).to_have_text("Everything is saved")


def clocks() -> list[Clock]:
    return list(drafts.current(VideoSync.objects.get()).clocks)


def tile(page: Page, index: int) -> Locator:
    return page.locator(".sync-tile").nth(index)


def picture(page: Page, index: int) -> int:
    shown = tile(page, index)
    expect(shown).to_have_attribute("data-picture", re.compile(r"\d+"))
    return int(shown.get_attribute("data-picture") or "")


def go_to_picture(page: Page, index: int, number: int) -> None:
    """By the keyboard, as somebody would who looks for an event in one video."""
    page.keyboard.press(str(index + 1))
    while (far := number - picture(page, index)) != 0:
        step = (10 if abs(far) >= 10 else 1) * (1 if far > 0 else -1)
        wanted = picture(page, index) + step
        shift = "Shift+" if abs(step) == 10 else ""
        page.keyboard.press(f"{shift}{'ArrowRight' if step > 0 else 'ArrowLeft'}")
        expect(tile(page, index)).to_have_attribute("data-picture", str(wanted))


def test_from_the_guess_to_the_frame_and_into_the_import(
    staff: Page, live_server: LiveServer, filmed: Path, tmp_path: Path
) -> None:
    shutil.copytree(filmed, tmp_path / "incoming" / "plaza")
    staff.goto(f"{live_server.url}/video-syncs/")
    staff.get_by_role("button", name="Lay side by side").click()
    expect(staff.locator("[data-guess]")).to_contain_text("waits for a free worker")
    queue.run(Job.objects.get().pk, OPERATIONS)
    expect(staff.locator("[data-guess]")).to_contain_text("By who walks where on the ground")
    expect(staff.locator(".sync-line .guess").nth(1)).to_contain_text("sure")
    staff.keyboard.press("t")
    expect(staff.locator("[data-guess]")).to_contain_text("In place")
    saved(staff)

    # The same instant of the scene is found in two videos. C7 began last: the others are told from it.
    first, last = 0, 2
    for index in (first, last):
        go_to_picture(staff, index, round((EVENT - STARTS[index]) * RATES[index]))
        staff.keyboard.press("m")
        saved(staff)
    expect(staff.locator(".sync-line .apart").nth(last)).to_have_text("told from here")
    event, now = drafts.current(VideoSync.objects.get()).events[0], clocks()
    later = (event.marks[now[first].file] - now[first].offset) - event.marks[now[last].file]
    words = staff.locator(".sync-line .apart").nth(first)
    expect(words).to_contain_text(f"{'−' if later < 0 else '+'}{abs(round(1000 * later))} ms · ")
    a_picture = 0.5 / RATES[first] + 0.5 / RATES[last]
    assert abs(later) < 0.05 + a_picture

    staff.keyboard.press("o")
    expect(words).to_have_text("0 ms · 0 pictures")
    saved(staff)
    now = clocks()
    assert now[last].offset == 0
    assert abs(now[first].offset - (STARTS[last] - STARTS[first])) <= a_picture

    staff.reload()
    expect(staff.locator(".sync-line .apart").nth(first)).to_have_text("0 ms · 0 pictures")
    staff.get_by_role("link", name="Import these videos").click()
    lines = staff.locator("[name=videos]").input_value().splitlines()
    assert lines == [f"{clock.camera} = {clock.file} @ {clock.offset:.4f}" for clock in now]
    assert staff.locator("[name=source]").input_value() == "incoming/plaza"


def test_a_key_moves_one_video_by_one_picture_and_undo_takes_it_back(
    staff: Page, live_server: LiveServer, tmp_path: Path
) -> None:
    draft = opened_draft(tmp_path / "incoming")
    staff.goto(f"{live_server.url}/video-syncs/{draft.pk}/")
    staff.keyboard.press("Shift+ArrowRight")  # ten pictures of 25 a second: 0.4 s
    expect(tile(staff, 0)).to_have_attribute("data-picture", "10")
    expect(tile(staff, 1)).to_have_attribute("data-picture", "12")
    staff.keyboard.press("2")
    staff.keyboard.press(".")
    expect(tile(staff, 1)).to_have_attribute("data-picture", "13")
    expect(tile(staff, 0)).to_have_attribute("data-picture", "10")
    staff.keyboard.press("+")
    saved(staff)
    assert [clock.offset for clock in clocks()] == [0.0, pytest.approx(1001 / 30000 + 0.001, abs=2e-5)]
    staff.keyboard.press("Control+z")
    staff.keyboard.press("Control+z")
    expect(tile(staff, 1)).to_have_attribute("data-picture", "12")
    saved(staff)
    assert [clock.offset for clock in clocks()] == [0.0, 0.0]
    staff.keyboard.press("Control+y")
    expect(tile(staff, 1)).to_have_attribute("data-picture", "13")


def test_all_play_in_step_and_stop_where_one_of_them_ends(
    staff: Page, live_server: LiveServer, tmp_path: Path
) -> None:
    draft = opened_draft(tmp_path / "incoming")
    staff.goto(f"{live_server.url}/video-syncs/{draft.pk}/")
    expect(tile(staff, 0)).to_have_attribute("data-picture", "0")
    staff.keyboard.press(" ")
    expect(staff.locator("[data-shown]")).to_contain_text("Playing 10 pictures a second")
    expect(staff.locator("[data-play-word]")).to_have_text("Play", timeout=20_000)
    expect(staff.locator("[data-time]")).to_have_text(re.compile(r"^0:02\.\d00$"))
    assert picture(staff, 0) / 25 == pytest.approx(picture(staff, 1) * 1001 / 30000, abs=0.04)


def test_what_another_window_changed_meanwhile_is_said_and_shown(
    staff: Page, live_server: LiveServer, tmp_path: Path
) -> None:
    draft = opened_draft(tmp_path / "incoming")
    staff.goto(f"{live_server.url}/video-syncs/{draft.pk}/")
    elsewhere = drafts.State((Clock("C1.mp4", "C1"), Clock("C2.mp4", "C2", 0.5)))
    drafts.save(draft.pk, draft.revision, elsewhere)
    staff.keyboard.press(".")
    expect(staff.get_by_role("alert")).to_contain_text("changed in another window meanwhile")
    expect(staff.locator("input.offset").nth(1)).to_have_value("0.5000")
    staff.keyboard.press(".")
    saved(staff)
    assert [clock.offset for clock in clocks()] == [0.04, 0.5]
