"""Money: what is owed, what was paid, and that nothing is booked or paid twice."""

from __future__ import annotations

from decimal import Decimal
from threading import Barrier, Thread

import pytest
from django.contrib.auth.models import User
from django.db import IntegrityError, connection, connections, transaction
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import AppendOnlyError, Assignment, Campaign, MoneyEntry, Worker
from gtm_hit.ops.pay import csv_files, ledger, table
from gtm_hit.ops.pay.sums import Balance, bonus_to_floor, per_hour
from tests.paid_campaign import assign, become, make_campaign
from tests.work_scene import make_dataset, make_worker

State = Assignment.State


@pytest.fixture
def campaign(db: None) -> Campaign:
    return make_campaign()


@pytest.fixture
def ada(db: None) -> Worker:
    return make_worker("ada")


@pytest.fixture
def manager(db: None) -> User:
    return User.objects.create_user("manager", is_superuser=True)


def only(campaign: Campaign) -> table.WorkerPay:
    (line,) = table.workers(campaign)
    return line


def settled(campaign: Campaign) -> int:
    with ledger.holding(campaign) as held:
        return ledger.settle(held)


def test_an_accepted_batch_earns_what_the_campaign_pays_for_one(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada)
    assign(campaign, ada, State.SUBMITTED)
    line = only(campaign)
    assert (line.accepted, line.waiting, line.balance.earned, line.balance.to_pay) == (1, 1, 2, 2)
    assert not MoneyEntry.objects.exists()  # looking writes nothing


def test_what_a_batch_earned_is_booked_once(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada)
    assert [settled(campaign) for _again in range(3)] == [1, 0, 0]


def test_a_batch_keeps_the_pay_it_was_accepted_for(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada)
    settled(campaign)
    Campaign.objects.update(pay_per_batch=Decimal("9.99"))
    campaign.refresh_from_db()
    assert only(campaign).balance.earned == 2


def test_acceptance_taken_back_is_a_line_of_its_own_and_may_come_again(
    campaign: Campaign, ada: Worker
) -> None:
    work = assign(campaign, ada)
    for state in (State.ACCEPTED, State.REJECTED, State.ACCEPTED):
        become(work, state)
        settled(campaign)
    assert [line.amount for line in MoneyEntry.objects.all()] == [2, -2, 2]
    assert only(campaign).balance.earned == 2


def test_an_hour_below_the_floor_gets_a_bonus_proposed(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada, minutes=30)
    line = only(campaign)
    assert (line.per_hour, line.proposed) == (Decimal("4.00"), Decimal("2.00"))


def test_time_of_what_is_not_accepted_makes_no_bonus(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada, State.REJECTED, minutes=300)
    assert (only(campaign).proposed, only(campaign).all_seconds) == (0, 18_000)


def test_an_approved_bonus_is_owed_and_proposed_no_more(
    campaign: Campaign, ada: Worker, manager: User
) -> None:
    assign(campaign, ada, minutes=30)
    assert len(table.approve_bonuses(campaign, manager)) == 1
    assert table.approve_bonuses(campaign, manager) == []
    line = only(campaign)
    assert (line.balance.to_pay, line.proposed, line.per_hour) == (4, 0, 8)
    kinds = set(MoneyEntry.objects.values_list("kind", "amount", "user__username"))
    assert {("bonus_proposed", 2, None), ("bonus_approved", 2, "manager")} <= kinds


def test_a_manager_may_approve_another_amount(campaign: Campaign, ada: Worker, manager: User) -> None:
    assign(campaign, ada, minutes=30)
    table.approve_bonuses(campaign, manager, [ada.pseudonym], Decimal("0.50"))
    assert (only(campaign).balance.bonus_approved, only(campaign).proposed) == (
        Decimal("0.50"),
        Decimal("1.50"),
    )


@pytest.mark.parametrize("amount", ["0", "-1", "0.001", "NaN", "Infinity", "1e9"])
def test_what_is_no_amount_of_money_is_refused(
    campaign: Campaign, ada: Worker, manager: User, amount: str
) -> None:
    assign(campaign, ada)
    with pytest.raises(ledger.PayError):
        table.approve_bonuses(campaign, manager, [ada.pseudonym], Decimal(amount))
    with pytest.raises(ledger.PayError):
        ledger.mark_paid(campaign, ada, manager, Decimal(amount))
    assert not MoneyEntry.objects.exists()


def test_a_bonus_for_somebody_who_never_worked_here_is_refused(campaign: Campaign, ada: Worker) -> None:
    with pytest.raises(ledger.PayError):
        table.approve_bonuses(campaign, None, [ada.pseudonym])


def test_paying_by_hand_pays_what_is_left_and_not_twice(
    campaign: Campaign, ada: Worker, manager: User
) -> None:
    assign(campaign, ada)
    ledger.mark_paid(campaign, ada, manager, Decimal("0.50"), "in cash")
    ledger.mark_paid(campaign, ada, manager)
    assert (only(campaign).balance.paid, only(campaign).balance.to_pay) == (2, 0)
    with pytest.raises(ledger.PayError, match="nothing to pay"):
        ledger.mark_paid(campaign, ada, manager)


def test_more_than_is_owed_is_not_paid(campaign: Campaign, ada: Worker, manager: User) -> None:
    assign(campaign, ada)
    with pytest.raises(ledger.PayError, match=r"2\.00 EUR"):
        ledger.mark_paid(campaign, ada, manager, Decimal("2.01"))
    assert only(campaign).balance.paid == 0


