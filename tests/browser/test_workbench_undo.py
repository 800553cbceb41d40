"""Undo and redo of everything, across frames, over reloads, crashes and tabs; and the history of a frame."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from gtm_hit.models import Save
from tests.browser.bench import Bench
from tests.browser.test_workbench_identity import go_to, places, saved_with, walked
from tests.browser.test_workbench_saving import SAVES, on_saves, second_tab, words

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_undo_goes_to_the_frame_it_is_about_and_says_what_it_was(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    opened.press("Tab", "Backspace")
    go_to(opened.page, 3)
    opened.press("Tab", "ArrowLeft")
    opened.press("Control+z")
    expect(opened.page.locator(".notices")).to_have_text(re.compile("Undone: move person 1"))
    expect(opened.page.locator("strong.place")).to_have_text("Frame 3 of 3")
    opened.press("Control+z", "Control+z", "Control+z")
    expect(opened.page.locator("strong.place")).to_have_text("Frame 1 of 3")
    expect(opened.page.locator(".notices")).to_have_text("Undone: remove person 1")
    saved_with(opened, [[1, 2, 3]] * 3)


def test_all_kinds_of_edits_are_undone_and_done_again(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    start = [places(opened, index) for index in range(3)]
    opened.press("Tab", "ArrowLeft", "}", "Shift+Delete")
    opened.page.get_by_role("dialog").get_by_role("button", name="Remove").click()
    saved_with(opened, [[2, 3]] * 3)
    opened.press(*["Control+z"] * 5)
    saved_with(opened, [[1, 2, 3]] * 3)
    assert [places(opened, index) for index in range(3)] == start
    expect(opened.page.locator(".notices")).to_have_text("Nothing to undo")
    opened.press(*["Control+y"] * 5)
    saved_with(opened, [[2, 3]] * 3)


def test_an_undo_over_frames_survives_a_crash(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    on_saves(opened.page, lambda route: route.abort())
    opened.press("Tab", "Shift+Delete")
    opened.page.get_by_role("dialog").get_by_role("button", name="Remove").click()
    words(opened.page, re.compile("Offline"))
    crash(opened)
    opened.open()
    saved_with(opened, [[2, 3]] * 3)
    opened.press("Control+z")
    saved_with(opened, [[1, 2, 3]] * 3)


def test_every_tab_undoes_its_own_steps(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    other = second_tab(opened)
    opened.press("Tab", "Backspace")
    words(opened.page, "All saved · r2")
    other.press("Tab", "Tab", "Backspace")
    words(other.page, "All saved · r3")
    opened.open()
    opened.press("Control+z")
    expect(opened.page.locator(".notices")).to_have_text("Undone: remove person 1")
    saved_with(opened, [[1, 3], [1, 2, 3], [1, 2, 3]])


def test_undo_leaves_alone_what_another_tab_changed_since(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    opened.press("Tab", "Shift+Delete")
    opened.page.get_by_role("dialog").get_by_label("Where").select_option("everywhere")
    opened.page.get_by_role("dialog").get_by_role("button", name="Remove").click()
    saved_with(opened, [[2, 3]] * 3)
    other = second_tab(opened)
    other.press("Tab", "r")
    other.page.get_by_role("dialog").get_by_label("New number").fill("9")
    other.press("Enter")
    saved_with(opened, [[3, 9]] * 3)
    opened.press("Control+z")
    saved_with(opened, [[1, 3, 9]] * 3)


def test_tabs_give_away_different_numbers(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, marked=False).open()
    other = second_tab(opened)
    on_saves(opened.page, lambda route: route.abort())
    opened.click_ground(0)
    assert opened.rows() == ["1"]
    other.click_ground(1)
    assert other.rows() == ["2"]
    other.saved()
    third = second_tab(opened)
    third.click_ground(0)
    assert third.rows() == ["2", "3"], "1 is not saved, but the third tab has heard of it"


def test_a_second_authors_new_person_of_the_same_number_is_somebody_else(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=3, marked=False).open()
    other = elsewhere(opened)
    opened.click_ground(0)
    words(opened.page, "All saved · r1")
    on_saves(other.page, lambda route: route.abort())
    other.click_ground(1)
    other.press("k", "k", ">")
    expect(other.page.locator("strong.place")).to_have_text("Frame 2 of 3")
    other.press("c")
    assert other.rows() == ["1"]
    other.page.unroute(SAVES)
    other.press("s")
    saved_with(opened, [[1, 2], [2], []])
    assert other.rows() == ["2"]
    assert [place for _, place in places(opened, 0)][1] == places(opened, 1)[0][1]
    other.press("Control+z")
    saved_with(opened, [[1, 2], [], []])
    other.page.context.close()


def test_a_crash_does_not_answer_the_question_of_a_conflict(bench: Callable[..., Bench]) -> None:
    opened = walked(bench, people=1)
    other = elsewhere(opened)
    opened.press("Tab", *["ArrowLeft"] * 3)
    words(opened.page, "All saved · r2")
    theirs = places(opened, 0)
    other.press("Tab", "ArrowRight")
    expect(other.page.get_by_role("dialog")).to_contain_text("changed in two places")
    other.press("Escape")
    expect(other.page.get_by_role("dialog")).to_contain_text("changed in two places")
    crash(other)
    other.open()
    dialog = other.page.get_by_role("dialog")
    expect(dialog).to_contain_text(opened.assignment.worker.pseudonym)
    assert places(opened, 0) == theirs
    dialog.get_by_label("the other").check()
    dialog.get_by_role("button", name="Use these").click()
    words(other.page, re.compile("All saved"))
    assert places(opened, 0) == theirs
    other.page.context.close()


def test_the_history_of_a_frame_says_who_and_shows_and_restores(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    opened.press("Tab", *["ArrowLeft"] * 3)
    words(opened.page, "All saved · r2")
    opened.press("Backspace")
    words(opened.page, "All saved · r3")
    opened.press("Shift+H")
    rows = opened.page.locator(".revision")
    expect(rows).to_have_count(3)
    expect(rows.first).to_contain_text("r3")
    expect(rows.first).to_contain_text(opened.assignment.worker.pseudonym)
    expect(rows.last).to_contain_text("3 people")
    before = marks(opened.page)
    rows.last.get_by_role("radio").check()
    expect(opened.page.locator(".revision-words")).to_have_text("1 person is not there now")
    opened.painted()
    assert marks(opened.page) != before
    opened.page.get_by_role("button", name="Restore this").click()
    words(opened.page, "All saved · r4")
    first, _, _, newest = Save.objects.filter(layer_frame__frame=opened.street.frames[0]).order_by("revision")
    assert newest.annotations == first.annotations
    expect(rows).to_have_count(4)
    opened.press("Escape", "Control+z")
    saved_with(opened, [[2, 3], [1, 2, 3], [1, 2, 3]])


def test_the_history_follows_to_the_next_frame_without_taking_the_keys(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    opened.press("Shift+H")
    expect(opened.page.locator(".frame-history h2")).to_have_text("History of frame 1")
    opened.pane(0).click(position={"x": 5, "y": 120})
    opened.press("n")
    expect(opened.page.locator(".frame-history h2")).to_have_text("History of frame 2")
    opened.press("n")
    expect(opened.page.locator("strong.place")).to_have_text("Frame 3 of 3")


def crash(opened: Bench) -> None:
    """The page is gone at once, without a word to anybody."""
    page = opened.page.context.new_page()
    page.set_viewport_size({"width": 1920, "height": 1080})
    opened.page.close(run_before_unload=False)
    opened.page = page


def elsewhere(opened: Bench) -> Bench:
    """The same work opened in another browser, which shares nothing with this one but the server."""
    assert opened.page.context.browser
    page = opened.page.context.browser.new_context().new_page()
    page.set_viewport_size({"width": 1920, "height": 1080})
    return Bench(page, opened.server, opened.street, opened.assignment).open()


def marks(page: Page) -> list[str]:
    return page.evaluate("[...document.querySelectorAll('.pane-marks')].map((canvas) => canvas.toDataURL())")
