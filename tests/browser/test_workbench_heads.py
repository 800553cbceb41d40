"""Pointing: a key for "move here", clicks on heads, and the view that would settle a doubtful click."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from gtm_hit.geometry.camera import project
from tests.browser.bench import Bench, best_view, metres_apart, well_seen
from tests.browser.street import CYLINDER, GRID, cameras
from tests.browser.test_workbench_placing import CYAN, coloured

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

Place = tuple[float, float]


def head_of(opened: Bench, view: int, position: int) -> Place:
    """Where the middle of the top of somebody's head is, in an unzoomed view."""
    x, y = GRID.metres([position])[0]
    camera = cameras()[view]
    feet, head = project(camera, [[x, y, 0.0], [x, y, CYLINDER.height]])
    left, top = opened.place_of(view, position)
    bounds = opened.pane(view).bounding_box()
    assert bounds is not None
    scale = min(bounds["width"] / camera.width, bounds["height"] / camera.height)
    across, down = (head - feet) * scale
    return left + float(across), top + float(down)


def well_seen_from_above(opened: Bench) -> tuple[int, int]:
    """A view and a position whose head is seen well below the height of the camera."""
    return well_seen(opened.street)[0], int(opened.street.truth[0][well_seen(opened.street)[1]])


def settling(opened: Bench) -> list[str]:
    opened.painted()
    framed = opened.page.locator(".pane[data-settles]")
    return [str(framed.nth(index).get_attribute("data-view")) for index in range(framed.count())]


def test_d_moves_the_selected_person_under_the_pointer(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    before = opened.stored()[0].position
    view = best_view(before)
    opened.press("Tab")
    x, y = opened.place_of(view, before)
    opened.page.mouse.move(x + 25, y)
    opened.press("d")
    after = opened.stored()[0]
    assert metres_apart(after.position, before) > 0.05
    assert (after.person, after.state) == (1, "validated")
    opened.press("Control+z")
    assert opened.stored()[0].position == before


def test_one_by_one_d_goes_on_as_a_right_click_does(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("n")
    expect(opened.page.locator(".left")).to_contain_text("2 yellow")
    opened.press("Escape", "a")
    first = opened.selected()
    bounds = opened.pane(best_view(opened.stored(1)[0].position)).bounding_box()
    assert bounds is not None
    opened.page.mouse.move(bounds["x"] + bounds["width"] / 2, bounds["y"] + bounds["height"] * 0.6)
    opened.press("d")
    assert opened.selected() not in {first, None}


def test_d_outside_the_views_says_where_to_point(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    before = opened.stored()[0].position
    opened.press("Tab")
    opened.page.mouse.move(300, 5)
    opened.press("d")
    expect(opened.page.locator(".notice").first).to_contain_text("Point at the feet")
    assert opened.stored()[0].position == before


def test_a_click_on_a_head_places_the_person_under_it(bench: Callable[..., Bench]) -> None:
    opened = bench(people=6, marked=False).open()
    view, position = well_seen_from_above(opened)
    opened.press("y")
    opened.page.mouse.move(*head_of(opened, view, position))
    assert coloured(opened, "map", CYAN) > 20  # the ghost stands there already
    opened.page.mouse.click(*head_of(opened, view, position))
    assert opened.rows() == ["1"]
    assert metres_apart(opened.stored()[0].position, position) < 0.5


def test_a_head_can_be_clicked_on_where_somebodys_box_is(bench: Callable[..., Bench]) -> None:
    """The ordinary click there selects whom the box belongs to."""
    opened = bench(people=1).open()
    position = opened.stored()[0].position
    view = best_view(position)
    x, y = opened.place_of(view, position)
    middle = (x + head_of(opened, view, position)[0]) / 2, (y + head_of(opened, view, position)[1]) / 2
    opened.page.mouse.click(*middle)
    assert opened.rows() == ["1"]
    opened.press("y")
    opened.page.mouse.click(*middle)
    assert opened.rows() == ["1", "2"]


def test_two_views_of_a_head_meet_above_the_feet(bench: Callable[..., Bench]) -> None:
    """One view alone sees a head at its own height at any distance; two agree."""
    opened = bench(people=6, marked=False).open()
    view, position = well_seen_from_above(opened)
    other = next(one for one in seeing(position) if one != view)
    opened.press("y")
    opened.page.keyboard.down("Alt")
    opened.page.mouse.click(*head_of(opened, view, position))
    opened.page.mouse.click(*head_of(opened, other, position))
    opened.page.keyboard.up("Alt")
    expect(opened.page.locator(".notice").first).to_contain_text("Best place for 2 views")
    assert metres_apart(opened.stored()[0].position, position) < 0.08


def test_escape_and_the_button_end_clicks_on_heads(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    button = opened.page.get_by_role("button", name="Heads")
    button.click()
    expect(button).to_have_attribute("aria-pressed", "true")
    opened.press("Escape")
    expect(button).to_have_attribute("aria-pressed", "false")
    opened.click_ground(0)
    assert opened.rows() == ["1"]
    assert opened.selected() == "1"


def test_the_view_that_would_settle_a_doubtful_place_is_framed(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    view, position = doubtful_place()
    opened.page.mouse.move(*opened.place_of(view, position))
    opened.page.wait_for_selector(".pane[data-settles]", state="attached")
    (framed,) = settling(opened)
    other = int(framed.removeprefix("camera-"))
    assert other != view
    opened.page.keyboard.down("Alt")
    opened.click(view, position)
    x, y = opened.place_of(other, position)
    opened.page.mouse.click(x, y)
    opened.page.keyboard.up("Alt")
    assert metres_apart(opened.stored()[0].position, position) < 0.15


def test_where_one_click_is_enough_no_other_view_is_framed(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    position = int(opened.street.truth[0][0])
    opened.page.mouse.move(*opened.place_of(*doubtful_place()))
    opened.page.wait_for_selector(".pane[data-settles]", state="attached")
    opened.page.mouse.move(*opened.place_of(best_view(position), position))
    assert settling(opened) == []


def seeing(position: int) -> list[int]:
    x, y = GRID.metres([position])[0]
    return [camera.index for camera in cameras() if inside(camera.index, float(x), float(y))]


def doubtful_place() -> tuple[int, int]:
    """A view and a position far away in it, that another view sees from nearby."""
    corners = [(float(x), float(y)) for x in range(-2, 9, 2) for y in range(-8, 26, 2)]
    seen = [
        (view.index, int(GRID.nearest([[x, y]])[0]))
        for x, y in corners
        for view in cameras()
        if inside(view.index, x, y)
    ]
    by_place = {position: [view for view, other in seen if other == position] for _, position in seen}
    far = {pair: distance(*pair) for pair in seen if len(by_place[pair[1]]) > 2}
    near = {pair: min(distance(view, pair[1]) for view in by_place[pair[1]]) for pair in far}
    return max((pair for pair in far if near[pair] < 8), key=lambda pair: far[pair])


def distance(view: int, position: int) -> float:
    x, y = GRID.metres([position])[0]
    centre = cameras()[view].centre
    return float(((centre[0] - x) ** 2 + (centre[1] - y) ** 2) ** 0.5)


def inside(view: int, x: float, y: float) -> bool:
    camera = cameras()[view]
    u, v = project(camera, [[x, y, 0.0]])[0]
    return bool(60 < u < camera.width - 60 and 60 < v < camera.height - 60)
