"""What the workbench loads when it is opened, and the parts that come when they are needed."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Route, expect
from rcssmin import cssmin
from rjsmin import jsmin

from tests.browser.bench import Bench
from tests.browser.street import GRID

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

BUDGET = 250_000  # bytes of script and style, uncompressed
PROGRAM = """
() => performance.getEntriesByType("resource").map(({name}) => new URL(name).pathname)
  .filter((path) => /\\.(js|css)$/.test(path))
"""
ENOUGH = 20  # files; fewer would mean that something else than the workbench was counted


def weight(path: Path) -> int:
    """Bytes of a file as it is served: without comments."""
    shorten = cssmin if path.suffix == ".css" else jsmin
    return len(shorten(path.read_text()).encode())


def test_a_cold_opening_loads_less_than_250_kb_of_script_and_style(bench: Callable[..., Bench]) -> None:
    page = bench().open().page
    page.wait_for_load_state("networkidle")
    files = [Path(path.removeprefix("/")) for path in page.evaluate(PROGRAM)]
    assert len(files) > ENOUGH
    assert sum(weight(path) for path in files) < BUDGET


def test_a_cold_opening_names_every_module_before_it_is_imported(bench: Callable[..., Bench]) -> None:
    page = bench().open().page
    named = page.evaluate("[...document.querySelectorAll('link[rel=modulepreload]')].map(({href}) => href)")
    loaded = page.evaluate("performance.getEntriesByType('resource').map(({name}) => name)")
    modules = {name for name in loaded if "/static/" in name and "/static/site/" not in name}
    # The exact tables come behind the pictures, and what only they need.
    behind = ("grid_worker.js", "table_camera.js", "geometry/feet.js")
    modules = {name for name in modules if not name.endswith(behind)}
    unnamed = {name for name in modules if name.endswith(".js")} - set(named)
    assert [name.rsplit("/")[-1] for name in unnamed] == ["main.js"]


def slow(route: Route) -> None:
    time.sleep(0.3)
    route.continue_()


PARTS = [
    ("?", "workbench/keys/help", "dialog:modal"),
    (",", "workbench/settings_dialog", "dialog:modal"),
    ("r", "workbench/people/identity_dialog", "dialog:modal"),
    ("u", "views/views_menu", ".views-menu:not([hidden])"),
    ("m", "workbench/frames/filmstrip", ".filmstrip"),
    ("Shift+h", "workbench/frames/frame_history", ".frame-history"),
]


@pytest.mark.parametrize(("key", "module", "shown"), PARTS)
def test_a_part_that_does_not_arrive_says_so_and_comes_at_the_next_try(
    bench: Callable[..., Bench], key: str, module: str, shown: str
) -> None:
    opened = bench(people=2).open()
    page = opened.page
    pattern = f"**/{module}*.js"
    page.route(pattern, lambda route: route.abort())
    opened.press("Tab", key)
    expect(page.locator(".notices")).to_contain_text("did not arrive")
    expect(page.locator(shown)).to_have_count(0)
    page.unroute(pattern)
    opened.press(key)
    expect(page.locator(shown)).to_be_visible()


def test_keys_pressed_while_a_dialog_arrives_change_nothing_behind_it(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.page.route("**/workbench/settings_dialog*.js", slow)
    opened.press("Tab", ",", "Backspace", "Backspace")
    expect(opened.page.locator("dialog:modal")).to_be_visible()
    opened.press("Escape")
    assert opened.rows() == ["1", "2"]


def test_a_dialog_that_takes_long_does_not_hold_up_the_work(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.page.route("**/workbench/settings_dialog*.js", lambda route: None)  # never answered
    opened.press("Tab", ",")
    opened.page.wait_for_timeout(1200)
    opened.press("Backspace")
    assert len(opened.rows()) == 1


def test_after_the_first_action_all_parts_come_by_themselves(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    page = opened.page
    page.wait_for_load_state("networkidle")
    opened.press("Tab")
    page.wait_for_timeout(1000)
    page.wait_for_load_state("networkidle")
    page.route("**/*", lambda route: route.abort())
    opened.press("?")
    expect(page.locator("dialog:modal")).to_be_visible()


def test_a_click_places_although_nothing_tells_how_far_it_can_be_off(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1, marked=False)
    opened.page.route("**/truth/uncertainty*.js", lambda route: route.abort())
    opened.open().click_ground(0)
    assert len(opened.rows()) == 1


def test_going_one_by_one_works_although_the_corner_pictures_do_not_arrive(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=2).open()
    opened.page.route("**/workbench/people/whois*.js", lambda route: route.abort())
    opened.press("n", "a")
    expect(opened.page.locator(".notices")).to_contain_text("did not arrive")
    opened.press("Enter", "Enter")
    assert [one.state for one in opened.stored(1)] == ["validated", "validated"]


def test_edits_go_on_and_are_saved_while_a_part_does_not_arrive(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    before = opened.stored()[0].position
    opened.page.route("**/workbench/keys/help*.js", lambda route: route.abort())
    opened.press("Tab", "ArrowLeft", "?")
    expect(opened.page.locator(".notices")).to_contain_text("Nothing is lost")
    opened.press("ArrowLeft")
    assert abs(opened.stored()[0].position - before) in {2, 2 * GRID.columns}
