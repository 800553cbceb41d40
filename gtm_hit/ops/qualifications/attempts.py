"""Tries: a batch for one worker, judged by the known truth when he submits it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django.db import transaction
from django.db.models import QuerySet
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.metrics.annotations import Annotations
from gtm_hit.models import (
    Annotation,
    Assignment,
    Batch,
    Frame,
    Layer,
    Qualification,
    QualificationAttempt,
    Worker,
)
from gtm_hit.ops.qualifications import grants
from gtm_hit.ops.qualifications.managing import QualificationError
from gtm_hit.ops.quality.statistics.numbers import plain
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import expire_all, transition
from gtm_hit.ops.work import assignments
from gtm_hit.scoring import truth
from gtm_hit.scoring.truth import TruthScore

NUMBER = 0  # of their batches: dataset and campaigns count from 1


class NoMoreTries(QualificationError):
    """All tries are used, or the worker has the qualification."""


@dataclass(frozen=True)
class Sides:
    """Both sides of a try in metres, with the rows they came from."""

    truth: Annotations
    found: Annotations
    truth_rows: list[Annotation]
    found_rows: list[Annotation]


def begin(qualification: Qualification, worker: Worker) -> Assignment:
    """The worker's unfinished try, or a new one. Raises NoMoreTries; BusyElsewhere if he has other work."""
    with transaction.atomic():
        Worker.objects.select_for_update(no_key=True).get(pk=worker.pk)
        tried = attempts(qualification, worker)
        unfinished = tried.filter(passed=None).first()
        if unfinished is None:
            require_try(qualification, worker, tried)
        elif unfinished.assignment.editable:
            return unfinished.assignment
        require_free(worker)
        if unfinished is not None:
            return taken_up_again(unfinished.assignment)
        return started(qualification, worker, tried.count() + 1)


def require_free(worker: Worker) -> None:
    """One batch at a time, whatever it is for."""
    mine = Assignment.objects.filter(worker=worker, state=Assignment.State.LEASED)
    expire_all(list(mine.filter(expires_at__lte=timezone.now()).select_for_update(no_key=True)))
    if busy := mine.select_related("batch__dataset", "worker").first():
        raise assignments.BusyElsewhere(busy)


def taken_up_again(assignment: Assignment) -> Assignment:
    """A try whose time ran out is no try lost."""
    locked = Assignment.objects.select_for_update(no_key=True).get(pk=assignment.pk)
    if locked.state == Assignment.State.LEASED:
        locked = transition(locked, Action.EXPIRE, None)
    changes = {"leased_at": timezone.now(), "expires_at": assignments.lease_end(None)}
    return transition(locked, Action.RENEW, locked.worker, changes=changes)


def require_try(qualification: Qualification, worker: Worker, tried: QuerySet[QualificationAttempt]) -> None:
    if qualification.closed_at is not None:
        raise NoMoreTries(_("This qualification is closed."))
    if grants.holds(qualification, worker):
        raise NoMoreTries(_("You have this qualification."))
    if tried.count() >= qualification.tries:
        raise NoMoreTries(_("All %(count)d tries are used.") % {"count": qualification.tries})


def started(qualification: Qualification, worker: Worker, number: int) -> Assignment:
    batch = Batch.with_qualifications.create(
        dataset_id=qualification.dataset_id, qualification=qualification, number=NUMBER
    )
    batch.frames.set(frames_of_try(qualification, number))
    name = f"{qualification.name[:80]}-{worker.pseudonym}-{number}"
    layer = Layer.objects.create(dataset_id=qualification.dataset_id, name=name, kind=Layer.Kind.ASSIGNMENT)
    assignment = Assignment.objects.create(
        batch=batch, worker=worker, layer=layer, expires_at=assignments.lease_end(None)
    )
    QualificationAttempt.objects.create(
        qualification=qualification, worker=worker, assignment=assignment, number=number
    )
    return assignment


