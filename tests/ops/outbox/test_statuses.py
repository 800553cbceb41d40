"""What the platform says, late, twice and in any order."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.crowd.prolific import connect
from gtm_hit.models import Assignment, Campaign, OutboxRow, Submission, Worker
from gtm_hit.ops.outbox import statuses
from gtm_hit.ops.outbox.statuses import FINAL, Told, newest, observe, take_in
from gtm_hit.ops.pay import table
from gtm_hit.ops.work import assignments
from gtm_hit.ops.work.pools import Pool
from tests.ops.outbox.conftest import REASON, decide
from tests.paid_campaign import assign, become
from tests.prolific_server import Prolific

State = Assignment.State
NOON = datetime(2026, 11, 25, 12, tzinfo=UTC)


def told(status: str, minutes: float = 0, submission: str = "s1") -> Told:
    return Told(submission, "ada", status, NOON + timedelta(minutes=minutes))


def state(work: Assignment) -> str:
    work.refresh_from_db()
    return work.state


@pytest.mark.parametrize("status", ["RETURNED", "TIMED-OUT"])
def test_work_given_up_at_the_platform_frees_its_batch(campaign: Campaign, ada: Worker, status: str) -> None:
    work = assign(campaign, ada, State.LEASED, submission="s1")
    assert observe(campaign, told(status))
    assert state(work) == "expired"
    step = work.transitions.get()
    assert (step.from_state, step.action, step.reason) == ("leased", "give_up", f"{status} at the platform")


def test_nobody_works_on_unpaid_under_a_submission_that_was_given_back(
    campaign: Campaign, ada: Worker
) -> None:
    seat = Pool(campaign.dataset, campaign, "s1")
    assignments.claim(ada, seat)
    observe(campaign, told("RETURNED"))
    assert not assignments.work_left(ada, seat)
    with pytest.raises(assignments.NoFreeBatch):
        assignments.claim(ada, seat)
    assert assignments.claim(ada, Pool(campaign.dataset, campaign, "s2"))


@pytest.mark.parametrize("kept", [State.SUBMITTED, State.ACCEPTED, State.REJECTED])
def test_work_that_was_handed_in_or_decided_is_left_alone(campaign: Campaign, ada: Worker, kept: str) -> None:
    work = assign(campaign, ada, kept, submission="s1")
    observe(campaign, told("RETURNED"))
    assert state(work) == kept


def test_another_campaigns_batch_is_not_touched(campaign: Campaign, ada: Worker) -> None:
    work = assign(campaign, ada, State.LEASED, submission="s2")
    observe(campaign, told("RETURNED"))
    assert state(work) == "leased"


def test_a_late_message_changes_nothing(campaign: Campaign, ada: Worker) -> None:
    observe(campaign, told("AWAITING REVIEW", minutes=10))
    work = assign(campaign, ada, State.LEASED, submission="s1")
    assert not observe(campaign, told("TIMED-OUT", minutes=5))
    assert (state(work), Submission.objects.get().status) == ("leased", "AWAITING REVIEW")


def test_the_same_message_twice_is_one(campaign: Campaign, ada: Worker) -> None:
    kind = statuses.STATUS_CHANGE
    assert take_in(campaign, "e1", kind, told("TIMED-OUT"))
    work = assign(campaign, ada, State.LEASED, submission="s1")
    assert not take_in(campaign, "e1", kind, told("TIMED-OUT", minutes=60))
    assert state(work) == "leased"


def test_what_is_decided_stays_so(campaign: Campaign) -> None:
    observe(campaign, told("APPROVED"))
    assert not observe(campaign, told("ACTIVE", minutes=30))
    assert Submission.objects.get().status == "APPROVED"


def test_messages_about_other_things_are_remembered_and_followed_by_nothing(campaign: Campaign) -> None:
    assert not take_in(campaign, "e1", "study.progress.change", told("ACTIVE"))
    assert not Submission.objects.exists()


def test_an_approval_at_the_platform_confirms_what_was_planned_and_pays_once(
    work: Assignment, campaign: Campaign
) -> None:
    decide(work, "accepted")
    for minutes in (0, 1):
        observe(campaign, told("APPROVED", minutes))
    assert OutboxRow.objects.get().state == "confirmed"
    assert table.workers(campaign)[0].balance.paid == 2


def test_an_approval_at_the_platform_does_not_confirm_a_rejection(
    work: Assignment, campaign: Campaign
) -> None:
    decide(work, "rejected", message=REASON, category="LOW_EFFORT")
    observe(campaign, told("APPROVED"))
    assert OutboxRow.objects.get().state == "planned"


def test_a_batch_accepted_after_the_platform_approved_by_itself_is_paid_already(
    work: Assignment, campaign: Campaign
) -> None:
    observe(campaign, told("APPROVED"))
    decide(work, "accepted")
    assert OutboxRow.objects.get().state == "confirmed"
    assert table.workers(campaign)[0].balance.to_pay == 0


def test_the_platform_is_asked_about_all_submissions(
    work: Assignment, campaign: Campaign, prolific: Prolific
) -> None:
    become(work, State.ACCEPTED)
    prolific.add("s9", "grace", status="RETURNED")
    assert statuses.ask_all(campaign, connect(campaign)) == 2
    assert statuses.ask_all(campaign, connect(campaign)) == 0
    assert statuses.unmatched(campaign) == 1


STATUSES = ["RESERVED", "ACTIVE", "TIMED-OUT", "AWAITING REVIEW", "APPROVED", "REJECTED", "RETURNED"]
messages = st.lists(st.tuples(st.sampled_from(STATUSES), st.integers(0, 100)), max_size=12)


def after(*said: tuple[str, int]) -> str:
    kept = ("", NOON - timedelta(days=1))
    for status, minutes in said:
        kept = newest(*kept, told(status, minutes))
    return kept[0]


@given(messages)
def test_however_often_messages_are_repeated_the_end_is_the_same(said: list[tuple[str, int]]) -> None:
    assert after(*said, *said) == after(*said) or after(*said) in FINAL


@given(messages)
def test_once_decided_no_message_reopens_a_submission(said: list[tuple[str, int]]) -> None:
    for cut in range(len(said)):
        if after(*said[:cut]) in FINAL:
            assert after(*said) in FINAL
