"""Planted faults: in what a batch starts with, judged when it is submitted, and never anywhere else."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Annotation, Assignment, Campaign, Layer, PlantedFault, Save
from gtm_hit.ops.frames.metres import placed
from gtm_hit.ops.gold import planting
from gtm_hit.ops.gold.errors import GoldError
from gtm_hit.ops.gold.withdraw import withdraw
from gtm_hit.ops.review import mending
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition
from gtm_hit.ops.work import assignments, unsaved_leases
from gtm_hit.ops.work.pools import Pool
from gtm_hit.scoring.faults import ALL_KINDS, FaultKind
from tests.gold_scene import (
    annotate,
    confirm,
    hand_in,
    make_scene,
    places,
    plant_everywhere,
    take,
    truth_of_square,
)
from tests.ops.review.scene import make_reviewer
from tests.ops.square_layer import export
from tests.work_scene import make_layer, make_worker, row, save

pytestmark = pytest.mark.django_db


@pytest.fixture
def scene() -> Iterator[tuple[Campaign, Layer]]:
    yield make_scene()


@pytest.fixture
def planted(scene: tuple[Campaign, Layer]) -> Assignment:
    campaign, truth = scene
    plant_everywhere(campaign, truth)
    return take(campaign)


def exported(layer: Layer, folder: Path) -> dict[int, dict[int, int]]:
    files = (export(layer, folder, "wildtrack") / "annotations_positions").glob("*.json")
    return {
        int(file.stem): {one["personID"]: one["positionID"] for one in json.loads(file.read_text())}
        for file in files
    }


def true(assignment: Assignment) -> dict[int, dict[int, int]]:
    numbers = set(assignment.batch.frames.values_list("number", flat=True))
    return {number: people for number, people in truth_of_square().items() if number in numbers}


def test_without_settings_a_batch_starts_empty(scene: tuple[Campaign, Layer]) -> None:
    assert not Annotation.objects.filter(layer=take(scene[0]).layer).exists()


def test_with_a_share_of_nothing_it_starts_with_the_layer_as_it_is(scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    planting.settle(campaign, truth, 0.0)
    assignment = take(campaign)
    assert places(assignment.layer) == true(assignment)
    assert set(Annotation.objects.filter(layer=assignment.layer).values_list("state", "origin")) == {
        ("carried", "proposed")
    }


def test_the_faults_are_rows_that_say_so(planted: Assignment) -> None:
    shown, right = places(planted.layer), true(planted)
    faults = list(PlantedFault.objects.select_related("frame"))
    assert len(faults) == 3
    for fault in faults:
        here = shown[fault.frame.number]
        if fault.kind == "removed":
            assert fault.person not in here
        else:
            assert here[fault.person] == fault.position_to != right[fault.frame.number].get(fault.person)


def test_a_frame_with_faults_has_the_history_of_one_without(planted: Assignment) -> None:
    saves = Save.objects.filter(layer_frame__layer=planted.layer)
    assert set(saves.values_list("revision", "user", "worker", "done")) == {(1, None, None, False)}
    assert saves.count() == 10


def test_somebody_else_who_gets_the_batch_gets_his_own_faults_and_the_same_ones_again(
    scene: tuple[Campaign, Layer],
) -> None:
    campaign, truth = scene
    plant_everywhere(campaign, truth)
    first, second = take(campaign), take(campaign, "bob")
    kinds = "frame__number", "kind", "person", "position_to"
    faults = [
        list(PlantedFault.objects.filter(assignment=one).values_list(*kinds)) for one in (first, second)
    ]
    assert faults[0] != faults[1]
    again = assignments.claim(first.worker, Pool(campaign.dataset, campaign))
    assert list(PlantedFault.objects.filter(assignment=again).values_list(*kinds)) == faults[0]


def test_a_lease_that_only_holds_what_it_started_with_still_counts_as_unsaved(planted: Assignment) -> None:
    waiting = Assignment.objects.filter(~unsaved_leases.SAVED)
    assert list(waiting) == [planted]
    annotate(planted, true(planted))
    assert not waiting.all().exists()


def test_who_repairs_everything_keeps_his_work_as_he_saved_it(planted: Assignment) -> None:
    hand_in(planted, true(planted))
    assert set(PlantedFault.objects.values_list("repaired", "withdrawn_by")) == {(True, None)}
    assert places(planted.layer) == true(planted)


def test_who_repairs_nothing_leaves_nothing_of_it(planted: Assignment) -> None:
    confirm(planted)
    assignments.submit(planted)
    assert set(PlantedFault.objects.values_list("repaired", flat=True)) == {False}
    assert places(planted.layer) == true(planted)


def test_what_was_taken_out_is_a_save_by_nobody_that_the_fault_names(planted: Assignment) -> None:
    confirm(planted)
    assignments.submit(planted)
    for fault in PlantedFault.objects.select_related("withdrawn_by__layer_frame"):
        assert fault.withdrawn_by is not None
        assert fault.withdrawn_by.layer_frame.frame_id == fault.frame_id
        assert (fault.withdrawn_by.worker, fault.withdrawn_by.revision) == (None, 3)


def test_taking_out_again_changes_nothing(planted: Assignment) -> None:
    confirm(planted)
    assignments.submit(planted)
    before = Save.objects.count()
    assert withdraw(planted) == []
    assert Save.objects.count() == before


def test_an_export_of_submitted_work_is_the_truth(planted: Assignment, tmp_path: Path) -> None:
    confirm(planted)
    assignments.submit(planted)
    assert exported(planted.layer, tmp_path / "out") == true(planted)


def test_an_export_of_work_that_is_not_submitted_has_no_fault_either(
    planted: Assignment, tmp_path: Path
) -> None:
    assert exported(planted.layer, tmp_path / "out") == true(planted)
    assert places(planted.layer) != true(planted)


def test_rows_in_metres_have_no_fault_either(planted: Assignment) -> None:
    rows, _more = placed(planted.layer, 0, 1000, 50)
    found: dict[int, dict[int, int]] = {}
    for one in rows:
        found.setdefault(one.frame, {})[one.row.person] = one.row.position
    assert found == true(planted)


@pytest.mark.parametrize("kind", ALL_KINDS)
def test_each_kind_alone_is_planted_and_taken_out(scene: tuple[Campaign, Layer], kind: FaultKind) -> None:
    campaign, truth = scene
    plant_everywhere(campaign, truth, kinds=[kind])
    assignment = take(campaign)
    assert set(PlantedFault.objects.values_list("kind", flat=True)) == {kind}
    confirm(assignment)
    assignments.submit(assignment)
    assert places(assignment.layer) == true(assignment)


def test_sizes_stay_with_the_bodies(scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    for annotation in truth.annotations.all():
        Annotation.objects.filter(pk=annotation.pk).update(height=1.5 + annotation.person / 100)
    plant_everywhere(campaign, truth, kinds=[FaultKind.SWAPPED])
    assignment = take(campaign)
    heights = {(one.frame_id, one.position): one.height for one in truth.annotations.all()}
    for one in Annotation.objects.filter(layer=assignment.layer):
        assert one.height == heights[one.frame_id, one.position]


def test_an_invented_person_has_a_size_like_the_others(scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    truth.annotations.update(height=1.7)
    plant_everywhere(campaign, truth, kinds=[FaultKind.INVENTED])
    assert set(take(campaign).layer.annotations.values_list("height", flat=True)) == {1.7}


def test_somebody_who_comes_back_has_his_size_again(scene: tuple[Campaign, Layer]) -> None:
    campaign, truth = scene
    truth.annotations.update(height=1.7)
    plant_everywhere(campaign, truth, kinds=[FaultKind.REMOVED])
    assignment = take(campaign)
    assignment.layer.annotations.update(state="validated")
    withdraw(assignment)
    assert assignment.layer.annotations.count() == 80
    assert set(assignment.layer.annotations.values_list("height", flat=True)) == {1.7}


def test_frames_shared_with_accepted_work_start_with_it(scene: tuple[Campaign, Layer]) -> None:
    campaign, _truth = scene
    planting.settle(campaign, None, 1.0, 1, [FaultKind.SHIFTED])
    first = hand_in(take(campaign), truth_of_square())
    Assignment.objects.filter(pk=first.pk).update(state="accepted")
    second = campaign.batches.get(number=2)
    second.frames.add(first.batch.frames.order_by("number").last())
    assignment = take(campaign, "bob")
    assert set(places(assignment.layer)) == {45}
    assert PlantedFault.objects.filter(assignment=assignment).count() == 1


def test_frames_shared_with_work_that_a_reviewer_put_right_start_as_he_left_them(
    scene: tuple[Campaign, Layer],
) -> None:
    campaign, _truth = scene
    planting.settle(campaign, None, 0.0, 1, [FaultKind.SHIFTED])
    first, rita = hand_in(take(campaign), truth_of_square()), make_reviewer()
    shared = first.batch.frames.order_by("number").last()
    mended = mending.mend(first, rita).layer
    save(mended, shared, [row(1, 9)], 1, author=rita, done=True)
    transition(first, Action.ACCEPT_MENDED, rita)
    campaign.batches.get(number=2).frames.add(shared)
    assert take(campaign, "bob").layer.annotations.get(frame=shared).position == 9


def test_batches_of_no_campaign_cost_no_query_more(scene: tuple[Campaign, Layer]) -> None:
    campaign, _truth = scene
    campaign.batches.update(campaign=None)
    with CaptureQueriesContext(
        connection,
    ) as queries:
        assignments.claim(make_worker("alice"), campaign.dataset)
    assert not [query for query in queries if "planting" in query["sql"]]


@pytest.mark.parametrize(
    ("share", "faults", "kinds", "words"),
    [
        (1.5, 2, ["shifted"], "between 0 and 1"),
        (0.5, 0, ["shifted"], "1 to 20"),
        (0.5, 2, ["turned"], "no fault of the kind turned"),
        (0.5, 2, [], "Choose the kinds"),
    ],
)
def test_impossible_settings_are_refused_and_change_nothing(
    scene: tuple[Campaign, Layer], share: float, faults: int, kinds: list[str], words: str
) -> None:
    campaign, truth = scene
    with pytest.raises(GoldError, match=words):
        planting.settle(campaign, truth, share, faults, kinds)
    assert not hasattr(campaign, "planting")


def test_a_layer_of_another_dataset_is_no_start(scene: tuple[Campaign, Layer]) -> None:
    from tests.work_scene import make_dataset

    other = make_layer(make_dataset("other"), "theirs")
    with pytest.raises(GoldError, match="another dataset"):
        planting.settle(scene[0], other, 0.5)
