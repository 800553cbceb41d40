"""What is to be told to the platform, written down before it is told. Planning the same again plans nothing.

A platform decides about submissions. One may hold several batches: it is approved when one of them is
accepted, and rejected when all are decided and none was. Its reward is paid with the approval, once; whatever
else is owed to its worker goes as a bonus.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from django.contrib.auth.models import User
from django.db import transaction
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Campaign, OutboxRow, Submission, Worker
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.outbox import rows
from gtm_hit.ops.outbox.platform import require_reason
from gtm_hit.ops.pay import ledger, table

State, Kind = OutboxRow.State, OutboxRow.Kind
Work = Assignment.State
OUTCOMES = {Work.ACCEPTED, Work.RETURNED, Work.REJECTED}
DECISIONS = [Kind.APPROVE, Kind.REJECT]
PLATFORMS = {Campaign.Platform.PROLIFIC}
KNOWN = {Kind.APPROVE: "APPROVED", Kind.REJECT: "REJECTED"}


class PlanError(OperationError):
    """Nothing was planned; the message says why."""


@dataclass(frozen=True)
class Payout:
    """What a worker is to get as a bonus; `to`: a submission of his, else he himself."""

    worker: Worker
    to: str
    is_submission: bool
    amount: Decimal


def plan_decision(
    assignment: Assignment,
    outcome: str,
    *,
    message: str = "",
    category: str = "",
    by: User | None = None,
) -> OutboxRow | None:
    """What the platform is to be told after a decision; nothing where platforms decide nothing.

    For whoever has just written the assignment's new state, in the same transaction. Work that is returned
    with comments is mended under the same submission, so nothing is told and what was planned is withdrawn.
    Raises Refused when the platform would not take this reason.
    """
    if outcome not in OUTCOMES:
        raise PlanError(f"{outcome!r} is no outcome")
    campaign = assignment.batch.campaign
    if campaign is None:
        return None
    with ledger.holding(campaign) as held:
        ledger.settle(held)
        if held.platform not in PLATFORMS or not assignment.submission:
            return None
        reason = {"message": message, "category": category.upper()} if outcome == Work.REJECTED else {}
        return decide(held, assignment, reason, by)


def decide(
    campaign: Campaign, assignment: Assignment, reason: dict[str, str], by: User | None
) -> OutboxRow | None:
    """Bring what is planned for the assignment's submission in line with what became of its batches."""
    wanted, speaker = wanted_decision(campaign, assignment)
    planned = OutboxRow.objects.filter(campaign=campaign, key=f"decision:{assignment.submission}").exclude(
        state=State.WITHDRAWN
    )
    before = planned.select_for_update(no_key=True).first()
    told = before and (before.state != State.PLANNED or rows.perhaps_told(before))
    if before and (before.kind == wanted or told):
        return before if before.kind == wanted else None  # told already: platforms don't take it back
    if before:
        rows.withdraw(before, by)
    if wanted is None or (wanted == Kind.REJECT and not reason):
        return None
    if wanted == Kind.REJECT:
        require_reason(reason["message"], reason["category"])
    return planned_decision(campaign, speaker, wanted, reason if wanted == Kind.REJECT else {}, by)


def wanted_decision(campaign: Campaign, assignment: Assignment) -> tuple[str | None, Assignment]:
    """What the submission deserves, and the batch that speaks for it."""
    batches = Assignment.objects.filter(
        batch__campaign=campaign, worker=assignment.worker_id, submission=assignment.submission
    ).order_by("pk")
    by_state: dict[str, Assignment] = {}
    for each in batches:
        by_state.setdefault(each.state, each)
    if Work.ACCEPTED in by_state:
        return Kind.APPROVE, by_state[Work.ACCEPTED]
    if by_state.keys() & set(Assignment.HOLDING) or Work.REJECTED not in by_state:
        return None, assignment
    return Kind.REJECT, by_state[Work.REJECTED]


