from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest
from django.utils import timezone

from gtm_hit.models import Assignment, Dataset, Layer, Worker
from gtm_hit.ops.work.assignments import (
    BusyElsewhere,
    NoFreeBatch,
    ReadOnly,
    Unfinished,
    claim,
    current,
    expire_leases,
    submit,
    summary,
    work_left,
)
from gtm_hit.ops.work.batches import make_batches
from tests.work_scene import do_frames, finish, make_dataset, make_layer, make_worker, minutes_pass, row, save


@pytest.fixture
def dataset(db: None) -> Dataset:
    dataset = make_dataset(frames=20)
    make_batches(dataset)
    return dataset


@pytest.fixture
def alice(db: None) -> Worker:
    return make_worker("alice")


@pytest.fixture
def bob(db: None) -> Worker:
    return make_worker("bob")


def run_out(assignment: Assignment) -> None:
    Assignment.objects.filter(pk=assignment.pk).update(expires_at=timezone.now() - timedelta(seconds=1))


def state(assignment: Assignment) -> str:
    return Assignment.objects.get(pk=assignment.pk).state


def test_the_first_free_batch_is_leased_with_a_layer_of_its_own(
    dataset: Dataset, alice: Worker, settings: Any
) -> None:
    settings.FIRST_SAVE_MINUTES = 30
    assignment = claim(alice, dataset)
    assert (assignment.batch.number, assignment.state) == (1, "leased")
    assert assignment.layer.name == f"batch-0001-{alice.pseudonym}"
    assert assignment.layer.kind == Layer.Kind.ASSIGNMENT
    assert timedelta(minutes=29) < assignment.expires_at - timezone.now() <= timedelta(minutes=30)


def test_coming_back_continues_the_same_lease(dataset: Dataset, alice: Worker) -> None:
    assert claim(alice, dataset) == claim(alice, dataset)
    assert Layer.objects.count() == 1


