"""The workbench speaks the language of the browser when Django has a catalog for it."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import expect
from pytest_django.fixtures import Settings

from tests.browser.bench import Bench

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

POLISH = {
    "": "Content-Type: text/plain; charset=UTF-8\n"
    "Plural-Forms: nplurals=3; plural=(n==1 ? 0 : n%10>=2 && n%10<=4 && (n%100<12 || n%100>14) ? 1 : 2);\n",
    "Frame {place} of {n}": "Klatka {place} z {n}",
    "{n} person\0{n} people": "{n} osoba\0{n} osoby\0{n} osób",
}


def write_mo(path: Path, texts: dict[str, str]) -> None:
    """A compiled catalog, as GNU gettext defines it: two tables of lengths and offsets, then the texts."""
    pairs = sorted((text.encode(), translation.encode()) for text, translation in texts.items())
    count = len(pairs)
    offset = 28 + 16 * count
    tables: list[int] = []
    body = b""
    for column in (0, 1):
        for pair in pairs:
            tables += [len(pair[column]), offset + len(body)]
            body += pair[column] + b"\0"
    path.parent.mkdir(parents=True)
    header = [0x950412DE, 0, count, 28, 28 + 8 * count, 0, 0]
    path.write_bytes(struct.pack(f"<{7 + 4 * count}I", *header, *tables) + body)


def test_texts_and_plurals_come_from_the_catalog_of_the_readers_language(
    bench: Callable[..., Bench], settings: Settings, tmp_path: Path
) -> None:
    write_mo(tmp_path / "pl" / "LC_MESSAGES" / "djangojs.mo", POLISH)
    settings.LOCALE_PATHS = [tmp_path]
    polish = bench(people=4)
    polish.page.set_extra_http_headers({"Accept-Language": "pl"})
    polish.open()
    expect(polish.page.locator("html")).to_have_attribute("lang", "pl")
    expect(polish.page.locator(".place")).to_have_text("Klatka 1 z 3")
    expect(polish.page.locator(".bar .left")).to_have_text("4 osoby")


def test_every_number_gets_its_plural_form(
    bench: Callable[..., Bench], settings: Settings, tmp_path: Path
) -> None:
    write_mo(tmp_path / "pl" / "LC_MESSAGES" / "djangojs.mo", POLISH)
    settings.LOCALE_PATHS = [tmp_path]
    polish = bench(people=1)
    polish.page.set_extra_http_headers({"Accept-Language": "pl"})
    polish.open()
    said = polish.page.evaluate(COUNT, [1, 22, 112, 1022, 1012])
    assert said == ["1 osoba", "22 osoby", "112 osób", "1022 osoby", "1012 osób"]


COUNT = """async (numbers) => {
  const main = document.querySelector("script[src*=main]").src;
  const { ngettext } = await import(main.replace("workbench/main.js", "base/messages.js"));
  return numbers.map((n) => ngettext("{n} person", "{n} people", n));
}"""


def test_without_a_catalog_the_workbench_speaks_english(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    expect(opened.page.locator(".bar .left")).to_have_text("4 people")