def planned_decision(
    campaign: Campaign, assignment: Assignment, kind: str, payload: dict[str, str], by: User | None
) -> OutboxRow:
    pays = ledger.earned_by_assignment(campaign).get(assignment.pk) or Decimal(0)
    row = OutboxRow.objects.create(
        campaign=campaign,
        kind=kind,
        key=f"decision:{assignment.submission}",
        worker_id=assignment.worker_id,
        assignment=assignment,
        submission=assignment.submission,
        amount=pays if kind == Kind.APPROVE else 0,
        payload=payload,
        planned_by=by,
    )
    told = Submission.objects.filter(campaign=campaign, submission=row.submission).first()
    if told and told.status == KNOWN[Kind(kind)]:
        rows.confirm(row.pk, {"status": told.status})
        row.refresh_from_db()
    return row


def plan_missing(campaign: Campaign, by: User | None) -> list[OutboxRow]:
    """Approvals of what was accepted and never told; for callers that hold the campaign."""
    if campaign.platform not in PLATFORMS:
        return []
    told = OutboxRow.objects.filter(campaign=campaign, kind__in=DECISIONS).exclude(state=State.WITHDRAWN)
    left = ledger.accepted(campaign).exclude(submission="")
    left = left.exclude(submission__in=told.values("submission")).order_by("pk")
    one_each = {each.submission: each for each in left}
    found = (decide(campaign, each, {}, by) for each in one_each.values())
    return [row for row in found if row]


def payouts(campaign: Campaign, only: Iterable[str] | None = None) -> list[Payout]:
    """Whom the platform would be asked to pay how much: what is owed, not paid and not on its way."""
    chosen = None if only is None else set(only)
    due = [
        each
        for each in table.workers(campaign)
        if each.balance.to_pay and (chosen is None or each.worker.pseudonym in chosen)
    ]
    addresses = submissions_of(campaign, [each.worker.pk for each in due])
    return [
        Payout(
            each.worker,
            addresses.get(each.worker.pk, each.worker.external_id),
            each.worker.pk in addresses,
            each.balance.to_pay,
        )
        for each in due
    ]


def submissions_of(campaign: Campaign, workers: list[int]) -> dict[int, str]:
    """A submission each: the newest, of accepted work if there is any."""
    done = Assignment.objects.filter(batch__campaign=campaign, worker__in=workers).exclude(submission="")
    found = done.order_by("pk").values_list("worker_id", "state", "submission")
    accepted = {worker: submission for worker, state, submission in found if state == Work.ACCEPTED}
    return {worker: submission for worker, _state, submission in found} | accepted


def plan_payouts(campaign: Campaign, by: User | None, only: Iterable[str] | None = None) -> list[OutboxRow]:
    """Rows that pay what `payouts` lists, after the approvals that pay their part. Raises PlanError."""
    if campaign.platform not in PLATFORMS:
        raise PlanError(_("This platform pays nobody: pay by hand and mark it as paid."))
    with ledger.holding(campaign) as held:
        ledger.settle(held)
        plan_missing(held, by)
        return [planned_bonus(held, each, by) for each in payouts(held, only)]


def preview(campaign: Campaign, only: Iterable[str] | None = None) -> list[OutboxRow]:
    """The dry run: what `plan_payouts` would plan, by planning it and taking it back. Raises PlanError."""
    with transaction.atomic():
        planned = plan_payouts(campaign, None, only)
        approvals = OutboxRow.objects.filter(campaign=campaign, state=State.PLANNED, kind__in=DECISIONS)
        found = [*approvals.select_related("worker"), *planned]
        transaction.set_rollback(True)
    return found


def planned_bonus(campaign: Campaign, payout: Payout, by: User | None) -> OutboxRow:
    earlier = OutboxRow.objects.filter(campaign=campaign, worker=payout.worker, kind=Kind.BONUS_PAY).count()
    values: dict[str, Any] = {
        "campaign": campaign,
        "worker": payout.worker,
        "submission": payout.to,
        "payload": {"is_submission": payout.is_submission, "bonus": str(payout.amount)},
        "planned_by": by,
    }
    name = f"{payout.worker.pk}:{earlier + 1}"
    setup = OutboxRow.objects.create(kind=Kind.BONUS_SETUP, key=f"bonus_setup:{name}", **values)
    return OutboxRow.objects.create(
        kind=Kind.BONUS_PAY, key=f"bonus_pay:{name}", amount=payout.amount, after=setup, **values
    )
