"""The tutorial is the workbench itself: every step done with real clicks and keys, judged by the server."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.ops import tokens, tutorial, workers
from tests.browser.bench import best_view, click_position
from tests.browser.street import make_street, tell_truth

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_the_tutorial_can_be_done_step_by_step(page: Page, live_server: LiveServer) -> None:
    street = make_street(people=6, frames=3, slug="demo")
    tell_truth(street)
    worker = workers.enter("link", "newcomer")
    exercise = tutorial.load().exercise
    page.set_viewport_size({"width": 1920, "height": 1080})
    page.goto(f"{live_server.url}/work/{tokens.worker_token(worker, street.dataset)}/tutorial/")
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    steps = page.locator(".tutorial")

    expect(steps).to_contain_text("step 1 of 4")
    click_truth(page, exercise.truth[0][exercise.missing])
    next_step(page)

    expect(steps).to_contain_text("step 2 of 4")
    choose(page, exercise.shifted)
    page.get_by_role("button", name="Check").click()
    expect(steps).to_contain_text("cm from the feet")
    click_truth(page, exercise.truth[0][exercise.shifted], button="right")
    next_step(page)

    expect(steps).to_contain_text("step 3 of 4")
    choose(page, exercise.invented)
    page.keyboard.press("Backspace")
    next_step(page)

    expect(steps).to_contain_text("step 4 of 4")
    page.keyboard.press("n")
    expect(page.locator(".place")).to_have_text("Frame 2 of 3")
    for person in exercise.carried:
        choose(page, person)
        click_truth(page, exercise.truth[1][person], button="right")
        page.keyboard.press("e")
    page.get_by_role("button", name="Finish the tutorial").click()
    page.wait_for_url("**/work/*/")
    worker.refresh_from_db()
    assert worker.tutorial_done_at is not None


def click_truth(page: Page, position: int, **options: str) -> None:
    click_position(page, best_view(position), position, **options)


def choose(page: Page, person: int) -> None:
    page.locator(".people .number").get_by_text(str(person), exact=True).click()


def next_step(page: Page) -> None:
    page.get_by_role("button", name="Next step").click()
