"""How a campaign goes, and what it will cost."""

from __future__ import annotations

from datetime import timedelta
from decimal import Decimal

import pytest
from django.utils import timezone

from gtm_hit.models import Assignment, Campaign, Transition, Worker
from gtm_hit.ops.campaigns import overview
from gtm_hit.ops.campaigns.course import course
from gtm_hit.ops.campaigns.estimate import estimate
from gtm_hit.ops.datasets.demo import Demo, open_campaign
from gtm_hit.ops.pay import table
from gtm_hit.ops.work.assignments import claim
from gtm_hit.ops.work.pools import Pool
from tests.campaign_scene import make_campaign, make_draft
from tests.work_scene import finish, make_dataset, make_worker

pytestmark = pytest.mark.django_db


@pytest.fixture
def campaign() -> Campaign:
    """Four batches of ten frames, opened yesterday."""
    campaign = make_campaign(make_dataset(frames=40), overlap=0, pay_per_batch=Decimal("2.50"))
    Campaign.objects.update(opened_at=timezone.now() - timedelta(days=1))
    campaign.refresh_from_db()
    return campaign


def take(campaign: Campaign, name: str) -> Assignment:
    return claim(make_worker(name), Pool(campaign.dataset, campaign))


def test_frames_go_from_work_to_submitted(campaign: Campaign) -> None:
    finish(take(campaign, "alice"))
    take(campaign, "bob")
    going = course(campaign)
    last = going.moments[-1]
    assert (going.frames, last.submitted, last.in_work, last.accepted) == (40, 10, 10, 0)
    assert going.batches == {"free": 2, "submitted": 1, "leased": 1}
    Assignment.objects.filter(state="submitted").update(state="accepted")
    assert course(campaign).moments[-1].accepted == 10


@pytest.mark.parametrize("state", ["rejected", "expired"])
def test_what_goes_back_to_the_others_is_free_again(campaign: Campaign, state: str) -> None:
    finish(take(campaign, "alice"))
    Assignment.objects.update(state=state)
    going = course(campaign)
    assert (going.frames_done, going.batches["free"]) == (0, 4)


def test_a_lease_that_ran_out_is_not_in_work(campaign: Campaign) -> None:
    take(campaign, "alice")
    Assignment.objects.update(expires_at=timezone.now() - timedelta(minutes=1))
    assert course(campaign).moments[-1].in_work == 0
    assert overview.working_now(campaign) == []


def test_a_quarter_in_a_day_leaves_three_days(campaign: Campaign) -> None:
    assert course(campaign).done_at is None
    finish(take(campaign, "alice"))
    done = course(campaign).done_at
    assert done is not None
    assert abs(done - timezone.now() - timedelta(days=3)) < timedelta(hours=1)


def test_a_draft_has_no_course_and_an_estimate(campaign: Campaign) -> None:
    draft = make_draft(campaign.dataset, "draft", copies=3, pay_per_batch=Decimal("1.10"), expected_minutes=6)
    assert course(draft).moments == [] and course(draft).frames == 0
    found = estimate(draft)
    # 40 frames by 10 with 1 shared: 5 batches.
    assert (found.to_hand_out, found.cost, found.per_hour) == (15, Decimal("16.50"), Decimal("11.00"))


def test_what_was_submitted_and_not_rejected_costs(campaign: Campaign) -> None:
    finish(take(campaign, "alice"))
    finish(take(campaign, "bob"))
    assert overview.money(campaign).so_far == Decimal("5.00")
    Assignment.objects.filter(worker__external_id="bob").update(state="rejected")
    assert overview.money(campaign).so_far == Decimal("2.50")


def test_approved_bonuses_cost_and_proposed_ones_wait(campaign: Campaign) -> None:
    """Two batches in an hour each, at 2.50; the floor is 4.00 an hour."""
    Campaign.objects.update(hourly_floor=Decimal("4.00"))
    campaign.refresh_from_db()
    for name in ("alice", "bob"):
        finish(take(campaign, name)).layer.layer_frames.update(seconds=360)
    Assignment.objects.update(state="accepted")
    assert overview.money(campaign) == overview.Money(Decimal("5.00"), 2, Decimal("3.00"))
    table.approve_bonuses(campaign, None, [Worker.objects.get(external_id="bob").pseudonym])
    assert overview.money(campaign) == overview.Money(Decimal("6.50"), 1, Decimal("1.50"))


def test_frames_count_as_accepted_from_the_moment_of_that_decision(campaign: Campaign) -> None:
    """Submitted after two hours of the day, accepted in its last one."""
    work = finish(take(campaign, "alice"))
    opened = campaign.opened_at
    assert opened is not None
    times = {"leased_at": opened, "submitted_at": opened + timedelta(hours=2)}
    Assignment.objects.update(state="accepted", **times)
    step = Transition(assignment=work, number=9, action="accept", from_state="submitted", to_state="accepted")
    step.save()
    Transition.objects.filter(pk=step.pk).update(at=opened + timedelta(hours=23))
    going = course(campaign).moments
    noon = min(going, key=lambda one: abs(one.at - opened - timedelta(hours=12)))
    assert (noon.submitted, noon.accepted) == (10, 0)
    assert (going[-1].submitted, going[-1].accepted) == (0, 10)


def test_without_a_step_written_down_acceptance_counts_from_the_submission(campaign: Campaign) -> None:
    finish(take(campaign, "alice"))
    opened = campaign.opened_at
    assert opened is not None
    Assignment.objects.update(state="accepted", submitted_at=opened + timedelta(hours=2))
    going = course(campaign).moments
    noon = min(going, key=lambda one: abs(one.at - opened - timedelta(hours=12)))
    assert noon.accepted == 10


def test_the_demo_scenes_campaign_is_opened_once() -> None:
    demo = Demo(make_dataset("demo"), 0)
    first = open_campaign(demo)
    assert (first.state, first.platform, open_campaign(demo)) == ("open", "own_team", first)
