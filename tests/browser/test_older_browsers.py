"""Browsers of 2023: what they lack is taken away from Chromium before the page opens."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.bench import Bench
from tests.conftest import REPOSITORY

OF_2023 = """
delete Map.groupBy;
delete Object.groupBy;
delete Promise.withResolvers;
delete Promise.try;
for (const name of ["popover", "showPopover", "hidePopover", "togglePopover"]) {
  delete HTMLElement.prototype[name];
}
"""

# Newer than Chrome 111, Firefox 121 or Safari 16.4, and nothing to fall back on.
TOO_NEW = re.compile(
    r"""Map\.groupBy|Object\.groupBy|popover|Promise\.(try|withResolvers)|AbortSignal\.any|URL\.(canParse|parse)\(
    |Array\.fromAsync|\.(isSubsetOf|isSupersetOf|isDisjointFrom|symmetricDifference|toWellFormed|isWellFormed)\(
    |\.(values|keys|entries)\(\)\.(map|filter|find|some|every|toArray|reduce|flatMap|take|drop)\(
    |checkVisibility|requestClose|closedby|moveBefore|setHTMLUnsafe|requestIdleCallback|getOrInsert
    |@scope|@starting-style|interpolate-size|position-anchor|anchor\(|^\s*&""",
    re.VERBOSE | re.MULTILINE,
)


@pytest.fixture
def opened(bench: Callable[..., Bench]) -> Bench:
    made = bench()
    made.page.add_init_script(OF_2023)
    return made.open()


@pytest.mark.browser
@pytest.mark.django_db(transaction=True)
def test_the_key_sheet_opens(opened: Bench) -> None:
    opened.press("?")
    expect(opened.page.locator("dialog .key-groups h3").first).to_be_visible()


@pytest.mark.browser
@pytest.mark.django_db(transaction=True)
def test_the_menu_of_views_opens_and_closes(opened: Bench) -> None:
    menu = opened.page.locator(".views-menu")
    opened.press("u")
    expect(menu).to_be_visible()
    opened.press("Escape")
    expect(menu).to_be_hidden()


def test_nothing_newer_than_the_browsers_named_in_the_readme_is_used() -> None:
    found = {
        f"{path.name}: {match.group().strip()}"
        for folder in ("static", "templates")
        for path in (REPOSITORY / folder).rglob("*")
        if path.suffix in (".js", ".css", ".html")
        for match in TOO_NEW.finditer(without_comments(path.read_text()))
    }
    assert found == set()


def test_colours_of_both_themes_have_a_plain_one_to_fall_back_on() -> None:
    for path in (REPOSITORY / "static").rglob("*.css"):
        text = path.read_text()
        fallback = text.partition("@supports not")[2]
        for name in re.findall(r"(--[\w-]+): light-dark\(", text):
            assert f"{name}: #" in fallback, (path.name, name)
        for line in re.findall(r"^.*(?<!-): light-dark\(.*$", text, re.MULTILINE):
            if "--" not in line.partition("light-dark")[0] and "@supports" not in line:
                assert re.search(r"(color|stroke|fill): #\w+; \1: light-dark", line), line


def without_comments(text: str) -> str:
    return re.sub(r"/\*[\s\S]*?\*/|//.*$", "", text, flags=re.MULTILINE)
