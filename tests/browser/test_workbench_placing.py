"""Placing with evidence, moving, sizes, and the settings, with real keys and a real pointer."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.bench import Bench

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_settings_are_remembered_by_the_browser(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press(",")
    dialog = opened.page.get_by_role("dialog")
    dialog.get_by_label("Arrow keys follow").select_option("the axes of the ground, in every view")
    dialog.get_by_label("Show what a click would place").uncheck()
    opened.press("Escape")
    opened.open().press(",")
    expect(dialog.get_by_label("Arrow keys follow")).to_have_value("the axes of the ground, in every view")
    expect(dialog.get_by_label("Show what a click would place")).not_to_be_checked()
    dialog.get_by_role("button", name="As it was at first").click()
    expect(dialog.get_by_label("Show what a click would place")).to_be_checked()
    dialog.get_by_role("button", name="Close").click()
    expect(dialog).to_have_count(0)
