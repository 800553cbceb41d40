"""The review desk in a real Chromium: what differs, by which keys one decides, and how few it takes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Assignment, Comment
from gtm_hit.ops.review import transitions
from gtm_hit.ops.review.comments import Pin, remark
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.work import assignments
from tests.browser.street import GRID, Street, annotate, make_street, workbench_path
from tests.work_scene import make_layer, row, save

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.fixture
def street() -> Street:
    return make_street(people=5, frames=10)


@pytest.fixture
def rita() -> User:
    return User.objects.create_user("rita", is_superuser=True)


@pytest.fixture
def reviewer(
    page: Page, live_server: LiveServer, rita: User, tmp_path: Path, settings: Any
) -> Iterator[Page]:
    settings.TABLES_ROOT = tmp_path
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1920, "height": 1080})
    client = Client()
    client.force_login(rita)
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    yield page
    assert errors == []


def truth(street: Street) -> None:
    layer = make_layer(street.dataset, "truth", hidden=True)
    for frame, positions in zip(street.frames, street.truth, strict=True):
        save(layer, frame, [row(index + 1, int(one)) for index, one in enumerate(positions)], done=True)


def work(street: Street, worker: str = "walker", faults: bool = False) -> Assignment:
    """As the truth is; or in frame 5 one is 40 cm off, and in frame 10 one is missed and one invented."""
    assignment = street.claim(worker)
    for frame, positions in zip(street.frames, street.truth, strict=True):
        places = positions.copy()
        if faults and frame.number == 5:
            places[0] = GRID.nearest(GRID.metres(places[:1]) + np.array([0.4, 0.0]))[0]
        if faults and frame.number == 10:
            places[4] = GRID.nearest([[4.0, 20.0]])[0]
        annotate(assignment, frame, places)
    for frame in street.frames:
        frame_head = assignment.layer.layer_frames.get(frame=frame)
        frame_head.done = True
        frame_head.save(update_fields=["done"])
    return assignments.submit(assignment)


def ready(page: Page) -> None:
    expect(page.locator("#viewer")).to_have_attribute("data-ready", "true")


def opened(page: Page, server: LiveServer, assignment: Assignment) -> Page:
    page.goto(f"{server.url}/datasets/street/review/{assignment.pk}/")
    ready(page)
    return page


def state(assignment: Assignment) -> str:
    return Assignment.objects.get(pk=assignment.pk).state


def test_ten_clean_frames_take_two_actions_and_looking_through_them_eleven(
    reviewer: Page, live_server: LiveServer, street: Street, record_property: Any
) -> None:
    truth(street)
    assignment = work(street)
    reviewer.goto(f"{live_server.url}/datasets/street/review/")
    actions = 0
    reviewer.locator("[data-first]").click()
    actions += 1
    ready(reviewer)
    expect(reviewer.locator(".strip")).to_contain_text("10 of 10 frames without a difference")
    for _frame in range(9):
        reviewer.keyboard.press("ArrowRight")
        actions += 1
    expect(reviewer.locator('.strip [data-frame="45"]')).to_have_attribute("aria-current", "true")
    reviewer.keyboard.press("a")
    actions += 1
    expect(reviewer).to_have_url(f"{live_server.url}/datasets/street/review/")
    record_property("actions", actions)
    assert (actions, state(assignment)) == (11, "accepted")


def test_differences_come_worst_first_by_one_key(
    reviewer: Page, live_server: LiveServer, street: Street
) -> None:
    truth(street)
    opened(reviewer, live_server, work(street, faults=True))
    expect(reviewer.locator(".place")).to_contain_text("3 differences")
    said = []
    for _ in range(3):
        reviewer.keyboard.press("n")
        expect(reviewer.locator('.marks [aria-selected="true"]')).to_have_count(1)
        said.append(reviewer.locator('.marks [aria-selected="true"]').get_attribute("data-kind"))
    assert said == ["missed", "extra", "moved"]
    expect(reviewer.locator('.strip [data-frame="5"]')).to_have_attribute("aria-current", "true")
    reviewer.keyboard.press("p")
    expect(reviewer.locator('.marks [aria-selected="true"]')).to_have_attribute("data-kind", "extra")


def test_accepting_with_unseen_differences_asks_first(
    reviewer: Page, live_server: LiveServer, street: Street
) -> None:
    truth(street)
    assignment = work(street, faults=True)
    opened(reviewer, live_server, assignment).keyboard.press("a")
    expect(reviewer.get_by_role("dialog")).to_contain_text("3 differences were not looked at")
    reviewer.keyboard.press("Enter")
    expect(reviewer.locator('.marks [aria-selected="true"]')).to_have_attribute("data-kind", "missed")
    assert state(assignment) == "submitted"


def test_work_goes_back_with_a_comment_pinned_to_the_difference(
    reviewer: Page, live_server: LiveServer, street: Street
) -> None:
    truth(street)
    assignment = work(street, faults=True)
    opened(reviewer, live_server, assignment)
    for _ in range(2):
        reviewer.keyboard.press("n")
    reviewer.keyboard.press("c")
    expect(reviewer.get_by_role("dialog")).to_contain_text("Frame 3, person 5")
    reviewer.keyboard.type("Nobody stands here.")
    reviewer.keyboard.press("Control+Enter")
    expect(reviewer.locator(".comments li")).to_contain_text("Nobody stands here.")
    reviewer.keyboard.press("r")
    reviewer.get_by_role("dialog").get_by_role("button", name="Return").click()
    expect(reviewer).to_have_url(f"{live_server.url}/datasets/street/review/")
    comment = Comment.objects.select_related("frame").get()
    assert comment.frame and (comment.frame.number, comment.person) == (10, 5)
    assert state(assignment) == "returned"


def test_a_rejection_wants_a_category_and_a_reason_and_the_next_one_follows(
    reviewer: Page, live_server: LiveServer, street: Street
) -> None:
    truth(street)
    first = work(street, faults=True)
    transitions.transition(first, Action.RETURN, User.objects.get(), reason="Look again")
    assignments.submit(first)
    opened(reviewer, live_server, first).keyboard.press("x")
    dialog = reviewer.get_by_role("dialog")
    expect(dialog.get_by_role("button", name="Reject")).to_be_disabled()
    dialog.get_by_label("Category").last.select_option("failed_check")
    dialog.get_by_label("Reason").last.fill("One person is missing and one is invented.")
    dialog.get_by_role("button", name="Reject").click()
    expect(reviewer).to_have_url(f"{live_server.url}/datasets/street/review/")
    last = first.transitions.last()
    assert last and (last.category, state(first)) == ("failed_check", "rejected")


def test_a_corrected_copy_is_opened_in_the_workbench_and_accepted_in_its_place(
    reviewer: Page, live_server: LiveServer, street: Street, rita: User
) -> None:
    assignment = work(street)
    opened(reviewer, live_server, assignment).keyboard.press("m")
    expect(reviewer.locator("#workbench")).to_have_attribute("data-ready", "true")
    opened(reviewer, live_server, assignment).keyboard.press("a")
    expect(reviewer).to_have_url(f"{live_server.url}/datasets/street/review/")
    last = assignment.transitions.last()
    assert last and (last.action, last.user) == ("accept_mended", rita)


def test_a_worker_finds_the_comment_on_its_frame_answers_it_and_says_it_is_done(
    reviewer: Page, live_server: LiveServer, street: Street, rita: User
) -> None:
    assignment = work(street, faults=True)
    remark(assignment, rita, "This one is too far right.", Pin(5, 1))
    transitions.transition(assignment, Action.RETURN, rita)
    page = reviewer
    page.context.clear_cookies()
    page.goto(live_server.url + workbench_path(assignment))
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    comment = page.locator(".comments li")
    expect(comment).to_contain_text("This one is too far right.")
    comment.get_by_role("button", name="Frame 2, person 1").click()
    expect(comment).to_have_class("here")
    expect(page.locator('.people [aria-selected="true"]')).to_contain_text("1")
    comment.get_by_label("Answer").fill("Moved to the left")
    comment.get_by_label("Answer").press("Enter")
    expect(comment).to_contain_text("You: Moved to the left")
    comment.get_by_role("button", name="Done").click()
    expect(page.locator(".comments h2")).to_contain_text("All comments are done")
    assert [one.text for one in Comment.objects.filter(answers__isnull=False)] == ["Moved to the left"]
    assert Comment.objects.get(answers=None).resolved_at
