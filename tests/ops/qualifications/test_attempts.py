"""A try: frames with known truth, judged in metres, at most so many times."""

from __future__ import annotations

from datetime import timedelta

import pytest
from django.utils import timezone

from gtm_hit.models import Assignment, Batch, Campaign, Qualification, QualificationGrant, Worker
from gtm_hit.ops import overview
from gtm_hit.ops.qualifications import attempts, grants, judging, managing
from gtm_hit.ops.qualifications.managing import Order, PassMarks, QualificationError
from gtm_hit.ops.qualifications.requirements import missing_qualifications, offered
from gtm_hit.ops.work import assignments, batches
from gtm_hit.ops.work.pools import Pool
from tests.gold_scene import hand_in, make_scene, truth_of_square
from tests.scoring.people import moved
from tests.work_scene import make_dataset, make_layer, make_worker

pytestmark = pytest.mark.django_db


@pytest.fixture
def campaign() -> Campaign:
    return make_scene()[0]


@pytest.fixture
def basics(campaign: Campaign) -> Qualification:
    truth = campaign.dataset.layers.get(name="truth")
    made = managing.create(campaign.dataset, Order("basics", truth, frames_per_try=4, tries=2))
    managing.require(campaign, ["basics"])
    return made


@pytest.fixture
def alice() -> Worker:
    return make_worker("alice")


def fail(basics: Qualification, alice: Worker) -> Assignment:
    return hand_in(attempts.begin(basics, alice), {})


def test_whoever_finds_everybody_passes_and_has_it(
    campaign: Campaign, basics: Qualification, alice: Worker
) -> None:
    assert missing_qualifications(campaign, alice) == ["basics"]
    assignment = hand_in(attempts.begin(basics, alice), truth_of_square())
    assert assignment.attempt.passed
    assert assignment.attempt.result["recall"] == 1
    assert missing_qualifications(campaign, alice) == []


def test_a_campaign_that_asks_for_nothing_lacks_nothing(campaign: Campaign, alice: Worker) -> None:
    assert missing_qualifications(campaign, alice) == []


@pytest.mark.parametrize("metres", [0.0, 0.1, 0.2, 0.45])
def test_distances_beyond_the_marks_fail(basics: Qualification, alice: Worker, metres: float) -> None:
    off = {
        number: {person: moved(place, metres) for person, place in people.items()}
        for number, people in truth_of_square().items()
    }
    attempt = hand_in(attempts.begin(basics, alice), off).attempt
    assert attempt.passed == (metres <= basics.max_median)
    assert attempt.result["median"] == pytest.approx(metres, abs=0.001)


def test_whoever_marks_nobody_fails_and_lacks_it_still(
    campaign: Campaign, basics: Qualification, alice: Worker
) -> None:
    attempt = fail(basics, alice).attempt
    assert attempt.passed is False
    assert attempt.result["median"] is None
    assert missing_qualifications(campaign, alice) == ["basics"]


def test_every_try_has_other_frames(basics: Qualification, alice: Worker) -> None:
    first = list(fail(basics, alice).batch.frames.values_list("number", flat=True))
    second = list(attempts.begin(basics, alice).batch.frames.values_list("number", flat=True))
    assert (first, second) == ([0, 5, 10, 15], [20, 25, 30, 35])


def test_tries_are_limited(basics: Qualification, alice: Worker) -> None:
    fail(basics, alice)
    fail(basics, alice)
    with pytest.raises(attempts.NoMoreTries, match="All 2 tries"):
        attempts.begin(basics, alice)
    assert Batch.with_qualifications.filter(qualification=basics).count() == 2


def test_whoever_has_it_tries_no_more(basics: Qualification, alice: Worker) -> None:
    hand_in(attempts.begin(basics, alice), truth_of_square())
    with pytest.raises(attempts.NoMoreTries, match="have this"):
        attempts.begin(basics, alice)


def test_begin_again_is_the_running_try(basics: Qualification, alice: Worker) -> None:
    assert attempts.begin(basics, alice) == attempts.begin(basics, alice)


def test_a_try_whose_time_ran_out_is_taken_up_again(basics: Qualification, alice: Worker) -> None:
    first = attempts.begin(basics, alice)
    Assignment.objects.filter(pk=first.pk).update(expires_at=timezone.now() - timedelta(minutes=1))
    assert attempts.begin(basics, alice) == first
    assert attempts.begin(basics, alice).editable


def test_a_worker_with_other_work_finishes_that_first(
    campaign: Campaign, basics: Qualification, alice: Worker
) -> None:
    assignments.claim(alice, Pool(campaign.dataset, campaign))
    with pytest.raises(assignments.BusyElsewhere):
        attempts.begin(basics, alice)
    assert not attempts.attempts(basics, alice).exists()


