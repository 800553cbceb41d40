"""Going round the yellow people one by one, close up: one action for each."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest
from playwright.sync_api import expect

from tests.browser.bench import Bench, best_view, metres_apart, pane_of

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def yellow_frame(bench: Callable[..., Bench], people: int = 3) -> Bench:
    """The second frame: everybody carried over, yellow."""
    opened = bench(people=people).open()
    opened.press("n")
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")
    expect(opened.page.locator(".left")).to_contain_text(f"{people} yellow")
    return opened


def zoomed(opened: Bench) -> bool:
    opened.painted()
    button = opened.page.locator('[data-action="zoom"]')
    return button.get_attribute("aria-pressed") == "true"


def right_click_middle(opened: Bench, view: int) -> None:
    bounds = pane_of(opened.page, view).bounding_box()
    assert bounds is not None
    x, y = bounds["x"] + bounds["width"] / 2, bounds["y"] + bounds["height"] * 0.6
    opened.page.mouse.click(x, y, button="right")


def test_enter_goes_on_to_the_next_yellow_person_close_up(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench)
    opened.press("Escape", "a")
    first = opened.selected()
    assert zoomed(opened)
    opened.press("Enter")
    assert opened.selected() not in {first, None}
    expect(opened.page.locator(".left")).to_contain_text("2 yellow")


def test_one_right_click_moves_validates_and_goes_on(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench)
    opened.press("Escape", "a")
    first = int(opened.selected() or 0)
    before = {row.person: row for row in opened.stored(1)}[first]
    right_click_middle(opened, best_view(before.position))
    assert opened.selected() != str(first)
    after = {row.person: row for row in opened.stored(1)}[first]
    assert after.state == "validated"
    assert 0 < metres_apart(after.position, before.position) < 1  # close up: a click can only be near


def test_b_fetches_the_person_before_back(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench)
    opened.press("Escape", "a")
    first = opened.selected()
    opened.press("Enter", "b")
    assert opened.selected() == first
    assert zoomed(opened)


def test_after_the_last_one_the_views_show_everything_again(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench, people=2)
    opened.press("Escape", "a", "Enter", "Enter")
    assert opened.selected() is None
    assert not zoomed(opened)
    expect(opened.page.locator(".notice").first).to_contain_text("Nobody is yellow")


def test_the_round_goes_on_in_the_next_frame(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench, people=2)
    opened.press("Escape", "a", "Enter", "Enter", "n")
    expect(opened.page.locator(".place")).to_have_text("Frame 3 of 3")
    assert opened.selected() == "1"
    assert zoomed(opened)


def test_somebody_placed_in_the_round_is_shown_close_up(bench: Callable[..., Bench]) -> None:
    opened = bench(people=3, marked=False).open()
    opened.press("a")
    opened.click_ground(0)
    assert opened.selected() == "1"
    assert zoomed(opened)


def test_shift_enter_validates_everybody(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench)
    opened.press("Shift+Enter")
    expect(opened.page.locator(".left")).to_have_text("3 people")
    assert {row.state for row in opened.stored(1)} == {"validated"}


def test_escape_ends_the_round(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench)
    opened.press("Escape", "a", "Escape")
    assert not zoomed(opened)
    opened.press("Escape", "f")
    assert not zoomed(opened)


def test_f_goes_to_the_nearest_yellow_person_and_misses_nobody(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench, people=6)
    opened.press("Escape")
    visited = []
    for _ in range(6):
        opened.press("f")
        visited.append(int(opened.selected() or 0))
    places = {row.person: row.position for row in opened.stored(1)}
    left = set(places) - {visited[0]}
    for here, there in pairwise(visited):
        assert there == min(left, key=lambda one: metres_apart(places[here], places[one]))
        left.discard(there)
    assert not left


def test_close_up_every_view_shows_the_whole_person_and_the_number(bench: Callable[..., Bench]) -> None:
    opened = yellow_frame(bench, people=2)
    opened.press("Escape", "a")
    opened.page.wait_for_load_state("networkidle")
    view = best_view(opened.stored(1)[0].position)
    assert opened.selected() == "1"
    close = corner(opened, view)
    opened.press("Escape")
    opened.press("z")
    opened.painted()
    assert corner(opened, view)["painted"] == 0
    assert close["painted"] > 3000
    assert close["cyan"] > 10  # the number


def corner(opened: Bench, view: int) -> dict[str, int]:
    """What is drawn in the upper right corner of a view, over the picture."""
    opened.painted()
    found: dict[str, int] = (
        pane_of(opened.page, view)
        .locator(".pane-marks")
        .evaluate(
            """(canvas) => {
            const {data} = canvas.getContext("2d").getImageData(canvas.width - 150, 4, 144, 110);
            let [painted, cyan] = [0, 0];
            for (let i = 0; i < data.length; i += 4) {
                if (data[i + 3] > 150) painted += 1;
                if (data[i] < 70 && data[i + 1] > 200 && data[i + 2] > 220) cyan += 1;
            }
            return {painted, cyan};
        }"""
        )
    )
    return found
