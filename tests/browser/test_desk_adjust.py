"""Adjusting on its page: dropping a click that is far off, adjusting again, using the result."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Desk, Job, KeptClick
from gtm_hit.ops.desk import adjust_results, adjust_solving
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.adjust_scene import misplaced, noisy_desk

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.fixture
def adjust(page: Page, live_server: LiveServer) -> Iterator[Page]:
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1280, "height": 800})
    desk = noisy_desk()
    click = KeptClick.objects.get(point__name="P7", camera__name="C1")
    KeptClick.objects.filter(pk=click.pk).update(x=click.x + 40)
    adjust_solving.solve(desk, Choices())
    client = Client()
    client.force_login(User.objects.create_superuser("vera"))
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    page.goto(f"{live_server.url}/calibration-desks/plaza/adjust/")
    yield page
    assert errors == []


def test_a_click_far_off_is_dropped_and_the_next_result_is_used(adjust: Page) -> None:
    desk = Desk.objects.get()
    before = misplaced(desk)
    worst = adjust.locator(".thumbnails li").first
    expect(worst).to_contain_text("P7 C1")
    worst.get_by_role("button", name="Drop").click()
    expect(adjust.get_by_text("1 click is dropped", exact=True)).to_be_visible()
    expect(adjust.get_by_text("dropped since")).to_be_visible()
    adjust.get_by_role("button", name="Adjust again").click()
    expect(adjust.locator("[data-job-state]")).to_be_visible()
    queue.run(Job.objects.get().pk, OPERATIONS)
    expect(adjust.get_by_role("heading", name="Result 2")).to_be_visible()
    adjust.get_by_role("button", name="Use this result").click()
    expect(adjust.get_by_text("The cameras stand by result 2")).to_be_visible()
    assert adjust_results.in_use(desk).number == 2 and misplaced(desk) < before
    adjust.get_by_role("button", name="Undo").click()
    expect(adjust.get_by_text("Each camera stands by its own lens")).to_be_visible()
