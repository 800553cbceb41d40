"""Making qualifications, changing their pass marks, closing them, asking for them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django.contrib.auth.models import User
from django.core.exceptions import ValidationError
from django.db import transaction
from django.db.models import Count, Q, QuerySet
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import (
    Campaign,
    Dataset,
    Frame,
    GoldFrame,
    Layer,
    Qualification,
    QualificationAttempt,
    RequiredQualification,
)
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.gold.truths import frames_known, truths


class QualificationError(OperationError, ValueError):
    """A qualification that cannot be made like this, or not now; says why."""


@dataclass(frozen=True)
class PassMarks:
    min_recall: float = 0.9
    min_precision: float = 0.9
    max_median: float = 0.15  # metres
    max_p95: float = 0.4  # metres
    min_idf1: float = 0.8


@dataclass(frozen=True)
class Order:
    """`first_frame` and those after it that the truth knows: `frames_per_try` for each try."""

    name: str
    truth: Layer
    title: str = ""
    first_frame: int = 0  # number
    frames_per_try: int = 5
    tries: int = 2
    marks: PassMarks = PassMarks()


def create(dataset: Dataset, order: Order, user: User | None = None) -> Qualification:
    """Raises QualificationError; then nothing is made."""
    if order.truth.dataset_id != dataset.pk or not truths(dataset).filter(pk=order.truth.pk).exists():
        raise QualificationError(
            _("%(layer)s is no known truth of this dataset.") % {"layer": order.truth.name}
        )
    made = Qualification(
        dataset=dataset,
        name=order.name,
        title=order.title,
        truth=order.truth,
        frames_per_try=order.frames_per_try,
        tries=order.tries,
        created_by=user,
        **vars(order.marks),
    )
    checked(made)
    frames = chosen_frames(order)
    with transaction.atomic():
        made.save()
        made.frames.set(frames)
    return made


def chosen_frames(order: Order) -> list[Frame]:
    """Fewer runs than tries are enough: later tries take the first ones again. None that is gold."""
    gold = GoldFrame.objects.filter(campaign__dataset=order.truth.dataset_id).values("frame_id")
    known = frames_known(order.truth).filter(number__gte=order.first_frame).exclude(pk__in=gold)
    frames = list(known[: order.frames_per_try * order.tries])
    runs = len(frames) // order.frames_per_try
    if not runs:
        text = _("%(layer)s knows only %(count)d frames from there on that are not gold.")
        raise QualificationError(text % {"layer": order.truth.name, "count": len(frames)})
    return frames[: runs * order.frames_per_try]


def change(qualification: Qualification, marks: PassMarks, tries: int, title: str) -> Qualification:
    """Tries that are judged already stay as they were judged."""
    for name, value in {**vars(marks), "tries": tries, "title": title}.items():
        setattr(qualification, name, value)
    checked(qualification)
    qualification.save()
    return qualification


def checked(qualification: Qualification) -> None:
    try:
        qualification.full_clean(exclude=["truth", "created_by"])
    except ValidationError as error:
        lines = [f"{name}: {' '.join(texts)}" for name, texts in error.message_dict.items()]
        raise QualificationError(" ".join(lines)) from error


def close(qualification: Qualification) -> None:
    """No new tries; what was granted stays."""
    Qualification.objects.filter(pk=qualification.pk, closed_at=None).update(closed_at=timezone.now())


def reopen(qualification: Qualification) -> None:
    Qualification.objects.filter(pk=qualification.pk).update(closed_at=None)


def require(campaign: Campaign, names: list[str]) -> None:
    """A campaign asks for exactly these from now on; raises QualificationError for a name there is not."""
    found = {
        one.name: one for one in Qualification.objects.filter(dataset=campaign.dataset_id, name__in=names)
    }
    if missing := sorted(set(names) - found.keys()):
        raise QualificationError(_("There is no qualification %(name)s.") % {"name": missing[0]})
    with transaction.atomic():
        asked = RequiredQualification.objects.filter(campaign=campaign)
        asked.exclude(qualification__in=found.values()).delete()
        rows = [RequiredQualification(campaign=campaign, qualification=one) for one in found.values()]
        RequiredQualification.objects.bulk_create(rows, ignore_conflicts=True)


def qualifications(dataset: Dataset) -> QuerySet[Qualification, Any]:
    """With `tried`, `passed` and `waiting`: numbers of tries."""
    return (
        Qualification.objects.filter(dataset=dataset)
        .select_related("truth")
        .annotate(
            tried=Count("attempts", filter=Q(attempts__passed__isnull=False)),
            passed=Count("attempts", filter=Q(attempts__passed=True)),
            waiting=Count("attempts", filter=Q(attempts__passed__isnull=True)),
        )
        .order_by("name")
    )


def tries(qualification: Qualification) -> QuerySet[QualificationAttempt]:
    """Newest first, with the worker at hand."""
    mine = QualificationAttempt.objects.filter(qualification=qualification)
    return mine.select_related("worker", "assignment__layer").order_by("-started_at", "-pk")
