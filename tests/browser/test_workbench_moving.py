"""Moving people with arrow keys, drags and the right button, with real keys and a real pointer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from gtm_hit.geometry.camera import project
from tests.browser.bench import Bench, best_view, metres_apart, well_seen
from tests.browser.modules import run
from tests.browser.street import GRID, annotate, cameras

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def all_saved(opened: Bench) -> None:
    opened.painted()  # an edit shows as "Saving…" first
    opened.saved()


def marks_of(opened: Bench, view: str) -> str:
    opened.painted()
    canvas = opened.page.locator(f'[data-view="{view}"] .pane-marks')
    return str(canvas.evaluate("(canvas) => canvas.toDataURL()"))


def on_map(opened: Bench, position: int) -> tuple[float, float]:
    """Where a position is on the map: 36 m to the right, 12 m downwards, 0.8 m around."""
    x, y = GRID.metres([position])[0]
    bounds = opened.page.locator('[data-view="map"]').bounding_box()
    assert bounds is not None
    scale = min(bounds["width"] / 37.6, bounds["height"] / 13.6)
    left = bounds["x"] + (bounds["width"] - 37.6 * scale) / 2
    top = bounds["y"] + (bounds["height"] - 13.6 * scale) / 2
    return left + (y + 9 + 0.8) * scale, top + (x + 3 + 0.8) * scale


def drag(page: Page, start: tuple[float, float], end: tuple[float, float], drop: bool = True) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end, steps=6)
    if drop:
        page.mouse.up()


def moved(place: tuple[float, float], dx: float, dy: float) -> tuple[float, float]:
    return place[0] + dx, place[1] + dy


def test_dragging_a_foot_moves_its_person_in_one_step_to_undo(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    view = best_view(start)
    foot = opened.place_of(view, start)
    drag(opened.page, foot, moved(foot, 40, 15))
    all_saved(opened)
    (stored,) = opened.stored()
    x, y = opened.place_of(view, stored.position)
    assert (x, y) == pytest.approx(moved(foot, 40, 15), abs=2)
    assert opened.selected() == "1"
    opened.press("Control+z")
    all_saved(opened)
    assert opened.stored()[0].position == start


def test_a_slow_drag_is_one_step_to_undo_too(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    foot = opened.place_of(best_view(start), start)
    drag(opened.page, foot, moved(foot, 20, 0), drop=False)
    opened.page.wait_for_timeout(1000)
    opened.page.mouse.move(*moved(foot, 40, 0))
    opened.page.mouse.up()
    opened.press("Control+z")
    all_saved(opened)
    assert opened.stored()[0].position == start


def test_a_drag_shows_in_all_views_before_it_is_dropped(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    view = best_view(start)
    foot = opened.place_of(view, start)
    opened.press("Tab")
    before = marks_of(opened, "map")
    drag(opened.page, foot, moved(foot, 30, 10), drop=False)
    halfway = marks_of(opened, "map")
    opened.page.mouse.move(*moved(foot, 60, 10))
    assert len({before, halfway, marks_of(opened, "map")}) == 3
    all_saved(opened)
    assert opened.stored()[0].position == start
    opened.page.mouse.up()


def test_escape_during_a_drag_leaves_the_person_where_it_was(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    foot = opened.place_of(best_view(start), start)
    drag(opened.page, foot, moved(foot, 60, 20), drop=False)
    opened.press("Escape")
    opened.page.mouse.move(*moved(foot, 90, 20))
    opened.page.mouse.up()
    assert opened.selected() == "1"
    opened.press("ArrowLeft", "Control+z")
    all_saved(opened)
    assert opened.stored()[0].position == start


def test_a_whole_box_is_dragged_by_the_ray_of_its_foot(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    view = best_view(start)
    foot = opened.place_of(view, start)
    body = moved(foot, 0, -16)
    drag(opened.page, body, moved(body, 30, 8))
    all_saved(opened)
    assert opened.place_of(view, opened.stored()[0].position) == pytest.approx(moved(foot, 30, 8), abs=2)


def test_a_dot_on_the_map_is_dragged(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    dot = on_map(opened, start)
    drag(opened.page, dot, moved(dot, 40, -10))
    all_saved(opened)
    assert on_map(opened, opened.stored()[0].position) == pytest.approx(moved(dot, 40, -10), abs=1)


def test_dragging_works_while_zoomed(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    view = best_view(start)
    body = moved(opened.place_of(view, start), 0, -16)
    opened.page.mouse.move(*body)
    opened.page.mouse.wheel(0, -600)  # e^1.5 times larger, with the body still under the pointer
    drag(opened.page, body, moved(body, 60, 0))
    all_saved(opened)
    shift = shift_in_pixels(view, start, opened.stored()[0].position)
    bounds = opened.pane(view).bounding_box()
    assert bounds is not None
    zoom = np.exp(1.5) * min(bounds["width"] / 1920, bounds["height"] / 1080)
    assert shift * zoom == pytest.approx([60, 0], abs=8)


def shift_in_pixels(view: int, before: int, after: int) -> Any:
    places = [[*GRID.metres([position])[0], 0.0] for position in (before, after)]
    pixels = project(cameras()[view], places)
    return pixels[1] - pixels[0]


def test_dragging_the_empty_ground_moves_the_picture_only(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    opened.press("Tab", "z")
    pane = opened.pane(best_view(start)).bounding_box()
    assert pane is not None
    corner = (pane["x"] + pane["width"] - 30, pane["y"] + 30)
    drag(opened.page, corner, moved(corner, -40, 20))
    assert opened.rows() == ["1"]
    all_saved(opened)
    assert opened.stored()[0].position == start


def test_a_drag_beyond_the_ground_area_stops_at_its_border(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    dot = on_map(opened, int(opened.street.truth[0][0]))
    drag(opened.page, dot, moved(on_map(opened, GRID.nearest(np.array([[2.0, 26.9]]))[0]), 12, 0))
    all_saved(opened)
    assert opened.stored()[0].position // GRID.columns == GRID.rows - 1


def test_a_drag_onto_somebody_ends_beside_them(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    mover, stander = (int(position) for position in opened.street.truth[0])
    drag(opened.page, on_map(opened, mover), on_map(opened, stander))
    all_saved(opened)
    positions = [one.position for one in opened.stored()]
    assert positions[1] == stander
    assert positions[0] != stander
    assert metres_apart(*positions) < 0.2


def test_the_right_button_moves_the_selected_person_here(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    foot = opened.place_of(best_view(start), start)
    opened.press("Tab")
    opened.page.mouse.click(*moved(foot, -50, 10), button="right")
    all_saved(opened)
    after = opened.place_of(best_view(start), opened.stored()[0].position)
    assert after == pytest.approx(moved(foot, -50, 10), abs=2)


def test_the_setting_lets_arrows_follow_the_ground_in_every_view(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = int(opened.street.truth[0][0])
    opened.press(",")
    opened.page.get_by_label("Arrow keys follow").select_option(index=1)
    opened.press("Escape", "Tab")
    for view in (0, 3, 6):
        opened.pane(view).hover()
        opened.press("ArrowLeft")
    opened.press("ArrowUp")
    all_saved(opened)
    assert opened.stored()[0].position == start - 3 + GRID.columns


def test_the_direction_helper_tells_the_truth_for_view_and_setting(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press(",")
    opened.page.get_by_label("Show what a click would place").uncheck()
    opened.press("Escape", "Tab", "h")
    assert len(set(helper_pictures(opened))) > 1
    opened.press(",")
    opened.page.get_by_label("Arrow keys follow").select_option(index=1)
    opened.press("Escape")
    assert len(set(helper_pictures(opened))) == 1


def helper_pictures(opened: Bench) -> list[str]:
    """The map's marks with the pointer in one view after the other."""
    pictures = []
    for view in range(7):
        opened.pane(view).hover(position={"x": 4, "y": 4})
        pictures.append(marks_of(opened, "map"))
    return pictures


