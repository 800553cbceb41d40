from __future__ import annotations

import uuid

import pytest
from django.contrib.auth.models import User

from gtm_hit.models import Annotation, Dataset, Layer, Save, Worker
from gtm_hit.ops.frames import saving
from gtm_hit.ops.frames.rules import InvalidFrame
from gtm_hit.ops.tutorial import lesson
from gtm_hit.ops.tutorial.lesson import (
    NoTutorial,
    Step,
    StepsMissing,
    available,
    check,
    finish,
    load,
)
from tests.tutorial_scene import make_tutorial, solved
from tests.work_scene import as_sent, make_dataset, make_layer, make_worker, row, save


@pytest.fixture
def dataset(db: None) -> Dataset:
    return make_tutorial()


@pytest.fixture
def worker(dataset: Dataset) -> Worker:
    return make_worker()


def test_the_first_three_frames_are_prepared(dataset: Dataset) -> None:
    states = load().states()
    assert [state.number for state in states] == [0, 5, 10]
    assert [sum(row.state == "carried" for row in state.annotations) for state in states] == [1, 2, 0]


def test_what_is_shown_gives_no_mistake_away(dataset: Dataset) -> None:
    rows = [row for state in load().states() for row in state.annotations]
    assert {row.origin for row in rows} <= {"clicked", "carried"}
    assert all(row.height is None for row in rows)


@pytest.mark.parametrize("step", list(Step))
def test_a_step_done_right_is_remembered(worker: Worker, step: Step) -> None:
    assert check(worker, step, *solved(step)).ok
    worker.refresh_from_db()
    assert worker.tutorial_steps == [step.value]


@pytest.mark.parametrize("step", list(Step))
def test_a_step_not_begun_is_told_what_is_missing(worker: Worker, step: Step) -> None:
    state = load().state(1 if step is Step.NEXT else 0)
    verdict = check(worker, step, state.number, as_sent(state.annotations))
    assert (verdict.ok, bool(verdict.message)) == (False, True)
    worker.refresh_from_db()
    assert worker.tutorial_steps == []


@pytest.mark.parametrize("step", list(Step))
def test_the_right_work_in_another_frame_does_not_count(worker: Worker, step: Step) -> None:
    assert not check(worker, step, 10, solved(step)[1]).ok


@pytest.mark.parametrize(("columns", "ok"), [(0, True), (6, True), (7, False)])
def test_fifteen_centimetres_are_near_enough(worker: Worker, columns: int, ok: bool) -> None:
    number, rows = solved(Step.PLACE)
    rows[-1]["position"] += columns
    assert check(worker, Step.PLACE, number, rows).ok is ok


def test_a_corrected_person_must_be_validated(worker: Worker) -> None:
    number, rows = solved(Step.CORRECT)
    for one in rows:
        one["state"] = "carried"
    verdict = check(worker, Step.CORRECT, number, rows)
    assert not verdict.ok
    assert "yellow" in verdict.message


def test_removing_everybody_is_not_removing_the_wrong_one(worker: Worker) -> None:
    verdict = check(worker, Step.REMOVE, 0, [])
    assert not verdict.ok
    assert "Undo" in verdict.message


def test_impossible_annotations_are_refused(worker: Worker) -> None:
    with pytest.raises(InvalidFrame):
        check(worker, Step.PLACE, 0, [row(1, -1)])


def test_checking_saves_no_annotations(worker: Worker) -> None:
    before = Save.objects.count(), Annotation.objects.count()
    check(worker, Step.PLACE, *solved(Step.PLACE))
    assert (Save.objects.count(), Annotation.objects.count()) == before


def test_the_tutorial_is_finished_after_every_step(worker: Worker) -> None:
    for step in Step:
        check(worker, step, *solved(step))
    first = finish(worker).tutorial_done_at
    assert first
    assert finish(worker).tutorial_done_at == first


def test_it_is_not_finished_before(worker: Worker) -> None:
    for step in (Step.NEXT, Step.PLACE):
        check(worker, step, *solved(step))
    with pytest.raises(StepsMissing) as missing:
        finish(worker)
    assert missing.value.steps == ["correct", "remove"]
    worker.refresh_from_db()
    assert worker.tutorial_done_at is None


def test_without_its_dataset_there_is_no_tutorial(db: None) -> None:
    make_dataset("other")
    assert not available()
    with pytest.raises(NoTutorial):
        load()


@pytest.mark.parametrize("change", [{"hidden": False}, {"kind": Layer.Kind.IMPORTED}])
def test_only_a_hidden_ground_truth_is_judged_against(dataset: Dataset, change: dict[str, object]) -> None:
    Layer.objects.update(**change)
    assert not available()


def test_a_truth_without_people_makes_no_tutorial(dataset: Dataset) -> None:
    Layer.objects.all().delete()
    truth = make_layer(dataset, "truth", Layer.Kind.GROUND_TRUTH, hidden=True)
    for frame in dataset.frames.all():
        save(truth, frame, [])
    assert not available()


def test_an_imported_truth_is_taken_as_it_was_imported(dataset: Dataset) -> None:
    before = load().exercise
    layer, frame = Layer.objects.get(), dataset.frames.order_by("number")[0]
    manager = User.objects.create_user("manager")
    saving.save_frame(layer, frame, manager, uuid.uuid4(), 1, [])
    assert available() and load().exercise == before


def test_a_truth_made_by_staff_is_taken_as_it_is(dataset: Dataset) -> None:
    user = User.objects.create_user("manager")
    Save.objects.update(user=user)
    layer, frame = Layer.objects.get(), dataset.frames.order_by("number")[0]
    saving.save_frame(layer, frame, user, uuid.uuid4(), 1, [])
    assert not available()


def test_whether_there_is_a_tutorial_is_asked_without_making_it(
    dataset: Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    def made(*_asked: object) -> None:
        raise AssertionError("the exercise was made")

    monkeypatch.setattr(lesson, "make_exercise", made)
    assert available()
