"""Scores as rows. They follow from what is there: computed again, they come out the same."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, replace

from django.db.models import Count, QuerySet
from django.utils import timezone

from gtm_hit.models import Assignment, AssignmentScore, Campaign, Worker, WorkerScore
from gtm_hit.ops.jobs.progress import Steps
from gtm_hit.ops.scores.measuring import SUBMITTED, measure, others
from gtm_hit.scoring.evidence import Evidence
from gtm_hit.scoring.suspicion import Usual, careless, suspicion, usual
from gtm_hit.scoring.worker import PartScore, measured_parts, score


def submitted(campaign: Campaign) -> QuerySet[Assignment]:
    done = Assignment.objects.filter(batch__campaign=campaign, state__in=SUBMITTED)
    return done.select_related("batch__campaign", "layer__dataset", "worker")


def score_assignment(pk: int) -> None:
    """After a submission: this assignment, the copies it is compared with, and their workers."""
    assignment = submitted_one(pk)
    if assignment is None or assignment.batch.campaign is None:
        return
    together = [assignment, *others(assignment).select_related("batch", "layer__dataset", "worker")]
    campaign = assignment.batch.campaign
    counted = {one.pk: measure(one) for one in together}
    known = evidence_of(campaign) | counted
    keep(together, counted, usual(known.values()))
    score_workers(campaign, {one.worker_id for one in together})


def submitted_one(pk: int) -> Assignment | None:
    rows = Assignment.objects.filter(pk=pk, state__in=SUBMITTED)
    return rows.select_related("batch__campaign", "layer__dataset", "worker").first()


def recompute(campaign: Campaign, progress: Steps | None = None) -> int:
    """Everything of a campaign; the number of assignments measured."""
    done = list(submitted(campaign))
    counted: dict[int, Evidence] = {}
    for index, assignment in enumerate(done):
        counted[assignment.pk] = measure(assignment)
        if progress:
            progress(index + 1, len(done))
    keep(done, counted, usual(counted.values()))
    stale = AssignmentScore.objects.filter(assignment__batch__campaign=campaign)
    stale.exclude(assignment__in=counted).delete()
    score_workers(campaign)
    return len(done)


def recompute_all() -> int:
    """Every night: all campaigns in which somebody works or worked; the number of assignments."""
    states = [Campaign.State.OPEN, Campaign.State.PAUSED]
    return sum(recompute(campaign) for campaign in Campaign.objects.filter(state__in=states))


def evidence_of(campaign: Campaign) -> dict[int, Evidence]:
    """By assignment, as it was counted last."""
    rows = AssignmentScore.objects.filter(assignment__batch__campaign=campaign)
    return {pk: Evidence.from_dict(kept) for pk, kept in rows.values_list("assignment_id", "evidence")}


def keep(done: Iterable[Assignment], counted: dict[int, Evidence], usually: Usual) -> None:
    now = timezone.now()
    rows = []
    for assignment in done:
        evidence = counted[assignment.pk]
        found = suspicion(evidence, usually)
        kept = replace(evidence, careless=careless(evidence, usually))
        rows.append(
            AssignmentScore(
                assignment=assignment,
                evidence=kept.as_dict(),
                suspicion=found.value,
                reasons=[asdict(signal) for signal in found.signals],
                computed_at=now,
            )
        )
    AssignmentScore.objects.bulk_create(
        rows,
        update_conflicts=True,
        unique_fields=["assignment"],
        update_fields=["evidence", "suspicion", "reasons", "computed_at"],
        batch_size=500,
    )


def score_workers(campaign: Campaign, only: set[int] | None = None) -> None:
    """Of everybody who ever took a batch of the campaign, or of some."""
    counted: dict[int, list[Evidence]] = {}
    rows = AssignmentScore.objects.filter(assignment__batch__campaign=campaign)
    for worker, kept in rows.values_list("assignment__worker_id", "evidence"):
        counted.setdefault(worker, []).append(Evidence.from_dict(kept))
    dropped = dropped_batches(campaign)
    measured = measured_parts(total(one for several in counted.values() for one in several))
    workers = counted.keys() | dropped.keys()
    if dropped:
        measured |= {"finishing"}
    WorkerScore.objects.filter(campaign=campaign).exclude(worker__in=workers).delete()
    chosen = workers if only is None else workers & only
    rows_made = [
        worker_row(campaign, worker, counted.get(worker, []), dropped.get(worker, 0), measured)
        for worker in sorted(chosen)
    ]
    WorkerScore.objects.bulk_create(
        rows_made,
        update_conflicts=True,
        unique_fields=["campaign", "worker"],
        update_fields=["score", "low", "high", "assignments", "reasons", "computed_at"],
        batch_size=500,
    )


def dropped_batches(campaign: Campaign) -> dict[int, int]:
    """By worker: how many of his batches ran out."""
    over = Assignment.objects.filter(batch__campaign=campaign, state=Assignment.State.EXPIRED)
    return dict(over.order_by().values_list("worker_id").annotate(number=Count("pk")))


def total(several: Iterable[Evidence]) -> Evidence:
    return sum(several, start=Evidence())


def worker_row(
    campaign: Campaign, worker: int, several: list[Evidence], dropped: int, measured: frozenset[str]
) -> WorkerScore:
    found = score(total(several) + Evidence(dropped=dropped), measured)
    return WorkerScore(
        campaign=campaign,
        worker_id=worker,
        score=found.score,
        low=found.low,
        high=found.high,
        assignments=len(several),
        reasons=[reason(part) for part in found.parts],
        computed_at=timezone.now(),
    )


def reason(part: PartScore) -> dict[str, float | str]:
    return {
        "part": part.name,
        "good": part.good,
        "bad": part.bad,
        "score": round(part.score, 1),
        "lost": round(part.lost, 2),
    }


def of_worker(campaign: Campaign, worker: Worker) -> WorkerScore | None:
    return WorkerScore.objects.filter(campaign=campaign, worker=worker).first()
