"""What is planned to be told to the platform, and that it is planned once."""

from __future__ import annotations

import pytest
from django.contrib.auth.models import User

from gtm_hit.models import Assignment, Campaign, MoneyEntry, OutboxRow, Worker
from gtm_hit.ops.outbox import planning, rows
from gtm_hit.ops.outbox.platform import Refused
from gtm_hit.ops.pay import ledger, table
from tests.ops.outbox.conftest import REASON, decide, states
from tests.paid_campaign import assign, become, make_campaign
from tests.work_scene import make_dataset, make_worker

State = Assignment.State


def test_an_acceptance_plans_an_approval_that_pays_the_batch(work: Assignment, manager: User) -> None:
    row = decide(work, "accepted", by=manager)
    assert row is not None
    assert (row.kind, row.submission, row.amount, row.planned_by) == ("approve", "s1", 2, manager)


def test_the_same_decision_again_plans_nothing(work: Assignment, campaign: Campaign) -> None:
    assert decide(work, "accepted") == decide(work, "accepted")
    assert states(campaign) == [("approve", "planned")]


def test_a_rejection_carries_reason_and_category(work: Assignment) -> None:
    row = decide(work, "rejected", message=REASON, category="low_effort")
    assert row is not None
    assert (row.kind, row.amount, row.payload) == ("reject", 0, {"message": REASON, "category": "LOW_EFFORT"})


@pytest.mark.parametrize(("message", "category"), [("too short", "low_effort"), (REASON, "because")])
def test_a_reason_the_platform_would_not_take_is_refused_at_once(
    work: Assignment, campaign: Campaign, message: str, category: str
) -> None:
    with pytest.raises(Refused):
        decide(work, "rejected", message=message, category=category)
    assert states(campaign) == []


def test_work_that_goes_back_for_mending_is_not_told(work: Assignment, campaign: Campaign) -> None:
    assert decide(work, "returned") is None
    assert states(campaign) == []


def test_a_decision_changed_before_it_was_told_replaces_the_one_planned(
    work: Assignment, campaign: Campaign
) -> None:
    decide(work, "accepted")
    decide(work, "returned")
    decide(work, "rejected", message=REASON, category="LOW_EFFORT")
    assert states(campaign) == [("approve", "withdrawn"), ("reject", "planned")]


def test_an_appeal_won_after_the_rejection_was_told_is_paid_as_a_bonus(
    work: Assignment, campaign: Campaign
) -> None:
    row = decide(work, "rejected", message=REASON, category="LOW_EFFORT")
    assert row is not None
    rows.confirm(row.pk, {})
    assert decide(work, "accepted") is None
    (paying,) = planning.plan_payouts(campaign, None)
    assert (paying.kind, paying.amount) == ("bonus_pay", 2)


def test_a_submission_of_two_batches_is_approved_once_and_the_second_paid_as_a_bonus(
    work: Assignment, campaign: Campaign, ada: Worker
) -> None:
    second = assign(campaign, ada, State.SUBMITTED, submission="s1")
    decide(work, "accepted")
    decide(second, "accepted")
    (paying,) = planning.plan_payouts(campaign, None)
    assert states(campaign) == [("approve", "planned"), ("bonus_setup", "planned"), ("bonus_pay", "planned")]
    assert (paying.submission, paying.amount) == ("s1", 2)


def test_a_submission_is_rejected_only_when_none_of_its_batches_is_open_or_accepted(
    work: Assignment, campaign: Campaign, ada: Worker
) -> None:
    second = assign(campaign, ada, State.SUBMITTED, submission="s1")
    assert decide(work, "rejected", message=REASON, category="LOW_EFFORT") is None
    row = decide(second, "rejected", message=REASON, category="LOW_EFFORT")
    assert row is not None and row.kind == "reject"


@pytest.mark.parametrize("platform", ["own_team", "link", "external_question"])
def test_platforms_that_decide_nothing_are_told_nothing(db: None, platform: str) -> None:
    campaign = make_campaign(make_dataset("other", 60), platform=platform)
    work = assign(campaign, make_worker("bob"), State.SUBMITTED, submission="x1")
    assert decide(work, "accepted") is None
    assert states(campaign) == []
    assert MoneyEntry.objects.get().amount == 2  # owed all the same


def test_a_batch_of_no_campaign_is_told_nobody(work: Assignment) -> None:
    work.batch.campaign = None
    assert planning.plan_decision(work, "accepted") is None


def test_an_unknown_outcome_is_refused(work: Assignment) -> None:
    with pytest.raises(planning.PlanError):
        planning.plan_decision(work, "praised")


def test_what_was_accepted_without_a_word_is_approved_with_the_payout_and_not_paid_beside(
    work: Assignment, campaign: Campaign
) -> None:
    become(work, State.ACCEPTED)
    table.approve_bonuses(campaign, None)
    (paying,) = planning.plan_payouts(campaign, None)
    assert states(campaign)[0] == ("approve", "planned")
    assert paying.amount == 2  # the bonus alone; the batch goes with the approval


def test_a_dry_run_lists_what_would_be_planned_and_plans_nothing(
    work: Assignment, campaign: Campaign
) -> None:
    become(work, State.ACCEPTED)
    table.approve_bonuses(campaign, None)
    found = [(row.kind, row.amount) for row in planning.preview(campaign)]
    assert found == [("approve", 2), ("bonus_pay", 2)]
    assert states(campaign) == []


def test_a_payout_planned_twice_pays_nothing_twice(work: Assignment, campaign: Campaign) -> None:
    become(work, State.ACCEPTED)
    table.approve_bonuses(campaign, None)
    assert len(planning.plan_payouts(campaign, None)) == 1
    assert planning.plan_payouts(campaign, None) == []


def test_money_on_its_way_cannot_be_paid_by_hand(work: Assignment, campaign: Campaign, ada: Worker) -> None:
    decide(work, "accepted")
    with pytest.raises(ledger.PayError, match="nothing to pay"):
        ledger.mark_paid(campaign, ada, None)


def test_a_worker_without_a_submission_is_paid_under_his_own_id(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada)
    (paying,) = planning.plan_payouts(campaign, None)
    assert (paying.submission, paying.payload["is_submission"]) == ("ada", False)


def test_no_payout_is_planned_where_the_platform_pays_nobody(db: None) -> None:
    with pytest.raises(planning.PlanError):
        planning.plan_payouts(make_campaign(make_dataset("other", 60)), None)


def test_a_bonus_is_withdrawn_with_its_preparation_and_owed_again(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada)
    (paying,) = planning.plan_payouts(campaign, None)
    rows.withdraw(paying, None)
    assert states(campaign) == [("bonus_setup", "withdrawn"), ("bonus_pay", "withdrawn")]
    assert table.workers(campaign)[0].balance.to_pay == 2


def test_what_failed_is_not_tried_again_once_it_was_paid_otherwise(
    work: Assignment, campaign: Campaign, ada: Worker
) -> None:
    row = decide(work, "accepted")
    assert row is not None
    rows.fail(row, "no")
    ledger.mark_paid(campaign, ada, None)
    with pytest.raises(rows.RowError):
        rows.retry(row, None)
    assert OutboxRow.objects.get().state == "failed"
