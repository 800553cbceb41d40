"""Clicking four measured points, and confirming where the others are expected by the keyboard."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Click, Desk
from tests.desk_scene import make_desk, seen

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

TO_CLIENT = """([x, y]) => {
    const place = new DOMPoint(x, y).matrixTransform(document.querySelector(".desk-picture").getScreenCTM());
    return [place.x, place.y];
}"""


@pytest.fixture
def ground(page: Page, live_server: LiveServer) -> Iterator[Page]:
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1280, "height": 800})
    make_desk()
    client = Client()
    client.force_login(User.objects.create_superuser("vera"))
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    page.goto(f"{live_server.url}/calibration-desks/plaza/ground/")
    yield page
    assert errors == []


def saved(page: Page) -> None:
    expect(page.locator("[data-saved]")).to_have_text("Everything is saved")


def test_four_clicks_place_the_camera_and_the_keyboard_does_the_rest(ground: Page) -> None:
    places = seen(Desk.objects.get())
    for name in ("A1", "E1", "E3", "A3"):
        ground.locator(f"tr[data-point={name}]").click()
        expect(ground.locator("[data-now]")).to_have_text(name)
        ground.mouse.click(*ground.evaluate(TO_CLIENT, list(places[name])))
        expect(ground.locator(f".desk-picture .clicked[data-point={name}]")).to_be_attached()
    expect(ground.locator(".desk-picture .expected")).to_have_count(11)
    expect(ground.locator(".desk-picture .ground-line").first).to_be_attached()
    for left in range(10, -1, -1):
        ground.keyboard.press("Enter")
        expect(ground.locator(".desk-picture .expected")).to_have_count(left)
    saved(ground)
    rows = Click.objects.values_list("point__name", "x", "y")
    assert len(rows) == 15
    assert all(abs(x - places[name][0]) < 3 and abs(y - places[name][1]) < 3 for name, x, y in rows)
    ground.keyboard.press("Control+z")
    expect(ground.locator(".desk-picture .expected")).to_have_count(1)
    ground.keyboard.press("Control+y")
    expect(ground.locator(".desk-picture .expected")).to_have_count(0)
    ground.reload()
    expect(ground.locator(".desk-picture .clicked")).to_have_count(15)


def test_a_nudge_moves_what_is_expected_before_it_is_confirmed(ground: Page) -> None:
    places = seen(Desk.objects.get())
    for name in ("A1", "E1", "E3", "A3"):
        ground.locator(f"tr[data-point={name}]").click()
        ground.mouse.click(*ground.evaluate(TO_CLIENT, list(places[name])))
    ground.locator("tr[data-point=C2]").click()
    expect(ground.locator(".expected.chosen[data-point=C2]")).to_be_attached()
    saved(ground)
    ghosts = Desk.objects.get().cameras.get(name="C1").pose_report["ghosts"]
    ghost = next(each for each in ghosts if each["name"] == "C2")
    ground.keyboard.press("ArrowRight")
    ground.keyboard.press("Shift+ArrowDown")
    ground.keyboard.press("Enter")
    expect(ground.locator(".desk-picture .clicked[data-point=C2]")).to_be_attached()
    saved(ground)
    click = Click.objects.get(point__name="C2")
    assert (click.x - ghost["x"], click.y - ghost["y"]) == pytest.approx((0.25, 5.0), abs=0.01)
