from __future__ import annotations

import pytest

from gtm_hit.models import Batch, Dataset, Frame
from gtm_hit.ops.work.batches import BatchError, make_batches
from tests.work_scene import add_frames, make_dataset


@pytest.fixture
def dataset(db: None) -> Dataset:
    return make_dataset(frames=25)


def frames_by_batch(dataset: Dataset) -> dict[tuple[int, int], list[int]]:
    return {
        (batch.number, batch.copy): list(batch.frames.order_by("number").values_list("number", flat=True))
        for batch in Batch.objects.filter(dataset=dataset)
    }


def test_frames_are_cut_in_order_and_the_rest_is_a_batch_too(dataset: Dataset) -> None:
    assert make_batches(dataset) == 3
    assert frames_by_batch(dataset) == {
        (1, 1): list(range(0, 50, 5)),
        (2, 1): list(range(50, 100, 5)),
        (3, 1): list(range(100, 125, 5)),
    }


def test_again_adds_nothing(dataset: Dataset) -> None:
    make_batches(dataset, copies=2)
    assert make_batches(dataset, copies=2) == 0
    assert make_batches(dataset, size=4, copies=1) == 0


def test_new_frames_get_new_batches_and_old_ones_stay(dataset: Dataset) -> None:
    make_batches(dataset)
    before = frames_by_batch(dataset)
    add_frames(dataset, 3)
    assert make_batches(dataset) == 1
    assert frames_by_batch(dataset) == {**before, (4, 1): [125, 130, 135]}


def test_a_batch_never_jumps_over_frames_of_another(dataset: Dataset) -> None:
    make_batches(dataset)
    Frame.objects.bulk_create(Frame(dataset=dataset, number=number) for number in (1, 2, 126))
    make_batches(dataset)
    batches = frames_by_batch(dataset)
    assert [batches[number, 1] for number in (4, 5)] == [[1, 2], [126]]


def test_copies_have_the_same_frames_under_the_same_number(dataset: Dataset) -> None:
    make_batches(dataset)
    assert make_batches(dataset, copies=3) == 6
    batches = frames_by_batch(dataset)
    assert batches[2, 1] == batches[2, 2] == batches[2, 3]


def test_a_dataset_without_frames_gets_no_batches(db: None) -> None:
    assert make_batches(make_dataset(frames=0)) == 0


@pytest.mark.parametrize("values", [{"size": 0}, {"size": 501}, {"copies": 0}, {"copies": 21}, {"size": -1}])
def test_impossible_sizes_are_refused(dataset: Dataset, values: dict[str, int]) -> None:
    with pytest.raises(BatchError):
        make_batches(dataset, **values)
    assert not Batch.objects.exists()


def test_other_datasets_are_left_alone(dataset: Dataset) -> None:
    make_dataset("other")
    make_batches(dataset)
    assert set(Batch.objects.values_list("dataset__slug", flat=True)) == {"square"}