def test_two_workers_get_different_batches(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    assert claim(alice, dataset).batch != claim(bob, dataset).batch


def test_without_a_free_batch_nothing_is_made(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    carol = make_worker("carol")
    claim(alice, dataset), claim(bob, dataset)
    assert not work_left(carol, dataset)
    with pytest.raises(NoFreeBatch):
        claim(carol, dataset)
    assert Layer.objects.count() == 2


def test_first_copies_go_out_before_second_ones(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    make_batches(dataset, copies=2)
    carol = make_worker("carol")
    got = [claim(worker, dataset).batch for worker in (alice, bob, carol)]
    assert [(batch.number, batch.copy) for batch in got] == [(1, 1), (2, 1), (1, 2)]


def test_a_worker_never_gets_another_copy_of_a_batch_he_had(dataset: Dataset, alice: Worker) -> None:
    make_batches(dataset, copies=3)
    numbers = [finish(claim(alice, dataset)).batch.number for _batch in range(2)]
    assert numbers == [1, 2]
    assert not work_left(alice, dataset)
    with pytest.raises(NoFreeBatch):
        claim(alice, dataset)


def test_an_unfinished_batch_elsewhere_comes_first(dataset: Dataset, alice: Worker) -> None:
    other = make_dataset("other")
    make_batches(other)
    held = claim(alice, other)
    with pytest.raises(BusyElsewhere) as busy:
        claim(alice, dataset)
    assert busy.value.assignment == held


def test_a_lease_that_ran_out_frees_the_batch(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    first = claim(alice, dataset)
    claim(bob, dataset)
    carol = make_worker("carol")
    run_out(first)
    assert work_left(carol, dataset)
    assert claim(carol, dataset).batch == first.batch
    assert state(first) == "expired"


def test_expire_leases_ends_only_what_ran_out(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    first, second = claim(alice, dataset), claim(bob, dataset)
    run_out(first)
    assert expire_leases() == 1
    assert (state(first), state(second)) == ("expired", "leased")
    assert expire_leases() == 0


def test_expire_leases_takes_the_time_it_is_given(dataset: Dataset, alice: Worker) -> None:
    assignment = claim(alice, dataset)
    assert expire_leases(assignment.expires_at - timedelta(seconds=1)) == 0
    assert expire_leases(assignment.expires_at) == 1


@pytest.mark.parametrize("swept", [True, False])
def test_after_the_end_of_the_lease_the_worker_gets_his_batch_back(
    dataset: Dataset, alice: Worker, swept: bool
) -> None:
    first = claim(alice, dataset)
    save(first.layer, dataset.frames.get(number=5), [row(3)], author=alice)
    run_out(first)
    if swept:
        expire_leases()
    assert current(alice, dataset) is None
    again = claim(alice, dataset)
    assert (again, again.layer, again.nonce) == (first, first.layer, first.nonce)
    assert again.editable
    assert again.layer.annotations.get().person == 3


def test_if_somebody_else_took_it_the_worker_gets_a_new_one(
    dataset: Dataset, alice: Worker, bob: Worker
) -> None:
    first = claim(alice, dataset)
    run_out(first)
    assert claim(bob, dataset).batch == first.batch
    assert claim(alice, dataset).batch.number == 2


def test_a_save_extends_the_lease(dataset: Dataset, alice: Worker) -> None:
    assignment = claim(alice, dataset)
    soon = timezone.now() + timedelta(minutes=1)
    Assignment.objects.update(expires_at=soon)
    save(assignment.layer, dataset.frames.get(number=0), [], author=alice)
    assert Assignment.objects.get().expires_at > soon + timedelta(minutes=30)


def test_a_save_after_the_end_is_refused(dataset: Dataset, alice: Worker) -> None:
    assignment = claim(alice, dataset)
    run_out(assignment)
    with pytest.raises(ReadOnly, match="expired"):
        save(assignment.layer, dataset.frames.get(number=0), [], author=alice)


def test_another_worker_may_not_save(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    assignment = claim(alice, dataset)
    with pytest.raises(ReadOnly, match="not_author"):
        save(assignment.layer, dataset.frames.get(number=0), [], author=bob)


def test_submitting_needs_every_frame_done(dataset: Dataset, alice: Worker) -> None:
    assignment = claim(alice, dataset)
    save(assignment.layer, dataset.frames.get(number=0), [row()], author=alice, done=True)
    save(assignment.layer, dataset.frames.get(number=5), [row()], author=alice)
    with pytest.raises(Unfinished) as unfinished:
        submit(assignment)
    assert unfinished.value.frames == list(range(5, 50, 5))
    assert state(assignment) == "leased"
    assert Assignment.objects.get().code is None


def test_submitting_gives_an_unguessable_code_and_again_the_same(dataset: Dataset, alice: Worker) -> None:
    submitted = finish(claim(alice, dataset))
    assert submitted.state == "submitted"
    assert submitted.code and len(submitted.code) == 20
    assert submit(submitted).code == submitted.code


def test_codes_differ(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    assert finish(claim(alice, dataset)).code != finish(claim(bob, dataset)).code


def test_after_submission_nothing_can_be_saved(dataset: Dataset, alice: Worker) -> None:
    submitted = finish(claim(alice, dataset))
    with pytest.raises(ReadOnly, match="submitted"):
        save(submitted.layer, dataset.frames.get(number=0), [], 1, author=alice)


def test_what_ran_out_cannot_be_submitted(dataset: Dataset, alice: Worker) -> None:
    assignment = claim(alice, dataset)
    do_frames(assignment)
    run_out(assignment)
    with pytest.raises(ReadOnly, match="expired"):
        submit(assignment)


def test_a_submitted_batch_is_not_given_again(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    first = finish(claim(alice, dataset))
    run_out(first)
    assert expire_leases() == 0
    assert claim(bob, dataset).batch != first.batch


def test_returned_work_is_editable_again_and_keeps_its_code(dataset: Dataset, alice: Worker) -> None:
    submitted = finish(claim(alice, dataset))
    Assignment.objects.filter(pk=submitted.pk).update(state="returned")
    run_out(submitted)
    assert current(alice, dataset) == submitted
    save(submitted.layer, dataset.frames.get(number=0), [row()], 1, author=alice, done=True)
    assert submit(submitted).code == submitted.code
    assert state(submitted) == "submitted"


def test_a_rejected_batch_is_free_for_others_only(dataset: Dataset, alice: Worker, bob: Worker) -> None:
    rejected = finish(claim(alice, dataset))
    Assignment.objects.filter(pk=rejected.pk).update(state="rejected")
    assert claim(alice, dataset).batch.number == 2
    assert claim(bob, dataset).batch == rejected.batch


def test_the_summary_counts_frames_people_and_minutes(dataset: Dataset, alice: Worker) -> None:
    assignment = claim(alice, dataset)
    frame = dataset.frames.get(number=5)
    minutes_pass(assignment)
    save(assignment.layer, frame, [row(1), row(2, 9)], author=alice, done=True, seconds=90)
    said = summary(finish(assignment))
    assert said["frames"][:2] == [{"number": 0, "people": 0}, {"number": 5, "people": 2}]
    assert (len(said["frames"]), said["annotations"], said["minutes"]) == (10, 2, 1.5)


def test_people_of_other_layers_are_not_in_the_summary(dataset: Dataset, alice: Worker) -> None:
    save(make_layer(dataset), dataset.frames.get(number=0), [row()])
    assert summary(finish(claim(alice, dataset)))["annotations"] == 0
