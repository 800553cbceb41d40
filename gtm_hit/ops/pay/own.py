"""The money of one worker, in one campaign or several: a number of queries that depends on neither."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal

from django.db.models import Sum

from gtm_hit.models import Assignment, Campaign, LayerFrame, MoneyEntry, OutboxRow, Worker
from gtm_hit.ops.pay.sums import NOTHING, Balance, bonus_to_floor, exact, per_hour

State = Assignment.State
Kind = MoneyEntry.Kind


@dataclass(frozen=True)
class Money:
    """`waiting`: batches that were submitted and may still become money."""

    balance: Balance
    waiting: int

    @property
    def any(self) -> bool:
        return self.balance != Balance() or self.waiting > 0


def money(worker: Worker, campaigns: Iterable[Campaign]) -> dict[int, Money]:
    """By campaign: as it is after `ledger.settle`, without writing."""
    found = list(campaigns)
    accepted, waiting = submitted(worker, found)
    booked, sums, under_way = earned(worker, found), others(worker, found), on_its_way(worker, found)
    return {
        one.pk: Money(
            Balance(
                earned=sum((booked.get(pk) or one.pay_per_batch for pk in accepted[one.pk]), NOTHING),
                bonus_approved=sums.get((one.pk, Kind.BONUS_APPROVED), NOTHING),
                paid=sums.get((one.pk, Kind.PAID), NOTHING),
                on_its_way=under_way.get(one.pk, NOTHING),
            ),
            waiting[one.pk],
        )
        for one in found
    }


def submitted(worker: Worker, campaigns: list[Campaign]) -> tuple[dict[int, list[int]], dict[int, int]]:
    """Accepted assignments by campaign, and how many wait for a decision."""
    accepted: dict[int, list[int]] = defaultdict(list)
    waiting: dict[int, int] = defaultdict(int)
    states = [State.ACCEPTED, State.SUBMITTED, State.RETURNED]
    rows = Assignment.objects.filter(worker=worker, batch__campaign__in=campaigns, state__in=states)
    for pk, campaign, state in rows.order_by().values_list("pk", "batch__campaign", "state"):
        if state == State.ACCEPTED:
            accepted[campaign].append(pk)
        else:
            waiting[campaign] += 1
    return accepted, waiting


def earned(worker: Worker, campaigns: list[Campaign]) -> dict[int, Decimal]:
    """By assignment, as far as it is booked."""
    lines = MoneyEntry.objects.filter(campaign__in=campaigns, worker=worker, kind=Kind.EARNED)
    summed = lines.order_by().values("assignment").annotate(total=Sum("amount"))
    return {pk: exact(total) for pk, total in summed.values_list("assignment", "total")}


def others(worker: Worker, campaigns: list[Campaign]) -> dict[tuple[int, str], Decimal]:
    """What is not earned by batches: by campaign and kind."""
    lines = MoneyEntry.objects.filter(campaign__in=campaigns, worker=worker).exclude(kind=Kind.EARNED)
    summed = lines.order_by().values("campaign", "kind").annotate(total=Sum("amount"))
    rows = summed.values_list("campaign", "kind", "total")
    return {(campaign, kind): exact(total) for campaign, kind, total in rows}


def on_its_way(worker: Worker, campaigns: list[Campaign]) -> dict[int, Decimal]:
    rows = OutboxRow.objects.filter(
        campaign__in=campaigns, worker=worker, kind__in=OutboxRow.MONEY, state__in=OutboxRow.UNDER_WAY
    ).order_by()
    summed = rows.values("campaign").annotate(total=Sum("amount"))
    return {campaign: exact(total) for campaign, total in summed.values_list("campaign", "total")}


@dataclass(frozen=True)
class Hourly:
    """What an hour in accepted batches came to, and the bonus that is missing to the floor."""

    per_hour: Decimal | None
    proposed: Decimal


def hourly(campaign: Campaign, worker: Worker, owed: Decimal) -> Hourly:
    frames = LayerFrame.objects.filter(
        layer__assignment__batch__campaign=campaign,
        layer__assignment__worker=worker,
        layer__assignment__state=State.ACCEPTED,
    )
    seconds = frames.aggregate(total=Sum("seconds"))["total"] or 0.0
    return Hourly(per_hour(owed, seconds), bonus_to_floor(owed, seconds, campaign.hourly_floor))
