"""The steps of an outbox row. Each is taken once: whoever comes second finds that the row has moved on."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import timedelta
from typing import Any

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import Exists, OuterRef, Q, QuerySet
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, OutboxRow
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.pay import ledger

State, Kind = OutboxRow.State, OutboxRow.Kind
OPEN = [State.PLANNED, State.SENT, State.UNCLEAR, State.FAILED]


class RowError(OperationError):
    """The row is not where this step begins; the message says where it is."""


def due(campaign: Campaign) -> QuerySet[OutboxRow]:
    """What may be sent now, oldest first; of a submission one bonus at a time, to tell which was lost."""
    now = timezone.now()
    paying = OutboxRow.objects.filter(
        campaign=campaign,
        kind=Kind.BONUS_PAY,
        submission=OuterRef("submission"),
        state__in=[State.SENT, State.UNCLEAR],
    )
    ready = Q(after__isnull=True) | Q(after__state=State.CONFIRMED)
    found = OutboxRow.objects.filter(ready, campaign=campaign, state=State.PLANNED)
    found = found.filter(Q(not_before__isnull=True) | Q(not_before__lte=now))
    return found.exclude(Exists(paying), kind=Kind.BONUS_PAY).order_by("pk")


def take(pk: int, **payload: Any) -> OutboxRow | None:
    """Mark a planned row as sent, for good, before the request goes out; None: it is not planned any more."""
    with transaction.atomic():
        planned = OutboxRow.objects.select_for_update(no_key=True, skip_locked=True, of=("self",))
        row = planned.select_related("after", "campaign").filter(pk=pk, state=State.PLANNED).first()
        if row is None:
            return None
        row.state, row.sent_at, row.attempts = State.SENT, timezone.now(), row.attempts + 1
        row.payload = {**row.payload, **payload}
        row.error, row.not_before = "", None
        row.save(update_fields=["state", "sent_at", "attempts", "payload", "error", "not_before"])
        return row


def confirm(pk: int, result: dict[str, Any], by: User | None = None, of: Iterable[str] = OPEN) -> bool:
    """It happened, and if it was money, the ledger says so from now on. False: somebody said so before."""
    campaign = OutboxRow.objects.select_related("campaign").get(pk=pk).campaign
    with ledger.holding(campaign):
        row = OutboxRow.objects.select_for_update(no_key=True).get(pk=pk)
        if row.state not in set(of):
            return False
        row.state, row.done_at, row.error = State.CONFIRMED, timezone.now(), ""
        row.result, row.decided_by = {**row.result, **result}, by
        row.save(update_fields=["state", "done_at", "error", "result", "decided_by"])
        ledger.book_confirmed(row)
        return True


def put_back(row: OutboxRow, error: str, wait: float = 0.0, **values: Any) -> None:
    """Nothing happened, or the same again is harmless: it is sent again."""
    later = timezone.now() + timedelta(seconds=wait)
    step(row, State.PLANNED, error, not_before=later, result=row.result, **values)


def fail(row: OutboxRow, error: str) -> None:
    step(row, State.FAILED, error, done_at=timezone.now(), result=row.result)


def leave_unclear(row: OutboxRow, error: str) -> None:
    step(row, State.UNCLEAR, error, result=row.result)


def step(row: OutboxRow, state: str, error: str, **values: Any) -> None:
    """From where the row was seen; if it has moved on, that stands."""
    same = OutboxRow.objects.filter(pk=row.pk, state=row.state)
    if same.update(state=state, error=error[:1000], **values):
        row.state, row.error = state, error


def perhaps_told(row: OutboxRow) -> bool:
    """It waits to be sent again because an answer was lost."""
    return bool(row.result.get("maybe"))


def withdraw(row: OutboxRow, by: User | None) -> None:
    """What nobody was told yet is not told; a bonus goes with its preparation. Raises RowError."""
    if perhaps_told(row):
        raise RowError(_("The platform may know of it already; the next sending asks."))
    pair = [row.pk, *([row.after_id] if row.after_id else [])]
    pair += OutboxRow.objects.filter(after=row, state=State.PLANNED).values_list("pk", flat=True)
    taken = OutboxRow.objects.filter(pk__in=pair, state=State.PLANNED)
    if row.state != State.PLANNED or not taken.update(
        state=State.WITHDRAWN, done_at=timezone.now(), decided_by=by
    ):
        raise RowError(_("Only what is planned can be withdrawn."))


def retry(row: OutboxRow, by: User | None) -> None:
    """Plan a failed row again, if its money was not paid otherwise meanwhile. Raises RowError."""
    with ledger.holding(row.campaign) as held:
        now = OutboxRow.objects.select_for_update(no_key=True).get(pk=row.pk)
        if now.state != State.FAILED:
            raise RowError(_("Only what failed can be tried again."))
        ledger.settle(held)
        if now.kind in OutboxRow.MONEY and ledger.balance(held, now.worker_id).to_pay < now.amount:
            raise RowError(_("Its money was paid otherwise, or is not owed any more."))
        now.state, now.attempts, now.done_at, now.not_before = State.PLANNED, 0, None, None
        now.planned_by = by or now.planned_by
        now.save(update_fields=["state", "attempts", "done_at", "not_before", "planned_by"])
        if now.after_id and now.after and now.after.state != State.CONFIRMED:
            OutboxRow.objects.filter(pk=now.after_id, state=State.FAILED).update(
                state=State.PLANNED, attempts=0, done_at=None
            )


def resolve(row: OutboxRow, happened: bool, by: User | None) -> None:
    """A person looked at the platform: it happened, or it did not and may be tried again. Raises RowError."""
    if row.state != State.UNCLEAR:
        raise RowError(_("Only what is unclear is decided by hand."))
    if happened:
        confirm(row.pk, {"by_hand": True}, by, of=[State.UNCLEAR])
        return
    OutboxRow.objects.filter(pk=row.pk, state=State.UNCLEAR).update(
        state=State.FAILED,
        error=_("Somebody looked: it did not happen."),
        done_at=timezone.now(),
        decided_by=by,
        result={},
    )


def decide(row: OutboxRow, action: str, by: User | None) -> None:
    """`retry`, `withdraw`, `happened` or `not_happened`. Raises RowError."""
    match action:
        case "retry":
            retry(row, by)
        case "withdraw":
            withdraw(row, by)
        case "happened" | "not_happened":
            resolve(row, action == "happened", by)
        case _:
            raise RowError(_("That cannot be decided about a row."))
