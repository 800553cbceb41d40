"""One worker's work in a campaign, as the manager sees it."""

from __future__ import annotations

from dataclasses import dataclass

from django.db.models import QuerySet

from gtm_hit.models import Campaign, Comment, Transition, Worker
from gtm_hit.ops.pay import own
from gtm_hit.ops.pay.sums import Balance
from gtm_hit.ops.quality import together
from gtm_hit.ops.review.machine import DECISIONS
from gtm_hit.ops.scores import computing, words

MOST_DECISIONS = 20
MOST_REMARKS = 20


@dataclass(frozen=True)
class Seen:
    """Score with its reasons, money, what others say who did the same frames, and what reviewers did."""

    score: words.Shown | None
    balance: Balance
    hourly: own.Hourly
    together: together.Together | None
    decisions: list[Transition]  # newest first, as the remarks
    remarks: list[Comment]
    remark_count: int


def seen(campaign: Campaign, worker: Worker) -> Seen:
    balance = own.money(worker, [campaign])[campaign.pk].balance
    written = remarks(campaign, worker)
    return Seen(
        score=words.shown(computing.of_worker(campaign, worker)),
        balance=balance,
        hourly=own.hourly(campaign, worker, balance.owed),
        together=together.of_worker(campaign, worker),
        decisions=list(decisions(campaign, worker)[:MOST_DECISIONS]),
        remarks=list(written[:MOST_REMARKS]),
        remark_count=written.count(),
    )


def decisions(campaign: Campaign, worker: Worker) -> QuerySet[Transition]:
    found = Transition.objects.filter(
        assignment__batch__campaign=campaign, assignment__worker=worker, action__in=sorted(DECISIONS)
    )
    return found.select_related("user", "assignment__batch").order_by("-pk")


def remarks(campaign: Campaign, worker: Worker) -> QuerySet[Comment]:
    """What people wrote, not what programs did, nor the answers."""
    found = Comment.objects.filter(
        assignment__batch__campaign=campaign, assignment__worker=worker, answers=None, user__isnull=False
    )
    return found.select_related("user", "frame", "assignment__batch").order_by("-pk")