def test_what_was_rejected_after_it_was_paid_is_overpaid_and_never_negative(
    campaign: Campaign, ada: Worker, manager: User
) -> None:
    work = assign(campaign, ada)
    ledger.mark_paid(campaign, ada, manager)
    become(work, State.REJECTED)
    balance = only(campaign).balance
    assert (balance.to_pay, balance.overpaid) == (0, 2)


def test_a_payment_that_never_was_is_taken_back_once(campaign: Campaign, ada: Worker, manager: User) -> None:
    assign(campaign, ada)
    paid = ledger.mark_paid(campaign, ada, manager)
    ledger.take_back(paid, manager, "the transfer came back")
    assert only(campaign).balance.to_pay == 2
    with pytest.raises(ledger.PayError, match="already"):
        ledger.take_back(paid, manager, "again")


def test_a_bonus_that_is_paid_is_not_taken_back(campaign: Campaign, ada: Worker, manager: User) -> None:
    assign(campaign, ada, minutes=30)
    (bonus,) = table.approve_bonuses(campaign, manager)
    ledger.mark_paid(campaign, ada, manager)
    with pytest.raises(ledger.PayError, match="paid"):
        ledger.take_back(bonus, manager, "too much")


def test_what_was_earned_is_taken_back_by_a_decision_only(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada)
    settled(campaign)
    with pytest.raises(ledger.PayError, match="Only"):
        ledger.take_back(MoneyEntry.objects.get(), None, "no")


def test_lines_are_never_changed_or_deleted(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada)
    settled(campaign)
    line = MoneyEntry.objects.get()
    line.amount = Decimal(5)
    with pytest.raises(AppendOnlyError):
        line.save()
    with pytest.raises(AppendOnlyError):
        line.delete()


def test_the_database_refuses_a_second_line_for_one_reason(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada)
    settled(campaign)
    key = MoneyEntry.objects.get().key
    with pytest.raises(IntegrityError), transaction.atomic():
        ledger.add(campaign, ada.pk, MoneyEntry.Kind.EARNED, Decimal(2), key)


def test_the_forecast_takes_the_rest_to_cost_what_was_accepted(campaign: Campaign, ada: Worker) -> None:
    assign(campaign, ada, minutes=30)
    totals = table.totals(campaign, table.workers(campaign))
    assert (totals.cost, totals.proposed, totals.forecast) == (2, 2, 24)


def test_a_campaign_nobody_worked_in_costs_what_its_batches_pay(campaign: Campaign) -> None:
    assert table.totals(campaign, []).forecast == 12


def test_another_campaign_is_another_ledger(campaign: Campaign, ada: Worker, manager: User) -> None:
    assign(campaign, ada)
    other = make_campaign(make_dataset("other", 60), name="other")
    assert table.workers(other) == []
    with pytest.raises(ledger.PayError):
        ledger.mark_paid(other, ada, manager)


def test_csv_has_a_line_for_each_worker_and_for_each_movement(
    campaign: Campaign, ada: Worker, manager: User
) -> None:
    assign(campaign, ada, minutes=30)
    table.approve_bonuses(campaign, manager)
    ledger.mark_paid(campaign, ada, manager, note="=1+1")
    header, line = csv_files.workers(campaign).splitlines()
    found = dict(zip(header.split(","), line.split(","), strict=True))
    assert (found["worker"], found["per_hour"], found["paid"], found["to_pay"]) == (
        ada.pseudonym,
        "8.00",
        "4.00",
        "0.00",
    )
    lines = csv_files.ledger_lines(campaign).splitlines()
    assert len(lines) == 5 and "'=1+1" in lines[-1] and "ada," not in "".join(lines)


def test_two_hundred_workers_take_as_many_queries_as_one(db: None) -> None:
    campaign = make_campaign(batches=12)
    workers = [make_worker(f"w{number}") for number in range(12)]
    assign(campaign, workers[0], minutes=30)
    few = queries(campaign)
    for worker in workers[1:]:
        assign(campaign, worker, minutes=30)
    assert queries(campaign) == few


def queries(campaign: Campaign) -> int:
    with CaptureQueriesContext(connection) as captured:
        table.totals(campaign, table.workers(campaign))
    return len(captured)


@pytest.mark.django_db(transaction=True)
def test_two_managers_who_pay_at_one_moment_pay_once() -> None:
    campaign, ada = make_campaign(), make_worker("ada")
    assign(campaign, ada)
    start, refused = Barrier(4), []

    def pay() -> None:
        start.wait()
        try:
            ledger.mark_paid(campaign, ada, None)
        except ledger.PayError as error:
            refused.append(error)
        finally:
            connections.close_all()

    threads = [Thread(target=pay) for _each in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (only(campaign).balance.paid, len(refused)) == (2, 3)


@pytest.mark.parametrize(
    ("owed", "seconds", "floor", "bonus"),
    [("2", 1800, "8", "2.00"), ("2", 900, "8", "0.00"), ("0", 1, "8", "0.01"), ("2", 1801, "8", "2.01")],
)
def test_a_bonus_is_rounded_up_to_the_cent(owed: str, seconds: float, floor: str, bonus: str) -> None:
    assert bonus_to_floor(Decimal(owed), seconds, Decimal(floor)) == Decimal(bonus)


def test_a_moment_of_work_has_no_hourly_pay() -> None:
    assert per_hour(Decimal(2), 59) is None


def test_money_on_its_way_is_not_to_be_paid_again() -> None:
    assert Balance(Decimal(4), Decimal(2), Decimal(1), Decimal(3)).to_pay == 2
