"""Deciding who is the same person, by keys."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import StitchConflict
from gtm_hit.ops.jobs.progress import no_progress
from gtm_hit.ops.stitching import conflicts
from gtm_hit.ops.stitching.running import Asked, stitch_layer
from gtm_hit.ops.stitching.scope import Scope
from tests.stitch_scene import doubtful

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.fixture
def queue(page: Page, live_server: LiveServer, tmp_path: Path, settings: Any) -> Iterator[Page]:
    """Three questions, shown to a reviewer."""
    settings.TABLES_ROOT = tmp_path
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    stitch_layer(Scope(doubtful(pairs=3)), Asked(), None, no_progress)
    client = Client()
    client.force_login(User.objects.create_user("vera", is_superuser=True))
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    page.goto(f"{live_server.url}/datasets/square/stitching/conflicts/")
    yield page
    assert errors == []


def test_one_key_decides_the_next_question_appears_and_undo_takes_it_back(queue: Page) -> None:
    first, second, third = StitchConflict.objects.order_by("pk").values_list("pk", flat=True)
    shown = queue.locator("[data-conflicts]")
    left = queue.locator("[data-left]")
    expect(shown).to_have_attribute("data-shown", str(first))
    expect(queue.locator(".view rect.before").first).to_be_attached()
    expect(queue.locator(".paths polyline.after")).to_be_attached()
    queue.keyboard.press("j")
    expect(shown).to_have_attribute("data-shown", str(second))
    queue.keyboard.press("k")
    expect(shown).to_have_attribute("data-shown", str(third))
    queue.keyboard.press("u")
    expect(shown).to_have_attribute("data-shown", str(second))
    expect(left).to_have_text("2 of 3 · 2 open")
    queue.keyboard.press("ArrowLeft")
    expect(left).to_have_text("1 of 3 · 2 open · decided: the same person")
    queue.keyboard.press("ArrowRight")
    queue.keyboard.press("j")
    queue.keyboard.press("k")
    expect(queue.get_by_text("Nothing is left to decide.")).to_be_visible()
    expect(left).to_contain_text("0 open")
    queue.wait_for_load_state("networkidle")
    decisions = dict(StitchConflict.objects.values_list("pk", "decision"))
    assert decisions == {first: "same", second: "same", third: "apart"}


def test_what_somebody_else_decided_meanwhile_is_told_and_stays(queue: Page) -> None:
    first = StitchConflict.objects.order_by("pk")[0]
    expect(queue.locator("[data-conflicts]")).to_have_attribute("data-shown", str(first.pk))
    conflicts.decide(first, "apart", User.objects.create_user("otto"))
    queue.keyboard.press("j")
    expect(queue.get_by_role("alert")).to_contain_text("otto has decided: two people")
    expect(queue.locator("[data-left]")).to_contain_text("decided: two people")
    first.refresh_from_db()
    assert first.decision == "apart"