def frames_of_try(qualification: Qualification, number: int) -> list[Frame]:
    """The next run: the mistakes of the try before were shown with their truth."""
    frames, size = list(qualification.frames.order_by("number")), qualification.frames_per_try
    run = (number - 1) % max(1, len(frames) // size)
    return frames[run * size : (run + 1) * size]


def attempts(qualification: Qualification, worker: Worker) -> QuerySet[QualificationAttempt]:
    mine = QualificationAttempt.objects.filter(qualification=qualification, worker=worker)
    return mine.select_related("assignment__batch", "qualification__dataset").order_by("-number")


def judge(assignment: Assignment) -> QualificationAttempt | None:
    """Score a submitted try, once; None for ordinary work."""
    found = QualificationAttempt.objects.select_related("qualification__dataset", "qualification__truth")
    attempt = found.filter(assignment=assignment).first() if assignment.batch.qualification_id else None
    if attempt is None or attempt.passed is not None:
        return attempt
    both = sides(attempt)
    score = truth.score(both.truth, both.found)
    attempt.result = as_numbers(score)
    attempt.passed = not failed_marks(attempt.qualification, score)
    attempt.scored_at = timezone.now()
    attempt.save(update_fields=["result", "passed", "scored_at"])
    if attempt.passed:
        grants.passed(attempt)
    return attempt


def sides(attempt: QualificationAttempt) -> Sides:
    frames = Frame.objects.filter(batches=attempt.assignment.batch_id)
    rows = Annotation.objects.filter(frame__in=frames).select_related("frame")
    ordered = rows.order_by("frame__number", "person")
    true = list(ordered.filter(layer=attempt.qualification.truth_id))
    found = list(ordered.filter(layer=attempt.assignment.layer_id))
    grid = attempt.qualification.dataset.grid
    return Sides(in_metres(true, grid), in_metres(found, grid), true, found)


def in_metres(rows: list[Annotation], grid: Any) -> Annotations:
    return Annotations(
        [row.frame.number for row in rows],  # type: ignore[arg-type]
        grid.metres([row.position for row in rows]),
        [row.person for row in rows],  # type: ignore[arg-type]
    )


def as_numbers(score: TruthScore) -> dict[str, Any]:
    """JSON's types only; shares and metres, null where nobody was matched."""
    names = ("recall", "precision", "idf1", "median", "p95", "truth", "found", "matched", "frames")
    return {name: plain(getattr(score, name)) for name in names}


def failed_marks(qualification: Qualification, score: TruthScore) -> list[str]:
    """Names of the pass marks that were not reached. With nobody matched no distance is good enough."""
    reached = {
        "min_recall": score.recall >= qualification.min_recall,
        "min_precision": score.precision >= qualification.min_precision,
        "max_median": score.median <= qualification.max_median or not score.truth,
        "max_p95": score.p95 <= qualification.max_p95 or not score.truth,
        "min_idf1": score.idf1 >= qualification.min_idf1,
    }
    return [name for name, fine in reached.items() if not fine]


@dataclass(frozen=True)
class Mark:
    """One pass mark beside what was reached, in words."""

    label: str
    reached: str
    asked: str
    fine: bool


def marks(attempt: QualificationAttempt) -> list[Mark]:
    """By the marks of today; whether the try passed was decided by those of its time."""
    one, result = attempt.qualification, attempt.result
    shares = [
        (_("people found"), result["recall"], one.min_recall),
        (_("boxes with a person in them"), result["precision"], one.min_precision),
        (_("people under one number"), result["idf1"], one.min_idf1),
    ]
    distances = [
        (_("usual distance from the feet"), result["median"], one.max_median),
        (_("19 of 20 are nearer than"), result["p95"], one.max_p95),
    ]
    return [
        *(
            Mark(label, f"{100 * got:.0f} %", f"≥ {100 * least:.0f} %", got >= least)
            for label, got, least in shares
        ),
        *(distance_mark(*line, bool(result["truth"])) for line in distances),
    ]


def distance_mark(label: str, got: float | None, most: float, anybody: bool) -> Mark:
    reached = "–" if got is None else f"{100 * got:.0f} cm"
    fine = not anybody or (got is not None and got <= most)
    return Mark(label, reached, f"≤ {100 * most:.0f} cm", fine)
