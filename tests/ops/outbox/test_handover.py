"""The outbox by files: what to paste at the platform, and its list of submissions coming back."""

from __future__ import annotations

import pytest
from django.contrib.auth.models import User

from gtm_hit.models import Assignment, Campaign, OutboxRow, Submission, Worker
from gtm_hit.ops.outbox import handover, planning
from gtm_hit.ops.pay import table
from tests.ops.outbox.conftest import REASON, decide, states
from tests.paid_campaign import assign, become

State = Assignment.State
EXPORT = (
    "Submission id,Participant id,Status,Started at\n"
    "s1,ada,APPROVED,2026-11-25T10:00:00Z\n"
    "\n"
    "s2,grace,AWAITING REVIEW,2026-11-25T10:00:00Z\n"
)


def test_approvals_are_a_list_of_submissions(work: Assignment, campaign: Campaign) -> None:
    decide(work, "accepted")
    assert handover.made(campaign, "approvals").text == "s1\n"


def test_bonuses_are_lines_of_id_and_amount(work: Assignment, campaign: Campaign) -> None:
    become(work, State.ACCEPTED)
    table.approve_bonuses(campaign, None)
    planning.plan_payouts(campaign, None)
    assert handover.made(campaign, "bonuses").text == "s1,2.00\n"


def test_rejections_come_with_their_reasons(work: Assignment, campaign: Campaign) -> None:
    decide(work, "rejected", message=REASON, category="LOW_EFFORT")
    assert handover.made(campaign, "rejections").text.splitlines()[1] == f"s1,LOW_EFFORT,{REASON}"


def test_what_was_done_by_hand_is_booked_once(work: Assignment, campaign: Campaign, manager: User) -> None:
    become(work, State.ACCEPTED)
    table.approve_bonuses(campaign, None)
    planning.plan_payouts(campaign, None)
    for name in ("approvals", "bonuses"):
        upto = handover.made(campaign, name).upto
        assert [handover.done(campaign, name, upto, manager) for _again in (1, 2)] == [1, 0]
    assert {state for _kind, state in states(campaign)} == {"confirmed"}
    assert table.workers(campaign)[0].balance.paid == 4
    assert set(OutboxRow.objects.values_list("decided_by", flat=True)) == {manager.pk}


def test_what_was_planned_after_the_download_is_not_done(
    work: Assignment, campaign: Campaign, ada: Worker
) -> None:
    decide(work, "accepted")
    upto = handover.made(campaign, "approvals").upto
    decide(assign(campaign, ada, State.SUBMITTED, submission="s2"), "accepted")
    assert handover.done(campaign, "approvals", upto, None) == 1
    assert states(campaign) == [("approve", "confirmed"), ("approve", "planned")]


def test_a_file_nobody_makes_is_refused(campaign: Campaign) -> None:
    for ask in (lambda: handover.made(campaign, "x"), lambda: handover.done(campaign, "x", 1, None)):
        with pytest.raises(handover.HandoverError):
            ask()


def test_prolifics_list_of_submissions_comes_in(work: Assignment, campaign: Campaign) -> None:
    decide(work, "accepted")
    assert handover.take_in(campaign, b"\xef\xbb\xbf" + EXPORT.encode()) == (2, 2)
    assert handover.take_in(campaign, EXPORT.encode()) == (2, 0)
    assert dict(Submission.objects.values_list("submission", "status"))["s2"] == "AWAITING REVIEW"
    assert OutboxRow.objects.get().state == "confirmed"


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"a,b\n1,2\n",
        b"Submission id,Status\ns1\n",
        b"\xff\xfe\x00",
        b"Submission id,Status\ns1,APPROVED\ns2\n",
    ],
)
def test_what_is_no_such_list_changes_nothing(work: Assignment, campaign: Campaign, content: bytes) -> None:
    with pytest.raises(handover.HandoverError):
        handover.take_in(campaign, content)
    assert not Submission.objects.exists()
