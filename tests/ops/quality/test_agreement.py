from __future__ import annotations

import json

import numpy as np
import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Assignment, Dataset
from gtm_hit.ops.quality.agreement import as_numbers, batch_agreements, shared_batches
from gtm_hit.ops.work import assignments, batches
from tests.work_scene import add_frames, do_frames, make_dataset, make_worker, row, save

PLACES = np.array([[0.0, 0.0], [2.0, 1.0], [-3.0, 2.0]])


@pytest.fixture
def dataset(db: None) -> Dataset:
    """One batch of two frames, in two copies."""
    made = make_dataset(frames=2)
    batches.make_batches(made, copies=2)
    return made


def annotate(
    dataset: Dataset, external_id: str, shift: float, persons: tuple[int, ...] = (1, 2, 3)
) -> Assignment:
    """Take the next batch, put everybody `shift` metres to the right of where they are, and submit."""
    mine = assignments.claim(make_worker(external_id), dataset)
    for frame in mine.batch.frames.all():
        xy = PLACES + np.array([shift, 0.0])
        positions = dataset.grid.nearest(xy).tolist()
        rows = [row(person, position) for person, position in zip(persons, positions, strict=True)]
        save(mine.layer, frame, rows, author=mine.worker)
    do_frames(mine)
    return assignments.submit(mine)


def test_workers_of_one_batch_are_compared(dataset: Dataset) -> None:
    one, other = annotate(dataset, "ada", 0.0), annotate(dataset, "ben", 0.1, (3, 1, 2))
    assert one.batch.number == other.batch.number
    (found,) = batch_agreements(dataset, shared_batches(dataset))
    assert found.overall.matched_share == 1.0
    assert found.overall.median_distance == pytest.approx(0.1)
    assert found.overall.identity_agreement == 1.0
    assert found.workers[other.worker.pseudonym].x == pytest.approx(0.1)
    assert found.workers[other.worker.pseudonym].y == pytest.approx(0.0)


def test_a_batch_one_worker_finished_is_not_shared(dataset: Dataset) -> None:
    annotate(dataset, "ada", 0.0)
    assignments.claim(make_worker("ben"), dataset)
    assert list(shared_batches(dataset)) == []
    assert batch_agreements(dataset, [1]) == []


def test_workers_go_by_their_pseudonyms(dataset: Dataset) -> None:
    names = {annotate(dataset, who, 0.0).worker.pseudonym for who in ("ada-lovelace", "ben-franklin")}
    numbers = as_numbers(*batch_agreements(dataset, shared_batches(dataset)))
    assert set(numbers["workers"]) == names
    written = json.dumps(numbers, allow_nan=False)
    assert "ada" not in written and "ben" not in written


def test_queries_do_not_grow_with_batches(dataset: Dataset) -> None:
    add_frames(dataset, 2)
    batches.make_batches(dataset, copies=2)
    for who in "abcd":
        annotate(dataset, f"worker {who}", 0.0)
    assert list(shared_batches(dataset)) == [1, 2]
    costs = []
    for numbers in ([1], [1, 2]):
        with CaptureQueriesContext(connection) as queries:
            assert len(batch_agreements(dataset, numbers)) == len(numbers)
        costs.append(len(queries))
    assert costs == [3, 3]