def hold(opened: Bench, key: str, repeats: int) -> None:
    for _ in range(repeats + 1):
        opened.page.keyboard.down(key)  # without an up in between: auto-repeat
    opened.page.keyboard.up(key)
    # On a busy machine the words of the save before can outlast two frames.
    expect(opened.page.locator(".save-words")).not_to_have_text("All saved · r1")


def test_a_key_held_for_long_speeds_up_after_sixty_repeats(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = opened.stored()[0].position
    opened.press("Tab")
    hold(opened, "ArrowRight", 70)
    all_saved(opened)
    assert metres_apart(start, opened.stored()[0].position) == pytest.approx((61 + 10 * 2) * 0.025, abs=1e-6)


def test_the_setting_keeps_held_keys_at_one_pace(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    start = opened.stored()[0].position
    opened.press(",")
    opened.page.get_by_label("Arrow keys held for long speed up").uncheck()
    opened.press("Escape", "Tab")
    hold(opened, "ArrowRight", 70)
    all_saved(opened)
    assert metres_apart(start, opened.stored()[0].position) == pytest.approx(71 * 0.025, abs=1e-6)


def test_a_held_key_keeps_its_direction_where_another_view_begins(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    view, _person = well_seen(opened.street)
    start = opened.stored()[0].position
    opened.press("Tab")
    opened.pane(view).hover(position={"x": 4, "y": 4})
    for other in [view, *range(7), view]:
        opened.pane(other).hover(position={"x": 4, "y": 4})
        opened.page.keyboard.down("ArrowLeft")
    opened.page.keyboard.up("ArrowLeft")
    all_saved(opened)
    assert metres_apart(start, opened.stored()[0].position) == pytest.approx(9 * 0.025, abs=1e-6)


def test_a_step_onto_somebody_goes_past_them(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1, marked=False)
    start = int(opened.street.truth[0][0])
    crowd = np.array([start, start - 1, start + 1, start - GRID.columns, start + GRID.columns])
    annotate(opened.assignment, opened.street.frames[0], crowd)
    opened.open().press("Tab", "ArrowLeft")
    all_saved(opened)
    assert metres_apart(start, opened.stored()[0].position) == pytest.approx(0.05, abs=1e-6)


def test_paces_rise_gently(module_page: Page) -> None:
    paces = run(
        module_page,
        {"workbench/keys/key_repeat": "paceAfter"},
        "return [0, 1, 60, 61, 120, 121, 500].map(paceAfter);",
    )
    assert paces == [1, 1, 1, 2, 2, 4, 4]
