from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest
from django.utils import timezone

from gtm_hit.models import Assignment, Dataset, Worker
from gtm_hit.ops.work import batches
from gtm_hit.ops.work.assignments import claim
from gtm_hit.ops.work.unsaved_leases import TooManyUnsaved
from tests.work_scene import make_dataset, make_worker, save

HERE, ELSEWHERE = "192.0.2.1", "192.0.2.2"


@pytest.fixture
def dataset(db: None, settings: Any) -> Dataset:
    settings.UNSAVED_PER_ADDRESS = 3
    dataset = make_dataset(frames=300)
    batches.make_batches(dataset, size=1)
    return dataset


def begin(assignment: Assignment) -> None:
    frame = assignment.batch.frames.all()[0]
    save(assignment.layer, frame, [], author=assignment.worker, done=True, nobody=True)


def workers(count: int) -> list[Worker]:
    return [make_worker(f"invented {number}") for number in range(count)]


def run_out() -> None:
    Assignment.objects.update(expires_at=timezone.now() - timedelta(seconds=1))


def minutes_left(assignment: Assignment) -> float:
    assignment.refresh_from_db()
    return (assignment.expires_at - timezone.now()).total_seconds() / 60


def test_a_lease_is_short_until_the_first_save(dataset: Dataset, settings: Any) -> None:
    settings.FIRST_SAVE_MINUTES, settings.LEASE_MINUTES = 5, 60
    assignment = claim(make_worker(), dataset, HERE)
    assert 4 < minutes_left(assignment) <= 5
    begin(assignment)
    assert 59 < minutes_left(assignment) <= 60


def test_a_lease_regained_without_a_save_is_short_again(dataset: Dataset, settings: Any) -> None:
    settings.FIRST_SAVE_MINUTES = 5
    worker = make_worker()
    claim(worker, dataset, HERE)
    run_out()
    assert minutes_left(claim(worker, dataset, HERE)) <= 5


def test_one_address_holds_few_batches_nobody_began(dataset: Dataset) -> None:
    *first, late = workers(4)
    for worker in first:
        claim(worker, dataset, HERE)
    with pytest.raises(TooManyUnsaved):
        claim(late, dataset, HERE)
    assert Assignment.objects.count() == 3
    assert claim(late, dataset, ELSEWHERE)


def test_waiting_until_the_leases_ran_out_gives_no_more(dataset: Dataset) -> None:
    *first, late = workers(4)
    for worker in first:
        claim(worker, dataset, HERE)
    run_out()
    for worker in (*first, late):
        with pytest.raises(TooManyUnsaved):
            claim(worker, dataset, HERE)


def test_a_running_lease_is_continued_whatever_others_did(dataset: Dataset) -> None:
    first = workers(3)
    held = [claim(worker, dataset, HERE) for worker in first]
    assert [claim(worker, dataset, HERE) for worker in first] == held


def test_work_that_was_begun_is_regained_whatever_others_did(dataset: Dataset) -> None:
    first = workers(6)
    own = claim(first[0], dataset, HERE)
    begin(own)
    for worker in first[1:5]:
        claim(worker, dataset, HERE)
    run_out()
    with pytest.raises(TooManyUnsaved):
        claim(first[5], dataset, HERE)
    assert claim(first[0], dataset, HERE) == own


def test_two_hundred_people_who_save_are_not_in_each_others_way(dataset: Dataset) -> None:
    for worker in workers(200):
        begin(claim(worker, dataset, HERE))
    assert Assignment.objects.count() == 200


def test_one_link_gives_few_batches_nobody_began(dataset: Dataset, settings: Any) -> None:
    settings.UNSAVED_PER_LINK = 2
    first, second, late = workers(3)
    claim(first, dataset, HERE)
    claim(second, dataset, ELSEWHERE)
    with pytest.raises(TooManyUnsaved):
        claim(late, dataset, "192.0.2.3")
    assert claim(make_worker("other", "panel"), dataset, "192.0.2.3")


def test_no_address_is_kept_in_clear(dataset: Dataset) -> None:
    assert HERE not in claim(make_worker(), dataset, HERE).address
