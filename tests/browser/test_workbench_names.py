"""What a screen reader says: every control has a name, wherever it is."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.browser.bench import Bench

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

CONTROLS = {
    "button", "checkbox", "combobox", "dialog", "grid", "link", "listbox", "menuitem", "option", "radio",
    "region", "slider", "spinbutton", "switch", "tab", "textbox",
}  # fmt: skip


def nameless(page: Page) -> list[str]:
    """Controls of the accessibility tree, as assistive technology reads it, without a name in words."""
    session = page.context.new_cdp_session(page)
    nodes = session.send("Accessibility.getFullAXTree")["nodes"]
    controls = [node for node in nodes if not node["ignored"] and node["role"]["value"] in CONTROLS]
    assert len(controls) > 15
    silent = [node for node in controls if not any(sign.isalnum() for sign in node["name"].get("value", ""))]
    return [f"{node['role']['value']} {node['name'].get('value')!r}" for node in silent]


def test_every_control_of_the_page_has_a_name(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("Tab", "m")
    opened.painted()
    assert nameless(opened.page) == []


@pytest.mark.parametrize("key", ["?", ",", "u"])
def test_every_control_of_a_dialog_has_a_name(bench: Callable[..., Bench], key: str) -> None:
    opened = bench().open()
    opened.press(key)
    opened.painted()
    assert nameless(opened.page) == []


def test_the_list_says_who_is_selected_and_in_which_state(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press("Tab")
    chosen = opened.page.get_by_role("option", selected=True)
    expect(chosen).to_have_count(1)
    expect(chosen).to_contain_text("validated")


def test_tab_goes_through_all_buttons_in_control_mode_and_leaves_the_page(
    bench: Callable[..., Bench],
) -> None:
    opened = bench().open()
    opened.press("F6")
    expect(opened.page.locator(".bar .mode")).to_contain_text("Tab moves")
    reached = []
    for _ in range(60):
        opened.press("Tab")
        reached.append(
            opened.page.evaluate(
                "() => document.activeElement.dataset.action ?? document.activeElement.tagName"
            )
        )
    assert {"undo", "zoom", "views", "settings", "help", "play"} <= set(reached)
    assert opened.selected() is None


def test_motion_is_reduced_where_the_reader_wants_it(bench: Callable[..., Bench]) -> None:
    opened = bench()
    opened.page.emulate_media(reduced_motion="reduce")
    opened.open()
    opened.press("z")
    notice = opened.page.locator(".notice").first
    expect(notice).to_be_visible()
    assert notice.evaluate("(node) => node.getAnimations().length") == 0
