"""Chromium finds nothing on the pages that their own policy forbids."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from tests.browser.bench import Bench

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def refusals(page: Page) -> list[str]:
    found: list[str] = []
    page.on("console", lambda said: found.append(said.text) if "Content Security" in said.text else None)
    return found


def test_the_workbench_needs_nothing_that_is_forbidden(bench: Callable[..., Bench]) -> None:
    opened = bench()
    found = refusals(opened.page)
    opened.open().press("?", "Escape", "ArrowRight", "n")
    opened.painted()
    assert found == []


def test_pages_for_staff_need_nothing_that_is_forbidden(
    bench: Callable[..., Bench], page: Page, live_server: LiveServer
) -> None:
    bench()
    found = refusals(page)
    client = Client()
    client.force_login(User.objects.create_user("staff", is_superuser=True))
    session = {"name": "sessionid", "value": client.cookies["sessionid"].value, "url": live_server.url}
    page.context.add_cookies([session])
    for path in (
        "/",
        "/datasets/",
        "/imports/",
        "/exports/",
        "/tokens/",
        "/admin/",
        "/datasets/street/layers/",
    ):
        page.goto(live_server.url + path, wait_until="networkidle")
    page.goto(live_server.url + "/api/v1/docs/")
    expect(page.locator(".opblock").first).to_be_visible(timeout=30_000)
    assert found == []
