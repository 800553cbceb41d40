"""Clicking one thing in several views: where it is appears, what is off is marked, and it can be kept."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.calibration.kept_points import SeenAt
from gtm_hit.models import Desk, KeptClick
from gtm_hit.ops.desk import kept
from tests.check_scene import BENCH, LAMP, beside, calibrated_desk, true_clicks

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

TO_CLIENT = """([camera, x, y]) => {
    const picture = document.querySelector(`[data-camera=${camera}] .desk-picture`);
    const place = new DOMPoint(x, y).matrixTransform(picture.getScreenCTM());
    return [place.x, place.y];
}"""

CLOSER = """([camera, across]) =>
    document.querySelector(`[data-camera=${camera}] .desk-picture`).viewBox.baseVal.width < across"""


@pytest.fixture
def desk() -> Desk:
    return calibrated_desk()


@pytest.fixture
def check(page: Page, live_server: LiveServer, desk: Desk) -> Iterator[Page]:
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1280, "height": 800})
    client = Client()
    client.force_login(User.objects.create_superuser("vera"))
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    page.goto(f"{live_server.url}/calibration-desks/plaza/check/")
    expect(page.locator(".pane")).to_have_count(7)
    yield page
    assert errors == []


def click(page: Page, seen: SeenAt) -> None:
    """As somebody careful does it: closer by the wheel first, then the pixel."""
    where = [seen.camera, seen.x, seen.y]
    page.mouse.move(*page.evaluate(TO_CLIENT, where))
    for across in (450, 100, 30):  # pixels of the picture that are left to see
        page.mouse.wheel(0, -1000)
        page.wait_for_function(CLOSER, arg=[seen.camera, across])
    page.mouse.click(*page.evaluate(TO_CLIENT, where))
    expect(page.locator(f".pane[data-camera={seen.camera}] .seen-click")).to_be_attached()


def fact(page: Page, name: str) -> float:
    text = page.locator(f"[data-fact={name}]").inner_text()
    return float(text.strip("± mc°"))


def saved(page: Page) -> None:
    expect(page.locator("[data-saved]")).to_have_text("Everything is saved")


def test_two_clicks_tell_the_point_and_where_a_third_view_shows_it(check: Page) -> None:
    first, second, third = true_clicks(LAMP, "C1", "C3", "C7")
    click(check, first)
    lines = check.locator(".pane polyline.epipolar")
    expect(lines).to_have_count(6)
    click(check, second)
    found = [fact(check, name) for name in ("x", "y", "z")]
    assert found == pytest.approx(LAMP, abs=0.01)
    meeting = check.locator(".pane[data-camera=C7] .meeting")
    place = [float(meeting.get_attribute(f"data-{axis}") or "nan") for axis in "xy"]
    assert place == pytest.approx([third.x, third.y], abs=0.5)
    expect(check.locator(".pane .meeting ellipse")).to_have_count(7)
    expect(check.locator(".pane[data-camera=C1] .words")).to_have_text("0.0 px")


def test_a_wrong_third_click_is_marked_and_the_right_ones_are_not(check: Page) -> None:
    first, second, third = true_clicks(LAMP, "C1", "C3", "C7")
    for each in (first, second, beside(third, 40.0)):
        click(check, each)
    expect(check.locator(".pane.doubtful")).to_have_count(1)
    expect(check.locator(".pane[data-camera=C7] .seen-click.doubtful rect")).to_be_attached()
    expect(check.get_by_text("The click in C7 is beyond 3 σ")).to_be_visible()


def test_a_kept_point_is_there_after_a_reload_and_undo_takes_it_away(check: Page, desk: Desk) -> None:
    clicks = true_clicks(LAMP, "C1", "C3")
    for each in clicks:
        click(check, each)
    check.keyboard.press("t")
    row = check.locator("tr[data-point=P1]")
    expect(row).to_contain_text("test point")
    expect(check.locator(".seen-click")).to_have_count(0)
    check.reload()
    row.click()
    expect(check.locator(".seen-click")).to_have_count(2)
    assert [fact(check, name) for name in ("x", "y", "z")] == pytest.approx(LAMP, abs=0.01)
    check.keyboard.press("k")
    expect(row).to_contain_text("correspondence")
    saved(check)
    for left in ("test point", None):
        check.keyboard.press("Control+z")
        if left:
            expect(row).to_contain_text(left)
            saved(check)
    expect(row).to_have_count(0)
    expect(check.locator(".seen-click")).to_have_count(2)
    assert not desk.kept_points.exists()
    check.keyboard.press("Control+y")
    expect(row).to_be_attached()


def test_arrows_move_the_click_of_a_kept_point_and_backspace_takes_it_away(check: Page, desk: Desk) -> None:
    kept.keep(desk, true_clicks(BENCH, "C1", "C3", "C7"), "test", "bench")
    check.reload()
    check.locator("tr[data-point=bench]").click()
    before = KeptClick.objects.get(camera__name="C3")
    check.keyboard.press("3")
    check.keyboard.press("ArrowRight")
    check.keyboard.press("Shift+ArrowDown")
    saved(check)
    after = KeptClick.objects.get(camera__name="C3")
    assert (after.x - before.x, after.y - before.y) == pytest.approx((0.25, 5.0), abs=0.002)
    check.keyboard.press("Backspace")
    expect(check.locator(".seen-click")).to_have_count(2)
    saved(check)
    assert set(KeptClick.objects.values_list("camera__name", flat=True)) == {"C1", "C7"}
    check.keyboard.press("1")
    check.keyboard.press("Backspace")
    expect(check.locator("[data-problem]")).to_contain_text("Remove the point as a whole instead")
    expect(check.locator(".seen-click")).to_have_count(2)


def test_every_step_before_keeping_can_be_taken_back_and_done_again(check: Page) -> None:
    first, second = true_clicks(LAMP, "C1", "C3")
    click(check, first)
    click(check, second)
    check.keyboard.press("Escape")
    expect(check.locator(".seen-click")).to_have_count(0)
    for clicks in (2, 1, 0):
        check.keyboard.press("Control+z")
        expect(check.locator(".seen-click")).to_have_count(clicks)
    check.keyboard.press("Control+y")
    expect(check.locator(".pane[data-camera=C1] .seen-click")).to_be_attached()


def test_a_camera_that_cannot_take_part_says_which_step_it_lacks(check: Page, desk: Desk) -> None:
    desk.cameras.filter(name="C2").update(pose=None)
    desk.cameras.filter(name="C5").update(lens=None, pose=None)
    check.reload()
    ground = check.locator(".pane[data-camera=C2] .empty-view a")
    expect(ground).to_contain_text("No point clicked yet.")
    lens = check.locator(".pane[data-camera=C5] .empty-view a")
    expect(lens).to_contain_text("It has no lens yet.")
    assert (lens.get_attribute("href") or "").endswith("/lens/C5/")
