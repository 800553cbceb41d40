"""A campaign's pay by worker, with a number of queries that does not depend on how many there are."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal

from django.contrib.auth.models import User
from django.db.models import Q, QuerySet, Sum
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Batch, Campaign, LayerFrame, MoneyEntry, OutboxRow, Worker
from gtm_hit.ops.campaigns import seats
from gtm_hit.ops.pay import ledger
from gtm_hit.ops.pay.sums import CENT, NOTHING, Balance, bonus_to_floor, exact, hours, per_hour

State = Assignment.State
DECIDED_LATER = [State.SUBMITTED, State.RETURNED]


@dataclass(frozen=True)
class WorkerPay:
    """`seconds`: active ones in accepted batches, which is what pay is compared with."""

    worker: Worker
    accepted: int
    waiting: int
    seconds: float
    all_seconds: float
    balance: Balance
    per_hour: Decimal | None
    proposed: Decimal

    @property
    def minutes(self) -> float:
        return self.seconds / 60

    @property
    def hours(self) -> Decimal:
        return hours(self.seconds).quantize(Decimal("0.001"))


@dataclass(frozen=True)
class Totals:
    """`forecast`: what all batches will have cost when the rest costs as much as what is accepted."""

    workers: int
    batches: int
    accepted: int
    hours: Decimal
    per_hour: Decimal | None
    cost: Decimal
    proposed: Decimal
    paid: Decimal
    on_its_way: Decimal
    to_pay: Decimal
    forecast: Decimal


def workers(campaign: Campaign) -> list[WorkerPay]:
    """Whoever had a batch or got money, who is to get most first."""
    states = assignments_by_worker(campaign)
    balances = balances_by_worker(campaign, states)
    seconds = seconds_by_worker(campaign)
    people = Worker.objects.in_bulk(states.keys() | balances.keys())
    lines = [
        line(campaign, people[pk], states.get(pk, {}), balances.get(pk, Balance()), *seconds.get(pk, (0, 0)))
        for pk in people
    ]
    return sorted(lines, key=lambda each: (-each.balance.to_pay - each.proposed, each.worker.pseudonym))


def line(
    campaign: Campaign,
    worker: Worker,
    states: dict[str, list[int]],
    balance: Balance,
    seconds: float,
    all_seconds: float,
) -> WorkerPay:
    return WorkerPay(
        worker=worker,
        accepted=len(states.get(State.ACCEPTED, [])),
        waiting=sum(len(states.get(state, [])) for state in DECIDED_LATER),
        seconds=seconds,
        all_seconds=all_seconds,
        balance=balance,
        per_hour=per_hour(balance.owed, seconds),
        proposed=bonus_to_floor(balance.owed, seconds, campaign.hourly_floor),
    )


def assignments_by_worker(campaign: Campaign) -> dict[int, dict[str, list[int]]]:
    found: dict[int, dict[str, list[int]]] = defaultdict(lambda: defaultdict(list))
    rows = Assignment.objects.filter(batch__campaign=campaign).order_by()
    for pk, worker, state in rows.values_list("pk", "worker_id", "state"):
        found[worker][state].append(pk)
    return found


def seconds_by_worker(campaign: Campaign) -> dict[int, tuple[float, float]]:
    """Of accepted batches, and of all."""
    rows = LayerFrame.objects.filter(layer__assignment__batch__campaign=campaign).order_by()
    summed = rows.values("layer__assignment__worker").annotate(
        accepted=Sum("seconds", filter=Q(layer__assignment__state=State.ACCEPTED)), total=Sum("seconds")
    )
    values = summed.values_list("layer__assignment__worker", "accepted", "total")
    return {worker: (accepted or 0.0, total or 0.0) for worker, accepted, total in values}


def balances_by_worker(campaign: Campaign, states: dict[int, dict[str, list[int]]]) -> dict[int, Balance]:
    """As they are after `ledger.settle`, without writing."""
    sums: dict[int, dict[str, Decimal]] = defaultdict(dict)
    lines = MoneyEntry.objects.filter(campaign=campaign).exclude(kind=MoneyEntry.Kind.EARNED).order_by()
    for worker, kind, total in (
        lines.values("worker", "kind").annotate(total=Sum("amount")).values_list("worker", "kind", "total")
    ):
        sums[worker][kind] = exact(total)
    waiting = waiting_by_worker(campaign)
    booked = ledger.earned_by_assignment(campaign)
    return {
        worker: Balance(
            earned=sum(
                (
                    booked.get(pk) or campaign.pay_per_batch
                    for pk in states.get(worker, {}).get(State.ACCEPTED, [])
                ),
                NOTHING,
            ),
            bonus_approved=sums[worker].get(MoneyEntry.Kind.BONUS_APPROVED, NOTHING),
            paid=sums[worker].get(MoneyEntry.Kind.PAID, NOTHING),
            on_its_way=waiting.get(worker, NOTHING),
        )
        for worker in [*states.keys() | sums.keys() | waiting.keys()]
    }


def waiting_by_worker(campaign: Campaign) -> dict[int, Decimal]:
    rows = OutboxRow.objects.filter(
        campaign=campaign, kind__in=OutboxRow.MONEY, state__in=OutboxRow.UNDER_WAY
    ).order_by()
    summed = rows.values("worker").annotate(total=Sum("amount")).values_list("worker", "total")
    return {worker: exact(total) for worker, total in summed}


def totals(campaign: Campaign, lines: Iterable[WorkerPay]) -> Totals:
    lines = list(lines)
    accepted = sum(each.accepted for each in lines)
    seconds = sum(each.seconds for each in lines)
    cost = sum((each.balance.owed for each in lines), NOTHING)
    proposed = sum((each.proposed for each in lines), NOTHING)
    batches = Batch.objects.filter(campaign=campaign).count()
    left = max(batches - accepted, 0)
    each_batch = (cost + proposed) / accepted if accepted else campaign.pay_per_batch
    return Totals(
        workers=len(lines),
        batches=batches,
        accepted=accepted,
        hours=hours(seconds).quantize(Decimal("0.1")),
        per_hour=per_hour(cost, seconds),
        cost=cost,
        proposed=proposed,
        paid=sum((each.balance.paid for each in lines), NOTHING),
        on_its_way=sum((each.balance.on_its_way for each in lines), NOTHING),
        to_pay=sum((each.balance.to_pay for each in lines), NOTHING),
        forecast=(cost + proposed + left * each_batch).quantize(CENT),
    )


def approve_bonuses(
    campaign: Campaign, by: User | None, only: Iterable[str] | None = None, amount: Decimal | None = None
) -> list[MoneyEntry]:
    """Approve what is proposed, for all or for the workers with these pseudonyms.

    `amount` instead of what is proposed is for one worker at a time. Raises PayError.
    """
    chosen = None if only is None else set(only)
    with ledger.holding(campaign) as held:
        ledger.settle(held)
        lines = [each for each in workers(held) if chosen is None or each.worker.pseudonym in chosen]
        if chosen is not None and len(lines) != len(chosen):
            raise ledger.PayError(_("Somebody of these never worked in this campaign."))
        if amount is not None and len(lines) != 1:
            raise ledger.PayError(_("An amount of your own is for one worker at a time."))
        wanted = lines if amount is not None else [each for each in lines if each.proposed]
        return [ledger.approve_bonus(held, each.worker, each.proposed, by, amount) for each in wanted]


def lines_of(campaign: Campaign) -> QuerySet[MoneyEntry]:
    """Newest first."""
    found = MoneyEntry.objects.filter(campaign=campaign)
    return found.select_related("worker", "user", "assignment__batch", "reversal").order_by("-at", "-pk")


def worker_named(campaign: Campaign, name: str) -> Worker:
    """By pseudonym, or by the platform's own id. Raises PayError."""
    found = seats.named(campaign, name)
    if found is None:
        raise ledger.PayError(_("There is no worker %(name)s in this campaign.") % {"name": name})
    return found
