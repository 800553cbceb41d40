"""A network that is slow, away or not ours: it is said, and no control waits for ever."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, Route, expect

from gtm_hit.models import Assignment, Save
from tests.browser.bench import Bench
from tests.browser.test_workbench_layers import layer, staff

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

__all__ = ["layer", "staff"]  # fixtures

SAVES = re.compile(r"/frames/\d+/$")
SLOW = 2.5  # seconds


def answer_late(page: Page, method: str, seconds: float = SLOW) -> None:
    def late(route: Route) -> None:
        if route.request.method != method:
            return route.continue_()
        answer = route.fetch()
        page.wait_for_timeout(seconds * 1000)
        route.fulfill(response=answer)

    page.route(SAVES, late)


def test_submitting_waits_for_the_save_that_is_under_way(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, frames=1).open()
    answer_late(opened.page, "PUT")
    opened.press("Tab", "ArrowLeft")
    opened.page.wait_for_timeout(900)
    opened.press("n")
    submit = opened.page.get_by_role("button", name="Submit")
    expect(submit).to_be_enabled(timeout=15_000)


def test_submitting_becomes_possible_when_the_last_edit_is_saved(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, frames=1).open()
    opened.page.route(SAVES, lambda route: route.abort())
    opened.press("Tab", "ArrowLeft", "n")
    submit = opened.page.get_by_role("button", name="Submit")
    expect(submit).to_be_disabled()
    opened.page.unroute(SAVES)
    expect(submit).to_be_enabled(timeout=15_000)
    expect(opened.page.get_by_text("Some edits are not saved yet")).to_be_hidden()


def test_saving_without_network_says_what_is_kept(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.page.route(SAVES, lambda route: route.abort())
    opened.press("Tab", "ArrowLeft", "s")
    expect(opened.page.locator(".notices")).to_have_text("Offline – 1 edit kept on this computer")


def test_an_edit_made_while_the_frame_is_loaded_anew_stays_and_is_saved(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    before = opened.stored()[0].position
    answer_late(opened.page, "GET", 0.3)  # before the edit is sent
    opened.press("Tab", "Shift+l", "Backspace")
    expect(opened.page.locator(".notices")).to_contain_text("Frame loaded from the server")
    assert opened.rows() == ["2"]
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2", timeout=15_000)
    assert before not in [one.position for one in opened.stored()]


def test_an_edit_saved_while_the_frame_is_loaded_anew_stays_on_the_page(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    answer_late(opened.page, "GET")  # after the edit was saved, with the frame as it was before
    opened.press("Tab", "Shift+l", "Backspace")
    expect(opened.page.locator(".notices")).to_contain_text("Frame loaded from the server", timeout=15_000)
    assert opened.rows() == ["2"]
    assert [one.person for one in opened.stored()] == [2]


def test_loading_a_frame_anew_without_network_is_said(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.page.route(SAVES, lambda route: route.abort())
    opened.press("Shift+l")
    expect(opened.page.locator(".notices")).to_contain_text("could not be loaded: the server does not answer")
    opened.page.unroute(SAVES)
    opened.press("Shift+l")
    expect(opened.page.locator(".notices")).to_contain_text("Frame loaded from the server")


@pytest.mark.parametrize("status", [0, 401, 502])
def test_going_to_a_frame_that_does_not_come_is_said_and_possible_again(
    staff: Callable[[str], Page], status: int
) -> None:
    page = staff("anna")
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.route(
        re.compile(r"/frames/\?"), lambda route: route.fulfill(status=status) if status else route.abort()
    )
    slider = page.get_by_role("slider", name="Frames")
    slider.focus()
    slider.press("End")
    reason = {0: "the server does not answer", 401: "you are signed out", 502: "does not answer properly"}
    expect(page.locator(".notices")).to_contain_text(reason[status])
    expect(page.locator(".place")).to_have_text("Frame 1 of 60")
    page.unroute(re.compile(r"/frames/\?"))
    slider.press("End")
    expect(page.locator(".place")).to_have_text("Frame 60 of 60")
    assert errors == []


def test_a_film_stops_at_a_frame_that_does_not_come(staff: Callable[[str], Page]) -> None:
    page = staff("anna")
    page.route(re.compile(r"/frames/\?"), lambda route: route.abort())
    slider = page.get_by_role("slider", name="Frames")
    for _ in range(16):
        slider.press("ArrowRight")
    page.keyboard.press("Escape")
    play = page.locator("[data-action=play]")
    play.click()
    expect(play).to_have_attribute("aria-pressed", "true")
    expect(page.locator(".notices")).to_contain_text("could not be loaded", timeout=20_000)
    expect(play).to_have_attribute("aria-pressed", "false")


def test_the_history_of_a_frame_says_that_one_is_signed_out(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    Assignment.objects.filter(pk=opened.assignment.pk).update(nonce="f" * 32)
    opened.press("Shift+h")
    words = opened.page.locator(".revision-words")
    expect(words).to_have_text("The history did not arrive: you are signed out.")


def test_a_page_of_the_networks_own_is_no_receipt(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    asked: list[float] = []

    def welcome(route: Route) -> None:
        if route.request.method != "PUT":
            return route.continue_()
        asked.append(time.monotonic())
        route.fulfill(status=200, content_type="text/html", body="<h1>Welcome to the hotel</h1>")

    opened.page.route(SAVES, welcome)
    opened.press("Tab", "ArrowLeft")
    expect(opened.page.locator(".save-words")).to_contain_text("does not answer properly")
    opened.page.wait_for_timeout(4000)
    assert len(asked) <= 4
    opened.page.unroute(SAVES)
    opened.press("s")
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2")


def test_what_is_not_saved_yet_is_sent_when_the_page_is_left(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("Tab", "ArrowLeft")
    opened.page.goto("about:blank")
    deadline = time.monotonic() + 10
    while Save.objects.count() < 2 and time.monotonic() < deadline:
        time.sleep(0.1)
    assert Save.objects.count() == 2


def test_active_seconds_of_a_save_that_came_too_late_are_counted(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    sent: list[float] = []

    def note(route: Route) -> None:
        if route.request.method == "PUT":
            sent.append(json.loads(route.request.post_data or "{}")["seconds"])
        route.continue_()

    opened.page.route(SAVES, note)
    other = Bench(opened.page.context.new_page(), opened.server, opened.street, opened.assignment).open()
    other.press("Tab", "ArrowLeft")
    other.saved()
    opened.page.bring_to_front()
    opened.page.wait_for_timeout(1500)
    opened.press("Tab", "Tab", "ArrowLeft")
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r3", timeout=15_000)
    assert len(sent) == 2
    assert sent[1] >= sent[0] >= 1.5
