"""Keys are changed in the key sheet, clashes are refused, and the browser remembers them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.browser.bench import Bench

pytestmark = pytest.mark.browser


def keys_of(page: Page, chosen: dict[str, Any]) -> dict[str, list[str]]:
    script = """async (chosen) => {
      const { useKeys, keyTable } = await import("/static/workbench/keys/keys.js");
      useKeys(chosen);
      return Object.fromEntries(keyTable().map(({ id, keys }) => [id, keys]));
    }"""
    return dict(page.evaluate(script, chosen))


def test_no_two_rows_of_the_table_share_a_key(module_page: Page) -> None:
    keys = [key for row in keys_of(module_page, {}).values() for key in row]
    assert len(keys) == len(set(keys))


def test_a_chosen_key_is_taken_from_the_row_that_has_it_by_default(module_page: Page) -> None:
    keys = keys_of(module_page, {"zoom": ["n"]})
    assert keys["zoom"] == ["n"]
    assert keys["nextFrame"] == []


@pytest.mark.parametrize("nonsense", [{"zoom": "n"}, {"zoom": []}, {"zoom": [3]}, {"zoom": ["Escape"]}])
def test_remembered_keys_that_cannot_be_are_left_out(module_page: Page, nonsense: dict[str, Any]) -> None:
    assert keys_of(module_page, nonsense) == keys_of(module_page, {})


def change(bench: Bench, name: str, *keys: str) -> None:
    bench.page.locator(f"[data-key-of={name}]").first.click()
    bench.press(*keys)


@pytest.mark.django_db(transaction=True)
def test_a_changed_key_works_at_once_and_after_a_reload(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("?")
    change(opened, "outline", "o")
    expect(opened.page.locator(".key-message")).to_contain_text("O now means")
    opened.press("Escape", "o")
    button = opened.page.locator("[data-action=outline]")
    expect(button).to_have_attribute("aria-pressed", "true")
    expect(button).to_have_attribute("title", "show the border of the ground area (O)")
    opened.open()
    opened.press("t")
    expect(button).to_have_attribute("aria-pressed", "true")
    opened.press("o")
    expect(button).to_have_attribute("aria-pressed", "false")


@pytest.mark.django_db(transaction=True)
def test_a_clash_is_refused_with_what_the_key_means_already(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("?")
    change(opened, "outline", "z")
    expect(opened.page.locator(".key-message")).to_contain_text("Z is already used: zoom all views")
    opened.press("o")
    expect(opened.page.locator("[data-key-of=outline]")).to_have_text("O")
    expect(opened.page.locator("[data-key-of=zoom]")).to_have_text("Z")


@pytest.mark.django_db(transaction=True)
def test_escape_leaves_a_key_as_it_is_and_the_sheet_open(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("?")
    change(opened, "outline", "Escape")
    expect(opened.page.locator("[data-key-of=outline]")).to_have_text("T")
    expect(opened.page.get_by_role("dialog")).to_be_visible()


@pytest.mark.django_db(transaction=True)
def test_the_sheet_is_read_from_its_beginning_on_a_small_screen(bench: Callable[..., Bench]) -> None:
    opened = bench()
    opened.page.set_viewport_size({"width": 1280, "height": 800})
    opened.open().press("?")
    dialog = opened.page.get_by_role("dialog")
    assert dialog.evaluate("(node) => node.scrollHeight > node.clientHeight && node.scrollTop") == 0


@pytest.mark.django_db(transaction=True)
def test_all_keys_can_be_as_they_were_at_first(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("?")
    change(opened, "outline", "Shift+o")
    opened.page.get_by_role("button", name="All keys as they were at first").click()
    expect(opened.page.locator("[data-key-of=outline]")).to_have_text("T")
    opened.press("Escape", "t")
    expect(opened.page.locator("[data-action=outline]")).to_have_attribute("aria-pressed", "true")
