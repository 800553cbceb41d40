"""Sizes of letters and marks on small and on very large screens."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.bench import Bench, best_view, metres_apart

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

LETTERS = "() => parseFloat(getComputedStyle(document.body).fontSize)"
OVERLAPS = """
() => {
  const boxes = [...document.querySelectorAll(".bar > *")]
    .map((node) => [node, node.getBoundingClientRect()])
    .filter(([node, box]) => box.width > 1 && getComputedStyle(node).position === "static");
  return boxes.slice(1)
    .filter(([, box], index) => box.left < boxes[index][1].right - 0.5)
    .map(([node]) => node.textContent);
}
"""


@pytest.fixture
def opened(bench: Callable[..., Bench]) -> Bench:
    return bench().open()


SCREENS = [(1280, 800, 13), (1920, 1080, 13), (3840, 2160, 21)]  # width, height, least size of letters


@pytest.mark.parametrize(("width", "height", "least"), SCREENS, ids=["small", "usual", "4k"])
def test_letters_grow_with_the_screen(opened: Bench, width: int, height: int, least: int) -> None:
    opened.page.set_viewport_size({"width": width, "height": height})
    assert opened.page.evaluate(LETTERS) >= least


def test_a_click_on_a_very_large_screen_lands_where_it_was_made(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    opened.page.set_viewport_size({"width": 3840, "height": 2160})
    opened.painted()
    position = int(opened.street.truth[0][0])
    opened.click(best_view(position), position)
    [placed] = opened.stored()
    assert metres_apart(placed.position, position) < 0.15


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (1536, 864)], ids=["150 %", "125 %"])
def test_nothing_in_the_bar_overlaps_when_the_page_is_zoomed(opened: Bench, width: int, height: int) -> None:
    opened.page.set_viewport_size({"width": width, "height": height})
    opened.press("F6")
    expect(opened.page.locator(".bar .mode")).not_to_be_empty()
    assert opened.page.evaluate(OVERLAPS) == []


def test_the_list_of_people_is_walked_by_its_own_arrows(opened: Bench) -> None:
    opened.press("F6")
    people = opened.page.get_by_role("listbox", name="People in this frame")
    people.focus()
    opened.press("ArrowDown", "ArrowDown")
    assert opened.selected() == "2"
    opened.press("ArrowUp")
    assert opened.selected() == "1"


def test_texts_name_undo_as_it_is_set(page: Page, bench: Callable[..., Bench]) -> None:
    page.add_init_script("localStorage.setItem('gtm-workbench-keys', JSON.stringify({undo: ['Ctrl+u']}))")
    opened = bench().open()
    opened.press("Tab", "Delete")
    expect(page.locator(".notice").first).to_contain_text("Ctrl + U")
    opened.press("Control+u")
    assert opened.rows() == ["1", "2", "3", "4"]
