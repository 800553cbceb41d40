"""Scores out of what workers really saved."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest
from celery import current_app
from django.utils import timezone

from annotator.celery import app
from gtm_hit import tasks
from gtm_hit.models import Assignment, AssignmentScore, Campaign, Layer, WorkerScore
from gtm_hit.ops.gold import frames, planting
from gtm_hit.ops.scores import computing, words
from gtm_hit.ops.scores.measuring import measure
from gtm_hit.ops.scores.suspicion import by_suspicion, suspicion
from gtm_hit.ops.work import assignments
from tests.gold_scene import confirm, hand_in, make_scene, plant_everywhere, save, take, truth_of_square
from tests.scoring.people import moved

pytestmark = pytest.mark.django_db


@pytest.fixture
def scene() -> tuple[Campaign, Layer]:
    campaign, truth = make_scene(copies=2)
    frames.choose(campaign, truth, 0.4)
    plant_everywhere(campaign, truth)
    return campaign, truth


def careless(campaign: Campaign, name: str = "bob") -> Assignment:
    """He confirms what is there, in a second."""
    assignment = take(campaign, name)
    confirm(assignment)
    return assignments.submit(assignment)


def test_careful_work_is_counted_as_it_is(scene: tuple[Campaign, Layer]) -> None:
    done = hand_in(take(scene[0]), truth_of_square())
    found = measure(done)
    gold = found.gold_frames
    assert gold > 0
    assert found.truth == found.matched == found.placed == found.same == 8 * gold
    assert (found.faults, found.repaired, found.people, found.seconds) == (3, 3, 80, 600)
    assert found.edits >= 3
    assert found.warnings == 0


def test_confirming_is_no_edit_and_touches_nobody(scene: tuple[Campaign, Layer]) -> None:
    found = measure(careless(scene[0]))
    assert found.edits == 0
    assert found.carried == found.untouched > 70
    assert (found.faults, found.repaired) == (3, 0)


def test_what_was_taken_out_is_not_counted_as_the_workers_own_edit(scene: tuple[Campaign, Layer]) -> None:
    done = careless(scene[0])
    assert measure(done).edits == 0
    assert measure(done).matched == measure(done).truth


def test_copies_are_compared_and_a_rejected_one_is_not(scene: tuple[Campaign, Layer]) -> None:
    campaign = scene[0]
    planting.stop(campaign)
    first = hand_in(take(campaign), truth_of_square())
    campaign.batches.filter(number=2).delete()
    off = {n: {p: moved(at, 0.0, 0.6) for p, at in people.items()} for n, people in truth_of_square().items()}
    second = hand_in(take(campaign, "bob"), off)
    assert measure(first).shared == 160
    assert measure(first).agreed < 50
    Assignment.objects.filter(pk=second.pk).update(state="rejected")
    assert measure(first).shared == 0


def test_a_submission_scores_the_work_its_worker_and_the_copies(scene: tuple[Campaign, Layer]) -> None:
    campaign = scene[0]
    campaign.batches.filter(number=2).delete()
    first, second = hand_in(take(campaign), truth_of_square()), careless(campaign)
    computing.score_assignment(second.pk)
    assert set(AssignmentScore.objects.values_list("assignment", flat=True)) == {first.pk, second.pk}
    scores = {one.worker_id: one for one in WorkerScore.objects.all()}
    assert scores[first.worker_id].score > scores[second.worker_id].score + 15
    assert scores[second.worker_id].assignments == 1


def test_work_that_is_not_submitted_is_not_scored(scene: tuple[Campaign, Layer]) -> None:
    computing.score_assignment(take(scene[0]).pk)
    assert not AssignmentScore.objects.exists()


def test_computing_again_comes_out_the_same(scene: tuple[Campaign, Layer]) -> None:
    campaign = scene[0]
    hand_in(take(campaign), truth_of_square())
    careless(campaign)
    fields = "worker", "score", "low", "high", "assignments", "reasons"
    assert computing.recompute_all() == 2
    first = list(WorkerScore.objects.values_list(*fields))
    assert computing.recompute(campaign) == 2
    assert list(WorkerScore.objects.values_list(*fields)) == first
    assert AssignmentScore.objects.count() == 2


def test_a_score_whose_work_was_taken_back_goes(scene: tuple[Campaign, Layer]) -> None:
    campaign = scene[0]
    done = hand_in(take(campaign), truth_of_square())
    computing.recompute(campaign)
    Assignment.objects.filter(pk=done.pk).update(state="leased", submitted_at=None)
    computing.recompute(campaign)
    assert not AssignmentScore.objects.exists()
    assert not WorkerScore.objects.exists()


def test_whoever_went_away_in_the_middle_is_known_by_it(scene: tuple[Campaign, Layer]) -> None:
    campaign = scene[0]
    hand_in(take(campaign), truth_of_square())
    gone = take(campaign, "carl")
    save(gone, gone.batch.frames.first(), truth_of_square()[0])
    Assignment.objects.filter(pk=gone.pk).update(expires_at=timezone.now() - timedelta(minutes=1))
    assignments.expire_leases()
    computing.recompute(campaign)
    row = computing.of_worker(campaign, gone.worker)
    assert row is not None
    assert row.assignments == 0
    assert "1 of 1 batches ran out unfinished." in words.of_score(row)


def test_the_most_suspicious_comes_first_with_reasons_in_words(scene: tuple[Campaign, Layer]) -> None:
    campaign = scene[0]
    good = [hand_in(take(campaign, name), truth_of_square()) for name in ("alice", "carla", "dora")]
    bad = careless(campaign)
    assert suspicion(bad).value > 0.8
    computing.recompute(campaign)
    assert by_suspicion(campaign)[0] == bad
    assert suspicion(bad).value > 0.8 > 0.2 > suspicion(good[0]).value
    told = words.of_suspicion(bad.score)
    assert "3 of 3 planted faults were left." in told
    assert any("s per person" in line for line in told)


def test_the_score_says_what_cost_most(scene: tuple[Campaign, Layer]) -> None:
    campaign = scene[0]
    hand_in(take(campaign), truth_of_square())
    bad = careless(campaign)
    computing.recompute(campaign)
    row = computing.of_worker(campaign, bad.worker)
    assert row is not None
    assert words.of_score(row)[0] == "0 of 3 planted faults repaired."


def test_every_submission_of_a_campaign_asks_for_its_score_once_it_is_committed(
    scene: tuple[Campaign, Layer], monkeypatch: pytest.MonkeyPatch, django_capture_on_commit_callbacks: Any
) -> None:
    sent: list[Any] = []
    monkeypatch.setattr(current_app, "send_task", lambda name, args, **_: sent.append((name, args)))
    with django_capture_on_commit_callbacks(execute=True):
        done = hand_in(take(scene[0]), truth_of_square())
    assert sent == [(tasks.score_assignment.name, [done.pk])]


def test_without_a_broker_work_is_submitted_all_the_same(
    scene: tuple[Campaign, Layer], monkeypatch: pytest.MonkeyPatch, django_capture_on_commit_callbacks: Any
) -> None:
    def away(*_args: Any, **_values: Any) -> None:
        raise OSError("no broker")

    monkeypatch.setattr(current_app, "send_task", away)
    with django_capture_on_commit_callbacks(execute=True):
        assert hand_in(take(scene[0]), truth_of_square()).state == "submitted"


def test_the_clock_computes_all_scores_every_night() -> None:
    assert app.conf.beat_schedule["recompute-scores"]["task"] == tasks.recompute_scores.name
