"""Keyboards of other languages, and signs that need AltGr or Option: what a key press means."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.browser.bench import Bench

pytestmark = pytest.mark.browser


def chord(page: Page, key: str, code: str, *, foreign: bool = False, **more: Any) -> str:
    script = """async ([options, foreign]) => {
      const { chord } = await import("/static/base/key_press.js");
      return chord(new KeyboardEvent("keydown", options), foreign);
    }"""
    return str(page.evaluate(script, [{"key": key, "code": code, **more}, foreign]))


@pytest.mark.parametrize(
    ("key", "code", "expected"),
    [
        ("т", "KeyN", "n"),
        ("ν", "KeyN", "n"),
        ("מ", "KeyN", "n"),
        ("ى", "KeyN", "n"),
        ("لا", "KeyB", "b"),
        ("ㅜ", "KeyN", "n"),
        ("ื", "KeyN", "n"),
        ("х", "BracketLeft", "["),
        ("١", "Digit1", "1"),
        ("Process", "KeyE", "e"),
    ],
    ids=[
        "Russian",
        "Greek",
        "Hebrew",
        "Arabic",
        "Arabic, two",
        "Korean",
        "Thai",
        "sign",
        "digit",
        "input method",
    ],
)
def test_where_letters_are_not_latin_the_place_counts(
    module_page: Page, key: str, code: str, expected: str
) -> None:
    assert chord(module_page, key, code) == expected


def test_shift_counts_by_place_too(module_page: Page) -> None:
    assert chord(module_page, "Д", "KeyL", shiftKey=True) == "Shift+l"
    assert chord(module_page, "Х", "BracketLeft", shiftKey=True) == "{"


def test_shortcuts_with_ctrl_work_by_place(module_page: Page) -> None:
    assert chord(module_page, "я", "KeyZ", ctrlKey=True) == "Ctrl+z"


@pytest.mark.parametrize(
    ("key", "code"),
    [
        ("ö", "Semicolon"),
        ("z", "KeyY"),
        (".", "KeyE"),
        ("'", "KeyQ"),
        ("€", "KeyE"),
        ("£", "BracketRight"),
        ("µ", "KeyM"),
    ],
)
def test_where_letters_are_latin_the_letter_counts(module_page: Page, key: str, code: str) -> None:
    assert chord(module_page, key, code) == key


def test_a_sign_on_a_letter_key_of_a_foreign_keyboard_is_that_letter(module_page: Page) -> None:
    assert chord(module_page, "/", "KeyQ", foreign=True) == "q"


@pytest.mark.parametrize("key", list("[]{}\\"))
def test_signs_by_altgr_are_those_signs(module_page: Page, key: str) -> None:
    windows = {"ctrlKey": True, "altKey": True}
    assert chord(module_page, key, "Digit8", modifierAltGraph=True, **windows) == key
    assert chord(module_page, key, "Digit8", **windows) == key
    assert chord(module_page, key, "Digit8", modifierAltGraph=True) == key


def test_signs_by_option_are_those_signs_on_a_mac(module_page: Page) -> None:
    module_page.evaluate("Object.defineProperty(navigator, 'platform', { value: 'MacIntel' })")
    assert chord(module_page, "]", "Digit6", altKey=True) == "]"


def test_alt_with_a_letter_stays_alt(module_page: Page) -> None:
    assert chord(module_page, "e", "KeyE", altKey=True) == "Alt+e"
    assert chord(module_page, "e", "KeyE", ctrlKey=True, altKey=True) == "Ctrl+Alt+e"


def dispatch(opened: Bench, **event: Any) -> None:
    opened.page.evaluate(
        "(event) => document.body.dispatchEvent("
        "new KeyboardEvent('keydown', { bubbles: true, cancelable: true, ...event }))",
        event,
    )


@pytest.mark.django_db(transaction=True)
def test_a_key_of_a_russian_keyboard_shows_the_border(
    bench: Callable[..., Bench],
) -> None:
    opened = bench().open()
    dispatch(opened, key="е", code="KeyT")
    expect(opened.page.locator("[data-action=outline]")).to_have_attribute("aria-pressed", "true")


@pytest.mark.django_db(transaction=True)
def test_digits_of_an_arabic_keyboard_hide_views(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    dispatch(opened, key="٢", code="Digit2")
    expect(opened.pane(1)).to_be_hidden()


@pytest.mark.django_db(transaction=True)
def test_a_sign_by_altgr_makes_the_selected_person_wider(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("Tab")
    dispatch(opened, key="]", code="Digit9", ctrlKey=True, altKey=True, modifierAltGraph=True)
    expect(opened.page.locator(".notice").last).to_contain_text("m wide")
