"""Nothing is lost: crashes, dead networks, expired links, two tabs."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, Route, expect

from gtm_hit.models import Assignment, Save
from tests.browser.bench import Bench, metres_apart

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

SAVES = re.compile(r"/frames/\d+/$")


def words(page: Page, text: str | re.Pattern[str]) -> None:
    expect(page.locator(".save-words")).to_have_text(text, timeout=15_000)


def on_saves(page: Page, answer: Callable[[Route], None]) -> None:
    page.route(SAVES, lambda route: answer(route) if route.request.method == "PUT" else route.continue_())


def test_a_dead_network_is_said_in_words_and_survived(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    on_saves(opened.page, lambda route: route.abort())
    opened.press("Tab", "ArrowLeft", "ArrowLeft")
    words(opened.page, "Offline – 2 edits kept on this computer")
    opened.page.unroute(SAVES)
    opened.press("s")
    words(opened.page, "All saved · r2")


def test_edits_survive_a_crash_while_offline(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    before = opened.stored()[0].position
    on_saves(opened.page, lambda route: route.abort())
    opened.press("Tab", *["ArrowLeft"] * 4)
    words(opened.page, re.compile("Offline"))
    opened.page.goto("about:blank")
    opened.page.unroute(SAVES)
    opened.open()
    words(opened.page, "All saved · r2")
    assert metres_apart(before, opened.stored()[0].position) == pytest.approx(0.1, abs=1e-6)


def test_edits_of_a_closed_tab_are_found_by_the_next_one(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    on_saves(opened.page, lambda route: route.abort())
    opened.press("Tab", "Backspace")
    words(opened.page, re.compile("Offline"))
    context = opened.page.context
    opened.page.close()
    opened.page = context.new_page()
    opened.open()
    words(opened.page, "All saved · r2")
    assert [one.person for one in opened.stored()] == [2]


def test_an_answer_lost_on_the_way_does_not_look_like_somebody_elses_edit(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=1).open()
    lost = {"left": 1}

    def lose_once(route: Route) -> None:
        if lost["left"]:
            lost["left"] -= 1
            route.fetch()  # the server writes it
            route.abort()  # and the browser never hears of it
        else:
            route.continue_()

    on_saves(opened.page, lose_once)
    opened.press("Tab", "ArrowLeft")
    words(opened.page, re.compile("Offline"))
    opened.press("ArrowLeft")
    words(opened.page, "All saved · r3")
    assert opened.page.get_by_role("dialog").count() == 0
    assert Save.objects.filter(layer_frame__layer=opened.assignment.layer).count() == 3


def test_a_revoked_link_keeps_the_edits_and_offers_a_way_in(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    Assignment.objects.filter(pk=opened.assignment.pk).update(nonce="f" * 32)
    opened.press("Tab", "ArrowLeft")
    words(opened.page, "Signed out – 1 edit kept on this computer, nothing is lost.")
    expect(opened.page.get_by_role("link", name="Open sign-in in a new tab")).to_be_visible()
    Assignment.objects.filter(pk=opened.assignment.pk).update(nonce=opened.assignment.nonce)
    opened.page.evaluate("window.dispatchEvent(new Event('focus'))")
    words(opened.page, "All saved · r2")


def test_two_tabs_moving_different_people_are_put_together(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    other = second_tab(opened)
    opened.press("Tab", "Backspace")
    words(opened.page, "All saved · r2")
    other.press("Tab", "Tab", "ArrowLeft")
    words(other.page, "All saved · r3")
    assert other.rows() == ["2"]
    assert [one.person for one in opened.stored()] == [2]


def test_two_tabs_moving_the_same_person_ask(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    other = second_tab(opened)
    opened.press("Tab", *["ArrowLeft"] * 3)
    words(opened.page, "All saved · r2")
    theirs = opened.stored()[0].position
    other.press("Tab", "ArrowRight")
    dialog = other.page.get_by_role("dialog")
    expect(dialog).to_contain_text("changed in two places")
    dialog.get_by_label("the other").check()
    dialog.get_by_role("button", name="Use these").click()
    words(other.page, re.compile("All saved"))
    assert opened.stored()[0].position == theirs


def test_people_added_in_two_tabs_are_two_people(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, marked=False).open()
    other = second_tab(opened)
    opened.click_ground(0)
    words(opened.page, "All saved · r1")
    other.click_ground(1)
    words(other.page, "All saved · r2")
    assert [one.person for one in opened.stored()] == [1, 2]


def test_a_submitted_batch_is_read_only_and_says_so(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, frames=1).open()
    opened.press("n")
    opened.page.get_by_role("button", name="Submit").click()
    opened.page.wait_for_url("**/work/**")
    opened.open()
    words(opened.page, re.compile("Read-only"))
    opened.press("Tab", "ArrowLeft")
    expect(opened.page.locator(".notices")).to_contain_text("Read-only")


def test_a_lease_that_ran_out_meanwhile_keeps_the_edit_and_says_why(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    Assignment.objects.filter(pk=opened.assignment.pk).update(state="expired")
    opened.press("Tab", "ArrowLeft")
    words(opened.page, re.compile(r"Read-only: .*1 edit kept"))


def second_tab(opened: Bench) -> Bench:
    page = opened.page.context.new_page()
    page.set_viewport_size({"width": 1920, "height": 1080})
    return Bench(page, opened.server, opened.street, opened.assignment).open()
