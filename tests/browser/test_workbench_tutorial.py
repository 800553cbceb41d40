"""The tutorial is the workbench itself: every step done with real clicks and keys, judged by the server."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Worker
from gtm_hit.ops.tutorial import lesson
from gtm_hit.ops.tutorial.exercise import Exercise
from gtm_hit.ops.work import links, workers
from tests.browser.bench import TWO_FRAMES, best_view, click_position, place_on_page
from tests.browser.street import make_street, tell_truth

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


CYAN = """
() => [...document.querySelectorAll(".pane-marks")].reduce((sum, canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  for (let i = 0; i < data.length; i += 4) {
    if (data[i] === 47 && data[i + 1] === 227 && data[i + 2] === 247) sum += 1;
  }
  return sum;
}, 0)
"""


@dataclass
class Learner:
    worker: Worker
    address: str
    exercise: Exercise


@pytest.fixture
def learner(live_server: LiveServer) -> Learner:
    street = make_street(people=6, frames=3, slug="demo")
    tell_truth(street)
    worker = workers.enter("link", "newcomer")
    path = f"/work/{links.worker_token(worker, street.dataset)}/tutorial/"
    return Learner(worker, live_server.url + path, lesson.load().exercise)


def start(page: Page, learner: Learner) -> Locator:
    page.set_viewport_size({"width": 1920, "height": 1080})
    page.goto(learner.address)
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    return page.locator(".tutorial")


def test_the_tutorial_can_be_done_step_by_step(page: Page, learner: Learner) -> None:
    exercise = learner.exercise
    card = start(page, learner)

    expect(card).to_contain_text("step 1 of 4")
    click_truth(page, exercise.truth[0][exercise.missing])
    next_step(page)

    expect(card).to_contain_text("step 2 of 4")
    choose(page, exercise.shifted)
    page.get_by_role("button", name="Check").click()
    expect(card).to_contain_text("stands beside the box")
    click_truth(page, exercise.truth[0][exercise.shifted], button="right")
    next_step(page)

    expect(card).to_contain_text("step 3 of 4")
    choose(page, exercise.invented)
    page.keyboard.press("Backspace")
    next_step(page)

    expect(card).to_contain_text("step 4 of 4")
    page.keyboard.press("n")
    expect(page.locator(".place")).to_have_text("Frame 2 of 3")
    for person in exercise.carried:
        choose(page, person)
        click_truth(page, exercise.truth[1][person], button="right")
        page.keyboard.press("e")
    expect(card).to_contain_text("What is looked at in your work")
    page.get_by_role("button", name="Finish the tutorial").click()
    page.wait_for_url("**/work/*/")
    learner.worker.refresh_from_db()
    assert learner.worker.tutorial_done_at is not None


@pytest.mark.parametrize("size", [(1280, 800), (1920, 1080)])
def test_a_novice_who_makes_every_mistake_is_led_through(
    page: Page, learner: Learner, size: tuple[int, int]
) -> None:
    exercise = learner.exercise
    card = start(page, learner)
    page.set_viewport_size({"width": size[0], "height": size[1]})
    feet = exercise.truth[0][exercise.missing]
    new = page.locator(".people .number").get_by_text(str(exercise.next_person), exact=True)

    click_body(page, feet)
    says(page, card, "click on the body")
    expect(new).to_have_count(0)  # taken back
    click_truth(page, feet + 12)
    says(page, card, "30 cm from the feet")
    for _ in range(2):
        page.keyboard.press("ArrowRight")
        page.wait_for_timeout(700)
    says(page, card, "dashed ring lies where the feet are")
    click_truth(page, feet, button="right")
    next_step(page)

    says(page, card, "")  # another step says nothing before anything was done
    click_truth(page, exercise.shifted_to)
    page.keyboard.press("ArrowUp")
    says(page, card, f"Box {exercise.shifted} is")
    click_truth(page, exercise.truth[0][exercise.shifted], button="right")
    next_step(page)

    click_truth(page, exercise.truth[0][exercise.right])
    page.keyboard.press("Backspace")
    says(page, card, f"Person {exercise.right} was right")
    page.keyboard.press("Control+z")
    click_truth(page, exercise.invented_at)
    page.keyboard.press("Backspace")
    next_step(page)

    page.keyboard.press("n")
    expect(page.locator(".place")).to_have_text("Frame 2 of 3")
    says(page, card, "")
    for _ in exercise.carried:
        page.keyboard.press("f")
        page.evaluate(TWO_FRAMES)
        told = page.locator(".details").text_content() or ""
        who = next(each for each in exercise.carried if f"Person {each}:" in told)
        click_truth(page, exercise.truth[1][who], button="right")
    expect(card).to_contain_text("What is looked at in your work")
    in_sight(page, card, "Finish the tutorial")


def says(page: Page, card: Locator, words: str) -> None:
    """The verdict, with title, verdict and buttons in sight."""
    expect(card.locator(".tutorial-verdict")).to_contain_text(words)
    in_sight(page, card, "Check")


def in_sight(page: Page, card: Locator, button: str) -> None:
    size = page.viewport_size
    assert size is not None
    for part in (
        card.locator("h2"),
        card.locator(".tutorial-verdict"),
        card.get_by_role("button", name=button),
    ):
        box = part.bounding_box()
        if box is not None:  # an empty verdict has none
            assert box["y"] >= 0 and box["y"] + box["height"] <= size["height"]
    shown = card.locator("h2").evaluate(
        "(one) => one.getBoundingClientRect().top >= one.parentElement.getBoundingClientRect().top - 1"
    )
    assert shown, "the title is scrolled away"


def click_body(page: Page, position: int) -> None:
    """On the chest of somebody, where the view shows them best."""
    page.mouse.click(*place_on_page(page, best_view(position), position, height=1.1))


def test_a_finished_step_is_left_with_enter(page: Page, learner: Learner) -> None:
    card = start(page, learner)
    click_truth(page, learner.exercise.truth[0][learner.exercise.missing])
    expect(page.get_by_role("button", name="Next step")).to_be_focused()
    page.keyboard.press("Enter")
    expect(card).to_contain_text("step 2 of 4")


def test_a_click_too_far_off_is_told_by_how_much_without_being_asked(page: Page, learner: Learner) -> None:
    card = start(page, learner)
    off = learner.exercise.truth[0][learner.exercise.missing] + 12  # 30 cm
    page.keyboard.down("Shift")
    click_truth(page, off)
    page.keyboard.up("Shift")
    expect(card).to_contain_text(re.compile(r"(30|31) cm from the feet"))
    expect(card).to_contain_text(re.compile(r"Press .+×, with the pointer over C\d"))
    expect(page.get_by_role("button", name="Next step")).to_be_hidden()


def test_the_spotlight_rings_the_yellow_person_until_they_stand_right(page: Page, learner: Learner) -> None:
    card = start(page, learner)
    expect(page.locator(".pane.in-spotlight")).to_have_count(1)
    click_truth(page, learner.exercise.truth[0][learner.exercise.missing])
    next_step(page)
    assert cyan_without_selection(page) > 100
    choose(page, learner.exercise.shifted)
    click_truth(page, learner.exercise.truth[0][learner.exercise.shifted], button="right")
    expect(card).to_have_attribute("data-ok", "true")
    assert cyan_without_selection(page) == 0


def test_one_can_go_back_to_a_step_and_its_frame(page: Page, learner: Learner) -> None:
    card = start(page, learner)
    click_truth(page, learner.exercise.truth[0][learner.exercise.missing])
    next_step(page)
    page.keyboard.press("n")
    expect(page.locator(".place")).to_have_text("Frame 2 of 3")
    page.get_by_role("button", name="Back", exact=True).click()
    expect(card).to_contain_text("step 1 of 4")
    expect(page.locator(".place")).to_have_text("Frame 1 of 3")
    expect(page.get_by_role("button", name="Next step")).to_be_visible()  # it is still done


def test_starting_over_brings_the_mistakes_back(page: Page, learner: Learner) -> None:
    card = start(page, learner)
    shown = page.locator(".people li")
    before = shown.count()
    click_truth(page, learner.exercise.truth[0][learner.exercise.missing])
    next_step(page)
    expect(shown).to_have_count(before + 1)
    page.get_by_role("button", name="Start over").click()
    expect(card).to_contain_text("step 1 of 4")
    expect(shown).to_have_count(before)


def click_truth(page: Page, position: int, **options: Any) -> None:
    click_position(page, best_view(position), position, **options)


def choose(page: Page, person: int) -> None:
    page.locator(".people .number").get_by_text(str(person), exact=True).click()


def next_step(page: Page) -> None:
    page.get_by_role("button", name="Next step").click()


def cyan_without_selection(page: Page) -> int:
    """Pixels of the colour of rings over all views; nobody is selected, the pointer is elsewhere."""
    page.mouse.move(5, 5)
    page.keyboard.press("Escape")
    page.evaluate(TWO_FRAMES)
    return int(page.evaluate(CYAN))
