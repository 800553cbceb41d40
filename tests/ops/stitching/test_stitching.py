"""Accepted batches become one layer; running again changes only what changed; decisions are remembered."""

from __future__ import annotations

import uuid

import pytest
from django.contrib.auth.models import User

from gtm_hit.models import (
    Annotation,
    Assignment,
    Campaign,
    Dataset,
    Job,
    Layer,
    LayerFrame,
    Save,
    StitchConflict,
    StitchedFrame,
    Stitching,
    StitchingRun,
)
from gtm_hit.ops.frames import saving
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import no_progress
from gtm_hit.ops.stitching import conflicts
from gtm_hit.ops.stitching.running import Asked, start, stitch_layer
from gtm_hit.ops.stitching.scope import Scope, StitchingError
from gtm_hit.tasks import OPERATIONS
from tests.stitch_scene import TWO, accept, doubtful, frame_at, position, two_batches
from tests.work_scene import as_sent, make_dataset

pytestmark = pytest.mark.django_db


def stitched(dataset: Dataset, campaign: Campaign | None = None) -> StitchingRun:
    return stitch_layer(Scope(dataset, campaign), Asked(), None, no_progress)


def rows_of(layer: Layer) -> list[tuple[int, int, int]]:
    found = Annotation.objects.filter(layer=layer).order_by("frame__number", "person")
    return list(found.values_list("frame__number", "person", "position"))


def revisions(layer: Layer) -> dict[int, int]:
    return dict(LayerFrame.objects.filter(layer=layer).values_list("frame__number", "revision"))


def test_two_batches_become_one_layer_with_one_number_per_person() -> None:
    dataset, _ = two_batches()
    layer = stitched(dataset).stitching.layer
    assert (layer.kind, layer.name) == (Layer.Kind.GROUND_TRUTH, "ground-truth")
    for person, walk in enumerate(TWO.values(), start=1):
        mine = Annotation.objects.filter(layer=layer, person=person).order_by("frame__number")
        assert list(mine.values_list("position", flat=True)) == [position(walk, index) for index in range(20)]
    assert LayerFrame.objects.filter(layer=layer, done=True).count() == 20


def test_running_again_touches_nothing() -> None:
    dataset, _ = two_batches()
    layer = stitched(dataset).stitching.layer
    rows, saves = list(Annotation.objects.filter(layer=layer).order_by("pk").values()), Save.objects.count()
    again = stitched(dataset)
    assert (again.numbers["frames_changed"], again.numbers["frames_same"]) == (0, 20)
    assert list(Annotation.objects.filter(layer=layer).order_by("pk").values()) == rows
    assert Save.objects.count() == saves
    assert set(revisions(layer).values()) == {1}


def test_a_batch_accepted_later_changes_only_its_own_frames() -> None:
    dataset, _ = two_batches(make_dataset(frames=30))
    layer = stitched(dataset).stitching.layer
    accept(dataset, 3, range(19, 30), TWO, shift=2)
    stitched(dataset)
    changed = {number for number, revision in revisions(layer).items() if revision > 1}
    assert changed == {frame_at(dataset, 19).number}  # both have it: its places are in the middle now
    assert Annotation.objects.filter(layer=layer, person=1).count() == 30


def test_a_batch_no_longer_accepted_takes_its_frames_out() -> None:
    dataset, (_, second) = two_batches()
    layer = stitched(dataset).stitching.layer
    Assignment.objects.filter(pk=second.pk).update(state=Assignment.State.REJECTED)
    assert stitched(dataset).numbers["frames_emptied"] == 10
    assert {number for number, _, _ in rows_of(layer)} == {
        frame_at(dataset, index).number for index in range(10)
    }
    assert not LayerFrame.objects.filter(layer=layer, frame=frame_at(dataset, 15), done=True).exists()


def test_numbers_of_people_stay_when_somebody_new_comes_before_them() -> None:
    dataset = make_dataset(frames=30)
    accept(dataset, 2, range(10, 20), TWO)
    layer = stitched(dataset).stitching.layer
    before = rows_of(layer)
    accept(dataset, 1, range(0, 5), {5: (20, 20, 0, 0)})
    stitched(dataset)
    assert set(before) < set(rows_of(layer))
    assert {person for _, person, _ in rows_of(layer)} == {1, 2, 3}


def test_what_people_changed_by_hand_stays_and_is_told() -> None:
    dataset, _ = two_batches()
    layer = stitched(dataset).stitching.layer
    frame = frame_at(dataset, 3)
    state = saving.read_frame(layer, frame)
    kept = as_sent(state.annotations[:1])
    saving.save_frame(layer, frame, None, uuid.uuid4(), state.revision, kept, done=True)
    again = stitched(dataset)
    assert again.numbers["frames_by_hand"] == [frame.number]
    assert len(saving.read_frame(layer, frame).annotations) == 1


