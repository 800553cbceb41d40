"""A campaign's rules hold where batches are handed out."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest
from django.utils import timezone

from gtm_hit.models import Assignment, Campaign, Worker
from gtm_hit.ops.campaigns import editing, entry_rules, standing, states
from gtm_hit.ops.work import batches
from gtm_hit.ops.work.assignments import NoFreeBatch, claim, submit, work_left
from gtm_hit.ops.work.pools import Pool
from tests.campaign_scene import make_campaign
from tests.work_scene import do_frames, finish, make_dataset, make_worker, row, save

pytestmark = pytest.mark.django_db


def pool(campaign: Campaign, submission: str = "") -> Pool:
    return Pool(campaign.dataset, campaign, submission)


def refused(campaign: Campaign, worker: Worker) -> str:
    with pytest.raises(entry_rules.NotAdmitted) as error:
        claim(worker, pool(campaign))
    assert not work_left(worker, pool(campaign))
    return error.value.refusal.reason


@pytest.fixture
def alice() -> Worker:
    return make_worker("alice")


def test_a_campaigns_batch_is_no_batch_of_the_dataset(alice: Worker) -> None:
    campaign = make_campaign()
    with pytest.raises(NoFreeBatch):
        claim(alice, campaign.dataset)
    batches.make_batches(campaign.dataset)
    assert claim(alice, campaign.dataset).batch.campaign is None
    assert claim(alice, pool(campaign)).batch.campaign == campaign


def test_nobody_gets_two_copies_of_one_batch(alice: Worker) -> None:
    campaign = make_campaign(make_dataset(frames=10), copies=3)
    finish(claim(alice, pool(campaign)))
    with pytest.raises(NoFreeBatch):
        claim(alice, pool(campaign))
    assert claim(make_worker("bob"), pool(campaign)).batch.copy == 2


def test_a_worker_gets_as_many_batches_as_the_rule_says(alice: Worker) -> None:
    campaign = make_campaign(batches_per_worker=1)
    finish(claim(alice, pool(campaign)))
    assert refused(campaign, alice) == "limit"
    editing.edit(campaign, {"batches_per_worker": 2})
    assert claim(alice, pool(Campaign.objects.get()))


def test_an_expired_batch_does_not_count(alice: Worker) -> None:
    campaign = make_campaign(batches_per_worker=1)
    claim(alice, pool(campaign))
    Assignment.objects.update(expires_at=timezone.now() - timedelta(seconds=1))
    assert claim(alice, pool(campaign))


def test_one_at_once_stays_one_however_often_another_is_asked_for(alice: Worker) -> None:
    campaign = make_campaign()
    first = claim(alice, pool(campaign))
    assert claim(alice, pool(campaign), another=True) == first


def test_two_at_once_are_two_and_not_three(alice: Worker) -> None:
    campaign = make_campaign(make_dataset(frames=60), batches_at_once=2)
    first = claim(alice, pool(campaign))
    assert claim(alice, pool(campaign)) == first
    second = claim(alice, pool(campaign), another=True)
    assert second != first
    assert claim(alice, pool(campaign), another=True) in {first, second}
    assert Assignment.objects.count() == 2


@pytest.mark.parametrize(("step", "leases"), [("pause", 0), ("close", 0)])
def test_a_campaign_that_is_not_open_gives_no_batch(alice: Worker, step: str, leases: int) -> None:
    campaign = states.take(make_campaign(), step)
    assert refused(campaign, alice) == "not_open"
    assert Assignment.objects.count() == leases


@pytest.mark.parametrize("step", ["pause", "close"])
def test_who_holds_a_batch_may_finish_it(alice: Worker, step: str) -> None:
    campaign = make_campaign()
    held = claim(alice, pool(campaign))
    campaign = states.take(campaign, step)
    assert claim(alice, pool(campaign)) == held
    do_frames(held)
    assert submit(held).state == "submitted"


def test_a_blocked_worker_gets_no_further_batch_and_finishes_his_own(alice: Worker) -> None:
    campaign = make_campaign()
    held = claim(alice, pool(campaign))
    standing.block(campaign, alice, "clicks anywhere")
    assert claim(alice, pool(campaign)) == held
    finish(held)
    assert refused(campaign, alice) == "blocked"
    standing.forget(campaign, alice)
    assert claim(alice, pool(campaign))


def test_only_invited_workers_come_in_where_the_rule_says_so(alice: Worker) -> None:
    campaign = make_campaign(entry="invited")
    assert refused(campaign, alice) == "not_invited"
    standing.invite(campaign, "alice")
    assert claim(alice, pool(campaign))


def test_who_lacks_a_qualification_is_told_which(alice: Worker, monkeypatch: Any) -> None:
    campaign = make_campaign(entry="qualified")
    monkeypatch.setattr(entry_rules, "missing_qualifications", lambda campaign, worker: ["plaza"])
    with pytest.raises(entry_rules.NotAdmitted, match="plaza"):
        claim(alice, pool(campaign))
    standing.invite(campaign, "alice")
    assert claim(alice, pool(campaign))


def test_a_lease_is_as_long_as_the_campaign_says(alice: Worker) -> None:
    campaign = make_campaign(lease_minutes=600)
    held = claim(alice, pool(campaign))
    save(held.layer, held.batch.frames.first(), [row()], author=alice)
    held.refresh_from_db()
    assert timedelta(minutes=599) < held.expires_at - timezone.now() <= timedelta(minutes=600)


def test_one_submission_is_one_batch(alice: Worker) -> None:
    campaign = make_campaign(platform="prolific")
    first = claim(alice, pool(campaign, "s1"))
    assert first.submission == "s1"
    assert claim(alice, pool(campaign, "s1"), another=True) == first
    finish(first)
    with pytest.raises(NoFreeBatch):
        claim(alice, pool(campaign, "s1"))
    assert claim(alice, pool(campaign, "s2")).batch != first.batch


def test_a_block_says_why(alice: Worker) -> None:
    campaign = make_campaign()
    with pytest.raises(standing.CampaignError):
        standing.block(campaign, alice, "  ")
    assert not campaign.workers.exists()
