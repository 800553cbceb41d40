"""Workers of a campaign by their scores."""

from __future__ import annotations

from collections.abc import Iterable

from django.db.models import QuerySet

from gtm_hit.models import Campaign, WorkerScore
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.scores import computing
from gtm_hit.ops.scores.words import Interval

MOST_AT_ONCE = 300  # assignments that are measured while somebody waits


class TooMuch(OperationError):
    """So much work that it is left to the night, or to the command."""


def workers(campaign: Campaign) -> QuerySet[WorkerScore]:
    """Lowest first, with the worker at hand."""
    rows = WorkerScore.objects.filter(campaign=campaign).select_related("worker")
    return rows.order_by("score", "worker__pseudonym")


def by_worker(campaign: Campaign, workers: Iterable[int]) -> dict[int, Interval]:
    rows = WorkerScore.objects.filter(campaign=campaign, worker__in=list(workers))
    values = rows.values_list("worker", "score", "low", "high")
    return {worker: Interval(*(round(value) for value in three)) for worker, *three in values}


def recompute_now(campaign: Campaign) -> int:
    """Raises TooMuch."""
    count = computing.submitted(campaign).count()
    if count > MOST_AT_ONCE:
        raise TooMuch(f"{count} assignments are measured every night; `manage.py scores` does it at once.")
    return computing.recompute(campaign)
