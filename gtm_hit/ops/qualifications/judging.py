"""A submitted try beside the known truth: what came out, and whether that is enough."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.metrics.annotations import Annotations
from gtm_hit.models import Annotation, Assignment, Frame, Qualification, QualificationAttempt
from gtm_hit.ops.qualifications import grants
from gtm_hit.ops.quality.statistics.numbers import plain
from gtm_hit.scoring import truth
from gtm_hit.scoring.truth import TruthScore


@dataclass(frozen=True)
class Sides:
    """Both sides of a try in metres, with the rows they came from."""

    truth: Annotations
    found: Annotations
    truth_rows: list[Annotation]
    found_rows: list[Annotation]


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