def test_a_try_is_nobodys_ordinary_work(campaign: Campaign, basics: Qualification, alice: Worker) -> None:
    dataset = campaign.dataset
    before = Batch.objects.count()
    assignment = hand_in(attempts.begin(basics, alice), truth_of_square())
    assert Batch.objects.count() == before
    assert not assignments.finished(alice, dataset).exists()
    assert assignments.claim(alice, Pool(dataset, campaign)).batch.number == 1
    assert assignment.batch.number == 0


def test_a_try_that_ran_out_is_not_handed_out_as_work(
    campaign: Campaign, basics: Qualification, alice: Worker
) -> None:
    tried = attempts.begin(basics, alice)
    Assignment.objects.filter(pk=tried.pk).update(expires_at=timezone.now() - timedelta(minutes=1))
    assert assignments.claim(alice, Pool(campaign.dataset, campaign)).batch.campaign == campaign


def test_what_was_granted_can_be_revoked_with_a_reason_and_granted_by_hand(
    campaign: Campaign, basics: Qualification, alice: Worker
) -> None:
    grants.grant(basics, alice, None, "an old hand")
    assert missing_qualifications(campaign, alice) == []
    with pytest.raises(QualificationError, match="Say why"):
        grants.revoke(basics, alice, None, "  ")
    grants.revoke(basics, alice, None, "shared an account")
    assert missing_qualifications(campaign, alice) == ["basics"]
    grants.grant(basics, alice, None)
    assert missing_qualifications(campaign, alice) == []
    assert QualificationGrant.objects.count() == 3
    assert [one.granted for one in grants.standing(basics)] == [True]


def test_nothing_is_revoked_that_nobody_has(basics: Qualification, alice: Worker) -> None:
    with pytest.raises(QualificationError, match="does not have"):
        grants.revoke(basics, alice, None, "why not")


def test_a_closed_one_is_not_offered_and_lets_nobody_begin(basics: Qualification, alice: Worker) -> None:
    managing.close(basics)
    basics.refresh_from_db()
    assert not offered(basics.dataset).exists()
    with pytest.raises(attempts.NoMoreTries, match="closed"):
        attempts.begin(basics, alice)
    managing.reopen(basics)
    basics.refresh_from_db()
    assert attempts.begin(basics, alice)


def test_a_try_that_is_judged_stays_as_it_was_judged(basics: Qualification, alice: Worker) -> None:
    failed = fail(basics, alice)
    managing.change(basics, PassMarks(min_recall=0, min_precision=0, min_idf1=0), 3, "")
    judging.judge(failed)
    failed.attempt.refresh_from_db()
    assert failed.attempt.passed is False


@pytest.mark.parametrize(
    ("order", "words"),
    [
        ({"name": "a b"}, "name"),
        ({"frames_per_try": 30}, "knows only 20 frames"),
        ({"first_frame": 1000}, "knows only 0 frames"),
        ({"tries": 0}, "tries"),
        ({"marks": PassMarks(min_recall=1.2)}, "min_recall"),
        ({"marks": PassMarks(max_p95=3.0)}, "max_p95"),
    ],
)
def test_what_cannot_be_is_refused_and_makes_nothing(
    campaign: Campaign, order: dict[str, object], words: str
) -> None:
    truth = campaign.dataset.layers.get(name="truth")
    with pytest.raises(QualificationError, match=words):
        managing.create(campaign.dataset, Order(**{"name": "basics", "truth": truth, **order}))  # type: ignore[arg-type]
    assert not Qualification.objects.exists()


def test_the_same_name_twice_is_refused(campaign: Campaign, basics: Qualification) -> None:
    with pytest.raises(QualificationError):
        managing.create(campaign.dataset, Order("basics", basics.truth))


def test_a_layer_of_another_dataset_is_no_truth(campaign: Campaign) -> None:
    theirs = make_layer(make_dataset("other"), "theirs")
    with pytest.raises(QualificationError, match="no known truth"):
        managing.create(campaign.dataset, Order("basics", theirs))


def test_asking_for_one_that_is_not_there_is_refused(campaign: Campaign, basics: Qualification) -> None:
    with pytest.raises(QualificationError, match="no qualification other"):
        managing.require(campaign, ["basics", "other"])
    managing.require(campaign, [])
    assert not campaign.required_qualifications.exists()


def test_frames_of_a_try_are_still_in_no_batch(
    campaign: Campaign, basics: Qualification, alice: Worker
) -> None:
    dataset = campaign.dataset
    campaign.batches.all().delete()
    hand_in(attempts.begin(basics, alice), truth_of_square())
    counts = overview.batch_counts(dataset)
    assert (counts.batches, counts.free, counts.submitted, counts.frames_without) == (0, 0, 0, 20)
    assert batches.make_batches(dataset) == 2
    assert not overview.assignments(dataset).exists()
