"""Telling the platform, with everything that goes wrong between a request and its answer."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.utils import timezone

from gtm_hit.crowd.prolific import connect
from gtm_hit.models import Assignment, Campaign, MoneyEntry, OutboxRow, PlatformAccount, Worker
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.outbox import accounts, planning, reconciling, return_requests, rows, sending
from gtm_hit.ops.pay import table
from tests.ops.outbox.conftest import REASON, decide, hurry, send, states
from tests.paid_campaign import assign
from tests.prolific_server import Prolific

State = Assignment.State


@pytest.fixture
def bonus(work: Assignment, campaign: Campaign) -> OutboxRow:
    """Accepted, approved, and a bonus of 2.00 planned."""
    decide(work, "accepted")
    table.approve_bonuses(campaign, None)
    send(campaign)
    (row,) = planning.plan_payouts(campaign, None)
    return row


def paid(campaign: Campaign) -> Any:
    return table.workers(campaign)[0].balance.paid


def state(row: OutboxRow) -> str:
    row.refresh_from_db()
    return row.state


def test_an_approval_reaches_the_platform_and_the_ledger(
    work: Assignment, campaign: Campaign, prolific: Prolific
) -> None:
    decide(work, "accepted")
    assert send(campaign).confirmed == 1
    assert (prolific.submissions["s1"]["status"], paid(campaign)) == ("APPROVED", 2)


def test_a_rejection_reaches_the_platform_and_moves_no_money(
    work: Assignment, campaign: Campaign, prolific: Prolific
) -> None:
    decide(work, "rejected", message=REASON, category="FAILED_CHECK")
    send(campaign)
    assert (prolific.submissions["s1"]["status"], paid(campaign)) == ("REJECTED", 0)


def test_a_return_is_asked_for(work: Assignment, campaign: Campaign, prolific: Prolific) -> None:
    return_requests.plan(campaign, "s1", "Withdrew consent", None)
    send(campaign)
    assert prolific.submissions["s1"]["return_requested"]


def test_a_bonus_is_set_up_paid_and_booked(bonus: OutboxRow, campaign: Campaign, prolific: Prolific) -> None:
    send(campaign)
    assert (prolific.paid("s1"), paid(campaign), state(bonus)) == (2, 4, "confirmed")
    send(campaign)
    assert (prolific.paid("s1"), paid(campaign)) == (2, 4)


@pytest.mark.parametrize("how", ["drop_after", "status_after"])
def test_a_payment_whose_answer_was_lost_is_found_at_the_platform_and_not_paid_again(
    bonus: OutboxRow, campaign: Campaign, prolific: Prolific, how: str
) -> None:
    prolific.go_wrong("/pay/", how)
    send(campaign)
    assert state(bonus) == "sent"
    send(campaign)
    assert (prolific.paid("s1"), paid(campaign), state(bonus)) == (2, 4, "confirmed")


def test_a_payment_that_is_booked_late_is_waited_for(
    bonus: OutboxRow, campaign: Campaign, prolific: Prolific
) -> None:
    prolific.slow = True
    prolific.go_wrong("/pay/", "drop_after")
    for _again in range(3):
        send(campaign)
        assert state(bonus) == "sent"
    prolific.book()
    send(campaign)
    assert (prolific.paid("s1"), paid(campaign)) == (2, 4)


def test_a_payment_the_platform_never_shows_is_left_to_a_person(
    bonus: OutboxRow, campaign: Campaign, prolific: Prolific, manager: User
) -> None:
    prolific.go_wrong("/pay/", "drop_before")
    send(campaign)
    OutboxRow.objects.filter(pk=bonus.pk).update(sent_at=timezone.now() - timedelta(hours=1))
    for _again in range(3):
        send(campaign)
    assert (state(bonus), prolific.payments, paid(campaign)) == ("unclear", [], 2)
    assert planning.plan_payouts(campaign, None) == []  # it may be on its way
    rows.resolve(bonus, happened=False, by=manager)
    bonus.refresh_from_db()
    rows.retry(bonus, manager)
    send(campaign)
    assert (state(bonus), prolific.paid("s1"), paid(campaign)) == ("confirmed", 2, 4)


def test_a_person_may_say_that_an_unclear_payment_was_made(
    bonus: OutboxRow, campaign: Campaign, prolific: Prolific, manager: User
) -> None:
    OutboxRow.objects.filter(pk=bonus.pk).update(state="unclear")
    bonus.refresh_from_db()
    rows.resolve(bonus, happened=True, by=manager)
    assert (state(bonus), paid(campaign), prolific.payments) == ("confirmed", 4, [])
    assert MoneyEntry.objects.get(key=f"outbox:{bonus.pk}").user == manager


def test_a_bonus_of_the_same_amount_from_before_is_not_taken_for_the_lost_one(
    bonus: OutboxRow, campaign: Campaign, prolific: Prolific
) -> None:
    prolific.payments.append(("s1", 200))
    prolific.book()
    prolific.go_wrong("/pay/", "drop_before")
    send(campaign)
    send(campaign)
    assert state(bonus) == "sent"


def test_the_second_bonus_waits_until_the_first_is_clear(
    bonus: OutboxRow, campaign: Campaign, prolific: Prolific, ada: Worker
) -> None:
    prolific.slow = True
    prolific.go_wrong("/pay/", "drop_after")
    send(campaign)
    table.approve_bonuses(campaign, None, [ada.pseudonym], bonus.amount)
    (second,) = planning.plan_payouts(campaign, None)
    send(campaign)
    assert (state(bonus), state(second)) == ("sent", "planned")
    prolific.slow = False
    prolific.book()
    send(campaign)
    assert (state(bonus), state(second), prolific.paid("s1")) == ("confirmed", "confirmed", 4)


@pytest.mark.parametrize("how", ["drop_before", "drop_after", "status_after", "status"])
def test_an_approval_whose_answer_was_lost_is_sent_again_and_booked_once(
    work: Assignment, campaign: Campaign, prolific: Prolific, how: str
) -> None:
    decide(work, "accepted")
    prolific.go_wrong("/transition/", how)
    send(campaign)
    hurry(campaign)
    send(campaign)
    assert (states(campaign), paid(campaign)) == ([("approve", "confirmed")], 2)


def test_an_approval_that_never_gets_an_answer_is_unclear_and_not_paid_otherwise(
    work: Assignment, campaign: Campaign, prolific: Prolific
) -> None:
    decide(work, "accepted")
    for _each in range(sending.MOST_ATTEMPTS):
        prolific.go_wrong("/transition/", "drop_before")
        hurry(campaign)
        send(campaign)
    assert states(campaign) == [("approve", "unclear")]
    assert table.workers(campaign)[0].balance.to_pay == 0


def test_a_platform_that_asks_to_wait_is_left_alone_that_long(
    work: Assignment, campaign: Campaign, prolific: Prolific
) -> None:
    decide(work, "accepted")
    prolific.go_wrong("/transition/", "status", status=429, retry_after="600")
    send(campaign)
    row = OutboxRow.objects.get()
    assert row.state == "planned" and row.not_before is not None
    assert 590 < (row.not_before - timezone.now()).total_seconds() <= 600
    assert send(campaign).confirmed == 0
    hurry(campaign)
    assert send(campaign).confirmed == 1


def test_a_short_wait_is_waited_for(work: Assignment, campaign: Campaign, prolific: Prolific) -> None:
    decide(work, "accepted")
    prolific.go_wrong("/transition/", "status", status=429, retry_after="0")
    assert send(campaign).confirmed == 1


def test_a_refusal_is_final_and_says_why(work: Assignment, campaign: Campaign, prolific: Prolific) -> None:
    decide(work, "accepted")
    prolific.submissions["s1"]["status"] = "RETURNED"
    assert send(campaign).failed == 1
    assert "RETURNED" in OutboxRow.objects.get().error
    assert table.workers(campaign)[0].balance.to_pay == 2


def test_what_was_approved_at_the_platform_already_is_confirmed(
    work: Assignment, campaign: Campaign, prolific: Prolific
) -> None:
    decide(work, "accepted")
    prolific.submissions["s1"]["status"] = "APPROVED"
    assert send(campaign).confirmed == 1


def test_a_bonus_for_somebody_unknown_there_fails_with_its_payment(
    campaign: Campaign, ada: Worker, prolific: Prolific
) -> None:
    ada.external_id = "nobody"
    ada.save()
    assign(campaign, ada)
    planning.plan_payouts(campaign, None)
    send(campaign)
    assert states(campaign) == [("bonus_setup", "failed"), ("bonus_pay", "failed")]
    assert prolific.payments == []


def test_a_bonus_under_a_participants_id_is_found_among_his_submissions(
    campaign: Campaign, ada: Worker, prolific: Prolific
) -> None:
    assign(campaign, ada)
    planning.plan_payouts(campaign, None)
    prolific.go_wrong("/pay/", "drop_after")
    send(campaign)
    send(campaign)
    assert (prolific.paid("s1"), paid(campaign)) == (2, 2)


def test_no_connection_leaves_everything_planned(work: Assignment, campaign: Campaign, settings: Any) -> None:
    decide(work, "accepted")
    settings.PROLIFIC_ADDRESSES = ["http://127.0.0.1:9"]
    assert send(campaign).planned == 1


def test_without_a_key_the_job_says_so_and_sends_nothing(work: Assignment, campaign: Campaign) -> None:
    decide(work, "accepted")
    PlatformAccount.objects.update(token="")
    job = sending.start(campaign)
    queue.run(job.pk, {"send_outbox": lambda mine: sending.run(mine, connect)})
    job.refresh_from_db()
    assert (job.state, states(campaign)) == ("failed", [("approve", "planned")])
    assert "key" in job.message


def test_a_run_that_was_broken_off_is_taken_up_again(bonus: OutboxRow, campaign: Campaign) -> None:
    assert sending.resume(timezone.now()) == []  # nobody has sent it yet
    rows.take(bonus.after_id or 0)
    (job,) = sending.resume(timezone.now())
    assert job.parameters["campaign"] == campaign.pk


def test_only_addresses_the_operator_named_are_asked(campaign: Campaign, settings: Any) -> None:
    with pytest.raises(accounts.AccountError):
        accounts.configure(campaign, None, address="http://169.254.169.254")
    settings.PROLIFIC_ADDRESSES = ["https://elsewhere.example"]
    PlatformAccount.objects.update(address="http://127.0.0.1:1")
    with pytest.raises(accounts.AccountError):
        connect(campaign)


def test_the_servers_own_key_goes_to_the_first_address_only(campaign: Campaign, settings: Any) -> None:
    settings.PROLIFIC_ADDRESSES = ["https://one.example", "https://two.example"]
    settings.PROLIFIC_TOKEN = "server-key"
    PlatformAccount.objects.update(token="")
    assert accounts.key(accounts.of(campaign)) == "server-key"
    PlatformAccount.objects.update(address="https://two.example")
    assert not accounts.has_key(accounts.of(campaign))


def test_a_key_is_kept_changed_and_forgotten(campaign: Campaign) -> None:
    kept = [accounts.configure(campaign, None, token=given).token for given in ("first", "", "second", "-")]
    assert kept == ["first", "first", "second", ""]
    with pytest.raises(accounts.AccountError):
        accounts.configure(campaign, None, token="a\r\nX-Evil: 1")


def test_reconciling_pays_nothing(bonus: OutboxRow, campaign: Campaign, prolific: Prolific) -> None:
    OutboxRow.objects.filter(campaign=campaign).exclude(state="confirmed").update(
        state="sent", sent_at=timezone.now()
    )
    reconciling.reconcile(campaign, connect(campaign), "st1")
    assert not [asked for asked in prolific.asked if "/pay/" in asked]
