from __future__ import annotations

from typing import Any

import pytest

from gtm_hit.models import Assignment, Batch, Dataset
from gtm_hit.ops.frames.neighbours import neighbours
from gtm_hit.ops.work import assignments, batches
from tests.work_scene import as_sent, finish, make_dataset, make_worker, row, save


@pytest.fixture
def dataset(db: None) -> Dataset:
    dataset = make_dataset(frames=30)
    batches.make_batches(dataset, copies=2)
    return dataset


def annotated(batch: Batch, state: str = "accepted", **people_of: list[dict[str, Any]]) -> Assignment:
    """The batch's frames (`f45=[row()]` is frame 45) done by somebody, decided upon as `state`."""
    assignment = assignments.lease(batch, make_worker(f"annotator of {batch.pk}"), "")
    for name, rows in people_of.items():
        frame = batch.frames.get(number=int(name[1:]))
        save(assignment.layer, frame, rows, author=assignment.worker)
    finish(assignment)
    Assignment.objects.filter(pk=assignment.pk).update(state=state)
    return assignment


def batch(dataset: Dataset, number: int, copy: int = 1) -> Batch:
    return Batch.objects.get(dataset=dataset, number=number, copy=copy)


def test_the_frames_next_to_the_batch_come_nearest_first(dataset: Dataset) -> None:
    annotated(batch(dataset, 1), f40=[row(1, 10)], f45=[row(1, 11), row(2, 20)])
    annotated(batch(dataset, 3), f100=[row(8, 80)])
    found = neighbours(batch(dataset, 2))
    assert [frame.number for frame in found.before] == [45, 40, 35, 30]
    assert [frame.number for frame in found.after] == [100, 105, 110, 115]
    assert as_sent(found.before[0].annotations) == [row(1, 11), row(2, 20)]
    assert as_sent(found.before[1].annotations) == [row(1, 10)]
    assert as_sent(found.after[0].annotations) == [row(8, 80)]


@pytest.mark.parametrize("state", ["submitted", "returned", "rejected"])
def test_work_that_was_not_accepted_is_not_carried_on(dataset: Dataset, state: str) -> None:
    annotated(batch(dataset, 1), state, f45=[row()])
    found = neighbours(batch(dataset, 2))
    assert (found.before, found.after) == ([], [])


def test_the_first_batch_has_nothing_before_it(dataset: Dataset) -> None:
    annotated(batch(dataset, 2), f50=[row()])
    found = neighbours(batch(dataset, 1))
    assert found.before == []
    assert [frame.number for frame in found.after] == [50, 55, 60, 65]


def test_a_batch_two_further_is_no_neighbour(dataset: Dataset) -> None:
    annotated(batch(dataset, 1), f45=[row()])
    assert neighbours(batch(dataset, 3)).before == []


def test_of_two_accepted_opinions_the_own_copys_is_carried_on(dataset: Dataset) -> None:
    annotated(batch(dataset, 1, copy=1), f45=[row(1, 10)])
    annotated(batch(dataset, 1, copy=2), f45=[row(2, 20)])
    assert as_sent(neighbours(batch(dataset, 2, copy=1)).before[0].annotations) == [row(1, 10)]
    assert as_sent(neighbours(batch(dataset, 2, copy=2)).before[0].annotations) == [row(2, 20)]


def test_without_an_own_one_another_copy_helps(dataset: Dataset) -> None:
    annotated(batch(dataset, 1, copy=2), f45=[row(2, 20)])
    assert as_sent(neighbours(batch(dataset, 2, copy=1)).before[0].annotations) == [row(2, 20)]


def test_other_datasets_are_never_looked_at(dataset: Dataset) -> None:
    other = make_dataset("other", frames=30)
    batches.make_batches(other)
    annotated(batch(other, 1), f45=[row()])
    assert neighbours(batch(dataset, 2)).before == []


def test_five_queries_are_enough(dataset: Dataset, django_assert_max_num_queries: Any) -> None:
    annotated(batch(dataset, 1), f45=[row()])
    annotated(batch(dataset, 3), f100=[row()])
    middle = batch(dataset, 2)
    with django_assert_max_num_queries(5):
        neighbours(middle)
