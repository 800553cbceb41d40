"""The ledger of a campaign's money. Lines are only added; a line's key makes sure that it is added once.

Everything that adds lines holds the campaign's row, so that two managers who press a button at one moment
see each other's lines.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from decimal import Decimal

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import QuerySet, Sum
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Campaign, MoneyEntry, OutboxRow, Worker
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.pay.sums import CENT, Balance, exact

Kind = MoneyEntry.Kind
MOST = Decimal("999999.99")


class PayError(OperationError):
    """Money was not moved; the message says why."""


@contextmanager
def holding(campaign: Campaign) -> Iterator[Campaign]:
    """The campaign as it is now, and nobody else adds lines until the block ends."""
    with transaction.atomic():
        yield Campaign.objects.select_for_update(no_key=True).get(pk=campaign.pk)


def settle(campaign: Campaign) -> int:
    """Book what accepted batches earn and take back what is not accepted any more; the lines added.

    For callers that hold the campaign. The same again adds nothing.
    """
    booked = earned_by_assignment(campaign)
    wanted = dict(accepted(campaign).values_list("pk", "worker_id"))
    lines = [
        (pk, worker, campaign.pay_per_batch)
        for pk, worker in wanted.items()
        if not booked.get(pk) and campaign.pay_per_batch
    ]
    gone = [pk for pk, amount in booked.items() if amount and pk not in wanted]
    workers = dict(Assignment.objects.filter(pk__in=gone).values_list("pk", "worker_id"))
    lines += [(pk, workers[pk], -booked[pk]) for pk in gone]
    for assignment, worker, amount in lines:
        nth = MoneyEntry.objects.filter(assignment=assignment, kind=Kind.EARNED).count()
        add(campaign, worker, Kind.EARNED, amount, f"earned:{assignment}:{nth}", assignment_id=assignment)
    return len(lines)


def accepted(campaign: Campaign) -> QuerySet[Assignment]:
    return Assignment.objects.filter(batch__campaign=campaign, state=Assignment.State.ACCEPTED)


def earned_by_assignment(campaign: Campaign) -> dict[int, Decimal]:
    lines = MoneyEntry.objects.filter(campaign=campaign, kind=Kind.EARNED, assignment__isnull=False)
    summed = lines.order_by().values("assignment").annotate(total=Sum("amount"))
    return {pk: exact(total) for pk, total in summed.values_list("assignment", "total")}


def balance(campaign: Campaign, worker_id: int) -> Balance:
    """After `settle`."""
    lines = MoneyEntry.objects.filter(campaign=campaign, worker=worker_id).order_by()
    sums = dict(lines.values("kind").annotate(total=Sum("amount")).values_list("kind", "total"))
    waiting = OutboxRow.objects.filter(
        campaign=campaign, worker=worker_id, kind__in=OutboxRow.MONEY, state__in=OutboxRow.UNDER_WAY
    )
    return Balance(
        earned=exact(sums.get(Kind.EARNED)),
        bonus_approved=exact(sums.get(Kind.BONUS_APPROVED)),
        paid=exact(sums.get(Kind.PAID)),
        on_its_way=exact(waiting.aggregate(total=Sum("amount"))["total"]),
    )


def approve_bonus(
    campaign: Campaign, worker: Worker, proposed: Decimal, by: User | None, amount: Decimal | None = None
) -> MoneyEntry:
    """Owe a worker a bonus, with what was proposed kept beside it. For callers that hold the campaign."""
    approved = proposed if amount is None else clean(amount)
    nth = MoneyEntry.objects.filter(campaign=campaign, worker=worker).count()
    key = f"bonus:{campaign.pk}:{worker.pk}:{nth}"
    if proposed:
        add(campaign, worker.pk, Kind.BONUS_PROPOSED, proposed, f"{key}:proposed")
    return add(campaign, worker.pk, Kind.BONUS_APPROVED, approved, key, user=by)


def mark_paid(
    campaign: Campaign, worker: Worker, by: User | None, amount: Decimal | None = None, note: str = ""
) -> MoneyEntry:
    """Money that was handed over by other ways; without an amount: all there is to pay. Raises PayError."""
    with holding(campaign) as held:
        settle(held)
        due = balance(held, worker.pk).to_pay
        paid = due if amount is None else clean(amount)
        if not due:
            raise PayError(_("There is nothing to pay to %(worker)s.") % {"worker": worker.pseudonym})
        if paid > due:
            words = _("%(worker)s is to get %(due)s %(currency)s, not %(paid)s.")
            told = {"worker": worker.pseudonym, "due": due, "currency": held.currency, "paid": paid}
            raise PayError(words % told)
        nth = MoneyEntry.objects.filter(campaign=held, worker=worker).count()
        key = f"hand:{held.pk}:{worker.pk}:{nth}"
        return add(held, worker.pk, Kind.PAID, paid, key, user=by, note=note[:300] or _("by hand"))


def book_confirmed(row: OutboxRow) -> None:
    """The platform paid what the row says."""
    if row.kind not in OutboxRow.MONEY or not row.amount or row.state != OutboxRow.State.CONFIRMED:
        return
    note = _("by the platform")
    key = f"outbox:{row.pk}"
    user = row.decided_by
    add(
        row.campaign, row.worker_id, Kind.PAID, row.amount, key, user=user, note=note,
        assignment_id=row.assignment_id,
    )  # fmt: skip


def can_be_taken_back(entry: MoneyEntry) -> bool:
    """Bonuses and payments by hand, once. What was earned follows decisions, what was sent stays sent."""
    by_hand = entry.kind == Kind.PAID and entry.key.startswith("hand:")
    first = not entry.reverses_id and not hasattr(entry, "reversal")
    return first and (entry.kind == Kind.BONUS_APPROVED or by_hand)


def take_back(entry: MoneyEntry, by: User | None, note: str) -> MoneyEntry:
    """A bonus that was approved, or a payment by hand that never was, once. Raises PayError."""
    with holding(entry.campaign) as held:
        if entry.reverses_id or MoneyEntry.objects.filter(reverses=entry).exists():
            raise PayError(_("This line is taken back already."))
        if entry.kind == Kind.BONUS_APPROVED and balance(held, entry.worker_id).to_pay < entry.amount:
            raise PayError(_("This bonus is paid, or on its way, already."))
        if not can_be_taken_back(entry):
            raise PayError(_("Only bonuses and payments by hand can be taken back."))
        key, why = f"back:{entry.pk}", note[:300]
        return add(held, entry.worker_id, entry.kind, -entry.amount, key, user=by, note=why, reverses=entry)


def add(
    campaign: Campaign, worker_id: int, kind: str, amount: Decimal, key: str, **values: object
) -> MoneyEntry:
    return MoneyEntry.objects.create(
        campaign=campaign,
        worker_id=worker_id,
        kind=kind,
        amount=amount,
        key=key,
        currency=campaign.currency,
        **values,
    )


def clean(amount: Decimal) -> Decimal:
    """Positive, of whole cents. Raises PayError."""
    if not amount.is_finite() or amount <= 0 or amount > MOST or amount != amount.quantize(CENT):
        raise PayError(_("%(amount)s is no amount of money.") % {"amount": amount})
    return amount.quantize(CENT)
