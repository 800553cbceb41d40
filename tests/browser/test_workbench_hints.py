"""Hints come when they are needed for the first time, and none twice."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.bench import Bench

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_a_hint_comes_with_the_first_selection_and_never_again(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    hint = opened.page.locator(".hint")
    expect(hint).to_be_hidden()
    opened.press("Tab")
    expect(hint).to_contain_text("Arrow keys move the person")
    opened.page.get_by_role("button", name="Close this hint").click()
    expect(hint).to_be_hidden()
    opened.open()
    opened.press("Tab")
    opened.painted()
    expect(hint).to_be_hidden()


def test_a_hint_names_the_keys_the_annotator_has_chosen(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("?")
    opened.page.locator("[data-key-of=zoom]").click()
    opened.press("o", "Escape", "Tab")
    expect(opened.page.locator(".hint")).to_contain_text("O shows the person large")


def test_the_first_turn_of_the_wheel_says_what_else_a_view_can_do(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.pane(0).hover()
    opened.page.mouse.wheel(0, -200)
    expect(opened.page.locator(".hint")).to_contain_text("double click makes the view large")


def test_without_hints_in_the_settings_none_comes(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press(",")
    opened.page.locator("[data-setting=hints]").uncheck()
    opened.press("Escape", "Tab")
    opened.painted()
    expect(opened.page.locator(".hint")).to_be_hidden()
