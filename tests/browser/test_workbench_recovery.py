"""Edits left in the browser meet their own layer again, and no other; nothing found there stops the page."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import timedelta
from typing import Any

import pytest
from django.utils import timezone
from playwright.sync_api import expect

from gtm_hit.models import Layer, Save
from tests.browser.bench import Bench

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

NOTHING_SENT = "() => { window.fetch = () => Promise.reject(new TypeError('no network')) }"
# Every record of edits, changed by `change` and put back.
REWRITE = """
async (change) => {
  const alter = new Function("record", change);
  const open = indexedDB.open("ground-truth-marker");
  await new Promise((done) => (open.onsuccess = done));
  const frames = open.result.transaction("frames", "readwrite").objectStore("frames");
  const all = await new Promise((done) => (frames.getAll().onsuccess = ({ target }) => done(target.result)));
  frames.clear();
  for (const record of all) frames.put(alter(record) ?? record);
  await new Promise((done) => (frames.transaction.oncomplete = done));
  open.result.close();
  return all;
}
"""


def left_behind(opened: Bench, change: str = "") -> list[Any]:
    """Move person 1 without network, leave the page, and change what the journal has of it."""
    page = opened.page
    page.evaluate(NOTHING_SENT)  # a network that is away lets through what is sent on leaving
    opened.press("Tab", "ArrowLeft")
    expect(page.locator(".save-words")).to_have_text(re.compile("Offline"))
    page.goto(opened.server.url + "/login/")
    assert Save.objects.count() == 1
    records: list[Any] = page.evaluate(REWRITE, change)
    assert len(records) == 1
    return records


def formerly(opened: Bench) -> str:
    """As earlier versions kept edits: under the layer's number, the base without its revision."""
    name = f"assignment {opened.assignment.layer.pk}"
    return f"record.layer = '{name}'; record.sending = null; delete record.base.revision;"


def test_edits_kept_by_an_earlier_version_are_saved(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    left_behind(opened, formerly(opened))
    opened.open()
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2", timeout=15_000)
    assert Save.objects.count() == 2
    assert opened.page.evaluate(f"({REWRITE})('')") == []


def test_edits_older_than_the_layer_are_not_its_own(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    left_behind(opened, formerly(opened))
    made_again(opened)
    opened.open()
    opened.saved()
    assert Save.objects.count() == 1


def test_edits_of_another_databases_layer_with_the_same_number_do_not_meet_this_one(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=2).open()
    left_behind(opened)
    made_again(opened)
    opened.open()
    opened.saved()
    assert Save.objects.count() == 1


def made_again(opened: Bench) -> None:
    """As if a new database had given its number to another layer."""
    later = timezone.now() + timedelta(minutes=1)
    Layer.objects.filter(pk=opened.assignment.layer.pk).update(created_at=later)


def test_edits_of_a_frame_that_is_not_there_do_not_keep_the_workbench_from_starting(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=2).open()
    left_behind(opened, "record.frame = 987654;")
    opened.open()
    opened.press("Tab", "ArrowLeft")
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2", timeout=15_000)


def test_a_journal_that_cannot_be_read_does_not_keep_the_workbench_from_starting(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=2)
    opened.page.add_init_script("IDBIndex.prototype.getAll = () => { throw new Error('broken'); }")
    opened.open()
    opened.press("Tab", "ArrowLeft")
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2", timeout=15_000)
