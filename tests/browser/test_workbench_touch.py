"""A tablet: tap, drag and pinch, with real touches of Chromium's own input."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Browser, CDPSession, Page

from tests.browser.bench import Bench, best_view, metres_apart, well_seen

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

Place = tuple[float, float]


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    context = browser.new_context(has_touch=True, is_mobile=True, device_scale_factor=1)
    yield context.new_page()
    context.close()


def touch(session: CDPSession, *steps: list[Place]) -> None:
    """Fingers put down at the first places, moved to the others one by one, and lifted."""
    for index, places in enumerate(steps):
        points = [{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(places)]
        kind = "touchMove" if index else "touchStart"
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def zoom_of(opened: Bench, view: int) -> float:
    opened.painted()
    return float(opened.pane(view).get_attribute("data-zoom") or 0)


def middle_of(opened: Bench, view: int) -> Place:
    bounds = opened.pane(view).bounding_box()
    assert bounds is not None
    return bounds["x"] + bounds["width"] / 2, bounds["y"] + bounds["height"] / 2


def pinch(opened: Bench, view: int) -> None:
    x, y = middle_of(opened, view)
    session = opened.page.context.new_cdp_session(opened.page)
    touch(session, *[[(x - reach, y), (x + reach, y)] for reach in (20, 30, 40, 50, 60)])


def test_a_tap_on_feet_selects(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    view, person = well_seen(opened.street)
    opened.page.touchscreen.tap(*opened.place_of(view, int(opened.street.truth[0][person])))
    assert opened.selected() == str(person + 1)
    assert len(opened.rows()) == 4


def test_two_fingers_zoom_the_view_and_place_nobody(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    pinch(opened, 0)
    assert zoom_of(opened, 0) == pytest.approx(3, abs=0.1)
    assert zoom_of(opened, 1) == 1
    assert opened.rows() == []


def test_one_finger_moves_the_zoomed_picture_and_nobody_in_it(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    pinch(opened, 0)
    opened.painted()
    before = opened.page.evaluate(LOOK)
    positions = [one.position for one in opened.stored()]
    x, y = middle_of(opened, 0)
    session = opened.page.context.new_cdp_session(opened.page)
    touch(session, [(x, y)], [(x + 20, y)], [(x + 60, y + 10)])
    opened.painted()
    assert opened.page.evaluate(LOOK) != before
    assert [one.position for one in opened.stored()] == positions
    assert len(opened.rows()) == 4


LOOK = """() => document.querySelector('[data-view="camera-0"] .pane-picture').toDataURL()"""


def test_a_long_press_moves_the_selected_person_there(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    before = opened.stored()[0].position
    view = best_view(before)
    opened.page.touchscreen.tap(*opened.place_of(view, before))
    x, y = opened.place_of(view, before)
    hold(opened, (x + 40, y), 900)
    after = opened.stored()[0]
    assert metres_apart(after.position, before) > 0.05
    assert opened.rows() == ["1"]


def test_a_finger_that_moves_on_is_no_long_press(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    before = opened.stored()[0].position
    view = best_view(before)
    opened.page.touchscreen.tap(*opened.place_of(view, before))
    x, y = opened.place_of(view, before)
    hold(opened, (x + 40, y), 900, wander=30)
    assert opened.stored()[0].position == before


def hold(opened: Bench, place: Place, milliseconds: int, wander: float = 0) -> None:
    """A finger on one place for a while; `wander` pixels on after it was put down."""
    session = opened.page.context.new_cdp_session(opened.page)
    send = session.send
    send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [{"x": place[0], "y": place[1]}]})
    if wander:
        moved = [{"x": place[0] + wander, "y": place[1]}]
        send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": moved})
    opened.page.wait_for_timeout(milliseconds)
    send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
