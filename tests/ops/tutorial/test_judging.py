"""Every usual mistake in the tutorial is told as what it is."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.geometry.camera import back_project, project
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.tutorial import lesson
from gtm_hit.ops.tutorial.judging import Mistake, Verdict, boxes_at
from gtm_hit.ops.tutorial.lesson import Step, Tutorial, judge
from tests.browser.street import make_street, tell_truth


@pytest.fixture
def tutorial(db: None) -> Tutorial:
    tell_truth(make_street(people=6, frames=3, slug="demo"))
    return lesson.load()


def shown(tutorial: Tutorial, index: int = 0) -> dict[int, Row]:
    return {row.person: row for row in tutorial.state(index).annotations}


def placed(tutorial: Tutorial, position: int) -> Verdict:
    rows = [*shown(tutorial).values(), Row(tutorial.exercise.next_person, position)]
    return judge(tutorial, Step.PLACE, tutorial.exercise.numbers[0], rows)


def corrected(tutorial: Tutorial, row: Row) -> Verdict:
    rows = {**shown(tutorial), row.person: row}
    return judge(tutorial, Step.CORRECT, tutorial.exercise.numbers[0], list(rows.values()))


def moved(tutorial: Tutorial, position: int, x: float, y: float) -> int:
    """The position so many metres further."""
    grid = tutorial.dataset.grid
    return int(grid.position(grid.metres([position]) + np.array([[x, y]]))[0])


def clicked_at_height(tutorial: Tutorial, height: float) -> list[int]:
    """Where a click at so many metres of the person's height leads in each view, if onto the grid."""
    grid = tutorial.dataset.grid
    xy = grid.metres([tutorial.exercise.truth[0][tutorial.exercise.missing]])
    found = []
    for camera in tutorial.dataset.calibrated_cameras():
        ground = back_project(camera, project(camera, np.column_stack((xy, [[height]]))))
        found += [int(each) for each in grid.position(ground[:, :2]) if each >= 0]
    return found


def test_a_click_on_the_body_is_told_as_one(tutorial: Tutorial) -> None:
    clicks = clicked_at_height(tutorial, 0.9)
    assert clicks
    assert {placed(tutorial, click).mistake for click in clicks} <= {Mistake.BODY, Mistake.OTHER}
    assert Mistake.BODY in {placed(tutorial, click).mistake for click in clicks}


def test_a_click_on_the_feet_is_right_in_every_view(tutorial: Tutorial) -> None:
    clicks = clicked_at_height(tutorial, 0.0)
    assert clicks
    assert all(placed(tutorial, click).ok for click in clicks)


def test_marking_somebody_else_is_told_as_that(tutorial: Tutorial) -> None:
    exercise = tutorial.exercise
    other = next(
        person
        for person in exercise.truth[0]
        if person not in {exercise.missing, exercise.shifted, exercise.right}
    )
    verdict = placed(tutorial, exercise.truth[0][other])
    assert verdict.mistake is Mistake.OTHER
    assert verdict.person == exercise.next_person


def test_a_click_beside_the_feet_is_told_by_how_much_rounded_up(tutorial: Tutorial) -> None:
    feet = tutorial.exercise.truth[0][tutorial.exercise.missing]
    verdict = placed(tutorial, moved(tutorial, feet, 0.125, 0.1))  # 16.01 cm
    assert (verdict.mistake, verdict.feet) == (Mistake.OFF, feet)
    assert "17 cm" in verdict.message


def test_a_box_moved_until_the_head_fits_is_told_with_the_camera(tutorial: Tutorial) -> None:
    person = tutorial.exercise.shifted
    feet = tutorial.exercise.truth[0][person]
    verdict = judge_person_off(tutorial, feet, 0.3)
    assert verdict.mistake is Mistake.HEAD
    assert "only the feet count" in verdict.message


def judge_person_off(tutorial: Tutorial, feet: int, metres: float) -> Verdict:
    """Of the shifted person, moved towards a camera that sees them."""
    grid = tutorial.dataset.grid
    camera = next(
        each
        for each in tutorial.dataset.calibrated_cameras()
        if boxes_at(each, tutorial.dataset, [feet])[1].all()
    )
    towards = camera.centre[:2] - grid.metres([feet])[0]
    x, y = metres * towards / np.hypot(*towards)
    return corrected(tutorial, Row(tutorial.exercise.shifted, moved(tutorial, feet, x, y)))


def test_nothing_done_yet_is_no_mistake(tutorial: Tutorial) -> None:
    exercise = tutorial.exercise
    for step, index in ((Step.PLACE, 0), (Step.CORRECT, 0), (Step.NEXT, 1)):
        verdict = judge(tutorial, step, exercise.numbers[index], list(shown(tutorial, index).values()))
        assert verdict.mistake is Mistake.NOTHING


def test_a_box_that_stands_right_and_is_yellow_wants_a_look(tutorial: Tutorial) -> None:
    exercise = tutorial.exercise
    row = Row.carried(exercise.shifted, exercise.truth[0][exercise.shifted])
    verdict = corrected(tutorial, row)
    assert (verdict.mistake, verdict.person) == (Mistake.YELLOW, exercise.shifted)


def test_somebody_who_was_right_and_is_gone_is_named(tutorial: Tutorial) -> None:
    exercise = tutorial.exercise
    rows = shown(tutorial)
    del rows[exercise.right]
    verdict = judge(tutorial, Step.REMOVE, exercise.numbers[0], list(rows.values()))
    assert (verdict.mistake, verdict.person) == (Mistake.GONE, exercise.right)


def test_an_empty_box_is_still_there(tutorial: Tutorial) -> None:
    rows = list(shown(tutorial).values())
    assert judge(tutorial, Step.REMOVE, tutorial.exercise.numbers[0], rows).mistake is Mistake.EMPTY