def test_every_annotation_knows_what_it_was_made_of() -> None:
    dataset, (first, second) = two_batches()
    layer = stitched(dataset).stitching.layer
    shared = StitchedFrame.objects.get(layer=layer, frame=frame_at(dataset, 9))
    assert shared.sources == [
        [1, first.layer_id, 1, second.layer_id, 2],
        [2, first.layer_id, 2, second.layer_id, 1],
    ]
    own = StitchedFrame.objects.get(layer=layer, frame=frame_at(dataset, 12))
    assert own.sources == [[1, second.layer_id, 2], [2, second.layer_id, 1]]


def test_replicas_are_fused_and_the_one_who_is_off_is_told() -> None:
    dataset = make_dataset()
    for copy, shift in ((1, 0), (2, 0), (3, 4)):
        accept(dataset, 1, range(0, 10), TWO, copy=copy, shift=shift)
    run = stitched(dataset)
    assert run.numbers["people"] == 2
    assert len(run.numbers["workers"]) == 3
    far = run.numbers["workers"][0]
    off = Assignment.objects.get(batch__copy=3).worker.pseudonym
    assert far["worker"] == off and far["distance"] > 0.06


def test_only_accepted_batches_of_the_campaign_go_into_its_layer() -> None:
    dataset, _ = two_batches()
    campaign = Campaign.objects.create(dataset=dataset, name="autumn")
    accept(dataset, 1, range(0, 5), TWO, campaign=campaign)
    layer = stitched(dataset, campaign).stitching.layer
    assert layer.name == "ground-truth-autumn"
    assert LayerFrame.objects.filter(layer=layer).count() == 5


def test_nothing_accepted_is_refused_and_makes_no_layer() -> None:
    dataset = make_dataset()
    with pytest.raises(StitchingError, match="No batch has been accepted"):
        stitched(dataset)
    assert not Layer.objects.filter(kind=Layer.Kind.GROUND_TRUTH).exists()


def test_a_layer_of_that_name_that_somebody_else_made_is_left_alone() -> None:
    dataset, _ = two_batches()
    Layer.objects.create(dataset=dataset, name="ground-truth", kind=Layer.Kind.IMPORTED)
    with pytest.raises(StitchingError, match="did not make it"):
        stitched(dataset)


def test_what_is_doubtful_is_asked_and_a_decision_outlasts_the_next_run() -> None:
    dataset = doubtful()
    run = stitched(dataset)
    layer = run.stitching.layer
    assert len({person for _, person, _ in rows_of(layer)}) == 3
    asked = StitchConflict.objects.get(stitching=run.stitching)
    user = User.objects.create_user("ada", is_superuser=True)
    conflicts.decide(asked, StitchConflict.Decision.SAME, user)
    for _ in range(2):
        stitched(dataset)
        assert len({person for _, person, _ in rows_of(layer)}) == 2
    kept = StitchConflict.objects.get(stitching=run.stitching)
    assert (kept.decision, kept.decided_by) == ("same", user) and kept.decided_at


def test_an_undone_decision_is_asked_again_and_its_join_taken_back() -> None:
    dataset = doubtful()
    run = stitched(dataset)
    asked = StitchConflict.objects.get(stitching=run.stitching)
    conflicts.decide(asked, StitchConflict.Decision.SAME, None)
    stitched(dataset)
    conflicts.undo(asked)
    stitched(dataset)
    assert StitchConflict.objects.get(stitching=run.stitching).state == StitchConflict.State.OPEN
    assert len({person for _, person, _ in rows_of(run.stitching.layer)}) == 3


def test_deciding_otherwise_than_somebody_else_did_is_refused() -> None:
    asked = StitchConflict.objects.get(stitching=stitched(doubtful()).stitching)
    conflicts.decide(asked, StitchConflict.Decision.SAME, User.objects.create_user("ada"))
    with pytest.raises(StitchingError, match="ada has decided: the same person"):
        conflicts.decide(asked, StitchConflict.Decision.APART, None)
    asked.refresh_from_db()
    assert asked.decision == StitchConflict.Decision.SAME


def test_a_decision_holds_when_another_copy_of_the_batch_is_accepted() -> None:
    dataset = doubtful()
    run = stitched(dataset)
    asked = StitchConflict.objects.get(stitching=run.stitching)
    conflicts.decide(asked, StitchConflict.Decision.SAME, None)
    accept(dataset, 1, range(0, 10), {0: (100, 40, 0, 0)}, copy=2)
    stitched(dataset)
    assert len({person for _, person, _ in rows_of(run.stitching.layer)}) == 2


def test_the_job_does_it_once_for_two_presses_and_safely_twice() -> None:
    dataset, _ = two_batches()
    job = start(Scope(dataset), Asked())
    assert start(Scope(dataset), Asked()) == job
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    assert job.state == Job.State.DONE and job.result["people"] == 2
    Job.objects.filter(pk=job.pk).update(state=Job.State.QUEUED)  # its worker was killed at the very end
    queue.run(job.pk, OPERATIONS)
    assert StitchingRun.objects.count() == 1
    assert set(revisions(Stitching.objects.get().layer).values()) == {1}
