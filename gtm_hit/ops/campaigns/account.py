"""What one worker's work in a campaign came to: in the worker's own eyes, and in the manager's."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from django.db.models import QuerySet

from gtm_hit.models import Assignment, Campaign, Comment, Transition, Worker
from gtm_hit.ops.pay import ledger
from gtm_hit.ops.pay.sums import Balance, bonus_to_floor, per_hour
from gtm_hit.ops.pay.table import seconds_by_worker
from gtm_hit.ops.review.machine import DECISIONS
from gtm_hit.ops.scores import computing, words

MOST_DECISIONS = 20


@dataclass(frozen=True)
class Account:
    """For the worker. `score` is a sentence, empty before there is enough; money where the campaign pays."""

    score: str
    balance: Balance | None
    currency: str
    open_comments: int


def of(campaign: Campaign, worker: Worker) -> Account:
    return Account(
        score=words.for_worker(computing.of_worker(campaign, worker)),
        balance=ledger.balance(campaign, worker.pk) if campaign.pay_per_batch else None,
        currency=campaign.currency,
        open_comments=open_comments(campaign, worker),
    )


def open_comments(campaign: Campaign, worker: Worker) -> int:
    """Remarks on returned work that the worker has not ticked off."""
    found = Comment.objects.filter(assignment__batch__campaign=campaign, assignment__worker=worker)
    return found.filter(assignment__state=Assignment.State.RETURNED, answers=None, resolved_at=None).count()


@dataclass(frozen=True)
class Seen:
    """For the manager: score with its reasons, money, and what was decided about the work, newest first."""

    score: words.Shown | None
    balance: Balance
    per_hour: Decimal | None
    proposed: Decimal
    decisions: list[Transition]
    comments: int


def seen(campaign: Campaign, worker: Worker) -> Seen:
    balance = ledger.balance(campaign, worker.pk)
    seconds = seconds_by_worker(campaign).get(worker.pk, (0.0, 0.0))[0]
    return Seen(
        score=words.shown(computing.of_worker(campaign, worker)),
        balance=balance,
        per_hour=per_hour(balance.owed, seconds),
        proposed=bonus_to_floor(balance.owed, seconds, campaign.hourly_floor),
        decisions=list(decisions(campaign, worker)[:MOST_DECISIONS]),
        comments=Comment.objects.filter(
            assignment__batch__campaign=campaign, assignment__worker=worker, answers=None
        ).count(),
    )


def decisions(campaign: Campaign, worker: Worker) -> QuerySet[Transition]:
    found = Transition.objects.filter(
        assignment__batch__campaign=campaign, assignment__worker=worker, action__in=sorted(DECISIONS)
    )
    return found.select_related("user", "assignment__batch").order_by("-pk")
