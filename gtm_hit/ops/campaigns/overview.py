"""The numbers of the campaigns' pages, each page with a constant number of queries."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from decimal import Decimal
from typing import Any

from django.db.models import Count, Max, Q, QuerySet, Sum
from django.utils import timezone

from gtm_hit.models import (
    Appeal,
    Assignment,
    Campaign,
    CampaignWorker,
    Dataset,
    LayerFrame,
    OutboxRow,
    StitchConflict,
    Worker,
)
from gtm_hit.ops.pay import table
from gtm_hit.ops.pay.sums import NOTHING
from gtm_hit.ops.scores import listing, words

State = Assignment.State


def campaigns(dataset: Dataset) -> QuerySet[Campaign]:
    """With `batch_count`, `submitted`, `accepted` and `worker_count`."""
    found = "batches__assignments"
    return dataset.campaigns.annotate(
        batch_count=Count("batches", distinct=True),
        submitted=Count(found, Q(batches__assignments__state=State.SUBMITTED), distinct=True),
        accepted=Count(found, Q(batches__assignments__state=State.ACCEPTED), distinct=True),
        worker_count=Count("batches__assignments__worker", distinct=True),
    ).order_by("-created_at")


def working_now(campaign: Campaign, most: int = 20) -> list[Assignment]:
    """Running leases, those saved last first, with `frames_done`, `frames` and `saved_at`."""
    rows = Assignment.objects.filter(
        batch__campaign=campaign, state=State.LEASED, expires_at__gt=timezone.now()
    )
    saved = Max("layer__layer_frames__changed_at")
    done = Count("layer__layer_frames", Q(layer__layer_frames__done=True))
    return list(
        rows.select_related("worker", "batch")
        .annotate(saved_at=saved, frames_done=done)
        .order_by("-saved_at", "-leased_at")[:most]
    )


@dataclass(frozen=True)
class Waiting:
    """What waits for the manager, or happens without them."""

    to_review: int
    returned: int
    appeals: int
    conflicts: int  # of stitching, undecided
    unclear: int  # messages to the platform of which nobody knows what became of them
    invited: int
    blocked: int


def waiting(campaign: Campaign) -> Waiting:
    held = Assignment.objects.filter(batch__campaign=campaign).aggregate(
        submitted=Count("pk", Q(state=State.SUBMITTED)), returned=Count("pk", Q(state=State.RETURNED))
    )
    standing = dict(campaign.workers.values_list("standing").annotate(count=Count("pk")).order_by())
    appeals = Appeal.objects.filter(assignment__batch__campaign=campaign, outcome=Appeal.Outcome.OPEN)
    conflicts = StitchConflict.objects.filter(stitching__campaign=campaign, state=StitchConflict.State.OPEN)
    unclear = OutboxRow.objects.filter(campaign=campaign, state=OutboxRow.State.UNCLEAR)
    return Waiting(
        to_review=held["submitted"],
        returned=held["returned"],
        appeals=appeals.count(),
        conflicts=conflicts.count(),
        unclear=unclear.count(),
        invited=standing.get("invited", 0),
        blocked=standing.get("blocked", 0),
    )


@dataclass(frozen=True)
class Money:
    """`so_far`: accepted batches as the ledger has them, those still undecided, and approved bonuses."""

    so_far: Decimal
    bonuses: int  # that are proposed and wait to be approved
    bonus_total: Decimal


def money(campaign: Campaign) -> Money:
    lines = table.workers(campaign)
    owed = sum((each.balance.owed for each in lines), NOTHING)
    proposed = [each.proposed for each in lines if each.proposed]
    undecided = sum(each.waiting for each in lines)
    return Money(owed + undecided * campaign.pay_per_batch, len(proposed), sum(proposed, NOTHING))


@dataclass(frozen=True)
class WorkerRow:
    worker: Worker
    standing: str  # invited, blocked, or neither
    counts: dict[str, int]  # assignments by state
    frames_done: int
    seconds: int
    last_at: datetime | None
    score: words.Interval | None

    @property
    def batches(self) -> int:
        """Without those that ran out."""
        return sum(count for state, count in self.counts.items() if state != State.EXPIRED)

    @property
    def submitted(self) -> int:
        return sum(self.counts.get(state, 0) for state in ("submitted", "accepted", "returned", "rejected"))

    @property
    def minutes(self) -> float:
        return round(self.seconds / 60, 1)

    @property
    def minutes_per_frame(self) -> float | None:
        return round(self.seconds / 60 / self.frames_done, 2) if self.frames_done else None


def workers(campaign: Campaign, search: str = "") -> QuerySet[Worker]:
    """Whoever took a batch, was invited or blocked; the latest at work first, with `last_at`."""
    mine = Q(assignments__batch__campaign=campaign)
    ids = Assignment.objects.filter(batch__campaign=campaign).values("worker")
    decided = CampaignWorker.objects.filter(campaign=campaign).values("worker")
    found = Worker.objects.filter(Q(pk__in=ids) | Q(pk__in=decided))
    if search:
        found = found.filter(Q(pseudonym__startswith=search) | Q(external_id=search))
    return found.annotate(last_at=Max("assignments__leased_at", filter=mine)).order_by(
        "-last_at", "pseudonym"
    )


def worker_rows(campaign: Campaign, page: Iterable[Any]) -> list[WorkerRow]:
    """Four queries, however many workers."""
    found: Sequence[Any] = list(page)
    ids = [worker.pk for worker in found]
    mine = Assignment.objects.filter(batch__campaign=campaign, worker__in=ids)
    counts: dict[int, dict[str, int]] = {}
    for worker, state, count in mine.order_by().values_list("worker", "state").annotate(count=Count("pk")):
        counts.setdefault(worker, {})[state] = count
    frames = LayerFrame.objects.filter(layer__assignment__in=mine).order_by()
    sums = {
        worker: (done, seconds)
        for worker, done, seconds in frames.values_list("layer__assignment__worker").annotate(
            done_frames=Count("pk", Q(done=True)), total=Sum("seconds")
        )
    }
    scores = listing.by_worker(campaign, ids)
    standing = dict(campaign.workers.filter(worker__in=ids).values_list("worker", "standing"))
    return [
        WorkerRow(
            worker,
            standing.get(worker.pk, ""),
            counts.get(worker.pk, {}),
            *(sums.get(worker.pk, (0, 0))),
            worker.last_at,
            scores.get(worker.pk),
        )
        for worker in found
    ]


def assignments(campaign: Campaign, worker: Worker | None = None) -> QuerySet[Assignment]:
    """The newest first; `with_sums` tells what was done in them."""
    rows = Assignment.objects.filter(batch__campaign=campaign)
    if worker is not None:
        rows = rows.filter(worker=worker)
    return rows.select_related("batch", "worker", "layer").order_by("-leased_at", "-pk")


@dataclass(frozen=True)
class AssignmentRow:
    assignment: Assignment
    frames_done: int
    seconds: int

    @property
    def minutes(self) -> float:
        return round(self.seconds / 60, 1)


def with_sums(found: Iterable[Assignment]) -> list[AssignmentRow]:
    """One query, however many assignments; grouping both tables at once takes three times as long."""
    rows = list(found)
    frames = LayerFrame.objects.filter(layer__in=[one.layer_id for one in rows]).order_by()
    done = Count("pk", Q(done=True))
    sums = {
        layer: (count, seconds)
        for layer, count, seconds in frames.values_list("layer").annotate(d=done, s=Sum("seconds"))
    }
    return [AssignmentRow(one, *sums.get(one.layer_id, (0, 0))) for one in rows]
