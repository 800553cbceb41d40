"""A campaign's outbox at one look, with a number of queries that does not depend on its length."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from django.db.models import Case, Count, QuerySet, Sum, Value, When

from gtm_hit.models import Campaign, OutboxRow
from gtm_hit.ops.pay.sums import NOTHING, exact

State = OutboxRow.State
ORDER = [State.UNCLEAR, State.FAILED, State.SENT, State.PLANNED, State.CONFIRMED, State.WITHDRAWN]


@dataclass(frozen=True)
class KindPlanned:
    """What the next run would send of one kind."""

    kind: str
    label: str
    rows: int
    amount: Decimal


def listed(campaign: Campaign) -> QuerySet[OutboxRow]:
    """What needs a person first, then what is under way, then what is over, newest first."""
    rank = Case(*(When(state=state, then=Value(place)) for place, state in enumerate(ORDER)))
    found = OutboxRow.objects.filter(campaign=campaign).annotate(rank=rank).order_by("rank", "-pk")
    return found.select_related("worker", "planned_by", "decided_by", "assignment__batch")


def counts(campaign: Campaign) -> dict[str, int]:
    rows = OutboxRow.objects.filter(campaign=campaign).order_by()
    found = dict(rows.values("state").annotate(number=Count("pk")).values_list("state", "number"))
    return {state: found.get(state, 0) for state in State.values}


def next_run(campaign: Campaign) -> list[KindPlanned]:
    """The dry run of sending, in the order of the kinds."""
    rows = OutboxRow.objects.filter(campaign=campaign, state=State.PLANNED).order_by()
    found = {
        kind: (number, exact(amount))
        for kind, number, amount in rows.values("kind")
        .annotate(number=Count("pk"), total=Sum("amount"))
        .values_list("kind", "number", "total")
    }
    return [
        KindPlanned(kind.value, str(kind.label), *found.get(kind.value, (0, NOTHING)))
        for kind in OutboxRow.Kind
        if kind.value in found
    ]
