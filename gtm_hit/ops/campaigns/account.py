"""What one worker's work in a campaign came to, in the worker's own eyes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from django.db.models import QuerySet

from gtm_hit.models import Assignment, Campaign, Comment, Worker, WorkerScore
from gtm_hit.ops.pay import own
from gtm_hit.ops.pay.sums import Balance
from gtm_hit.ops.scores import words


@dataclass(frozen=True)
class Account:
    """`score` is a sentence, empty before there is enough; money where there is some, or will be."""

    score: str
    balance: Balance | None
    currency: str
    open_comments: int = 0
    commented: Assignment | None = None  # where the first of them is

    @property
    def says_something(self) -> bool:
        return bool(self.score or self.balance or self.open_comments)


def of(campaign: Campaign, worker: Worker) -> Account:
    score, balance = of_several(worker, [campaign])[campaign.pk]
    waiting = list(open_comments(campaign, worker))
    commented = waiting[0].assignment if waiting else None
    return Account(score, balance, campaign.currency, len(waiting), commented)


def of_several(worker: Worker, campaigns: Iterable[Campaign]) -> dict[int, tuple[str, Balance | None]]:
    """By campaign: the score in words, and the money. As many queries for many as for one."""
    found = list(campaigns)
    rows = WorkerScore.objects.filter(campaign__in=found, worker=worker)
    scores = {row.campaign_id: row for row in rows}
    money = own.money(worker, found)
    return {
        one.pk: (words.for_worker(scores.get(one.pk)), balance_shown(one, money[one.pk])) for one in found
    }


def balance_shown(campaign: Campaign, money: own.Money) -> Balance | None:
    """Nothing is said of money where nothing is paid, nor before anything was submitted."""
    paying = campaign.pay_per_batch or money.balance != Balance()
    return money.balance if paying and money.any else None


def open_comments(campaign: Campaign, worker: Worker) -> QuerySet[Comment]:
    """Remarks on returned work that the worker has not ticked off, along the frames of its batches."""
    found = Comment.objects.filter(assignment__batch__campaign=campaign, assignment__worker=worker)
    found = found.filter(assignment__state=Assignment.State.RETURNED, answers=None, resolved_at=None)
    return found.select_related("assignment__batch").order_by("assignment__batch__number", "frame__number")
