"""Asking for a submission back."""

from __future__ import annotations

import pytest
from django.contrib.auth.models import User

from gtm_hit.models import Assignment, Campaign, OutboxRow, Worker
from gtm_hit.ops.outbox import return_requests, rows
from gtm_hit.ops.outbox.planning import PlanError
from gtm_hit.ops.outbox.statuses import observe
from tests.ops.outbox.conftest import decide, states
from tests.ops.outbox.test_statuses import told
from tests.paid_campaign import assign

State = Assignment.State


def refused(campaign: Campaign, submission: str = "s1", reason: str = "Hardly anybody is marked") -> str:
    before = states(campaign)
    with pytest.raises(PlanError) as error:
        return_requests.plan(campaign, submission, reason, None)
    assert states(campaign) == before
    return str(error.value)


def test_it_is_planned_once(work: Assignment, campaign: Campaign, manager: User) -> None:
    row = return_requests.plan(campaign, " s1 ", " Hardly anybody is marked ", manager)
    assert (row.kind, row.submission, row.worker, row.amount) == ("request_return", "s1", work.worker, 0)
    assert (row.payload, row.planned_by) == ({"reasons": ["Hardly anybody is marked"]}, manager)
    assert return_requests.plan(campaign, "s1", "again", manager) == row


def test_what_was_withdrawn_can_be_asked_again(work: Assignment, campaign: Campaign) -> None:
    first = return_requests.plan(campaign, "s1", "Why", None)
    rows.withdraw(first, None)
    assert return_requests.plan(campaign, "s1", "Why", None) != first


@pytest.mark.parametrize("reason", ["", "  ", "x" * 1001, "a\x00b"])
def test_a_worker_is_told_why(work: Assignment, campaign: Campaign, reason: str) -> None:
    assert "Say why" in refused(campaign, reason=reason)


@pytest.mark.parametrize("submission", ["", "s9", "s\x00"])
def test_nobody_is_asked_for_what_nobody_did(work: Assignment, campaign: Campaign, submission: str) -> None:
    assert "Nobody works here" in refused(campaign, submission)


def test_what_is_decided_is_not_asked_back(work: Assignment, campaign: Campaign, ada: Worker) -> None:
    decide(work, "accepted")
    assert "decided" in refused(campaign)
    assign(campaign, ada, State.REJECTED, submission="s2")
    assert "decided" in refused(campaign, "s2")


def test_what_was_given_back_is_not_asked_for(work: Assignment, campaign: Campaign) -> None:
    observe(campaign, told("RETURNED"))
    assert "given back already" in refused(campaign)


def test_other_platforms_ask_nobody(work: Assignment, campaign: Campaign) -> None:
    Campaign.objects.update(platform=Campaign.Platform.LINK)
    assert "cannot ask" in refused(campaign)
    assert not OutboxRow.objects.exists()
