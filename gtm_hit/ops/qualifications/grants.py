"""Who has a qualification: the newest row says it."""

from __future__ import annotations

from django.contrib.auth.models import User
from django.db.models import OuterRef, QuerySet, Subquery
from django.utils.translation import gettext as _

from gtm_hit.models import Qualification, QualificationAttempt, QualificationGrant, Worker
from gtm_hit.ops.qualifications.managing import QualificationError


def worker_named(pseudonym: str) -> Worker:
    """Of whatever platform: who comes to qualify need not have worked here. Raises QualificationError."""
    # PostgreSQL has no strings with a zero byte and fails instead of finding nothing.
    found = None if "\x00" in pseudonym else Worker.objects.filter(pseudonym=pseudonym).first()
    if found is None:
        raise QualificationError(_("There is no worker %(name)s.") % {"name": pseudonym})
    return found


def grant(qualification: Qualification, worker: Worker, by: User | None, why: str = "") -> QualificationGrant:
    """By hand; once: whoever has it already keeps the grant he has."""
    if (before := newest(qualification, worker)) and before.granted:
        return before
    return QualificationGrant.objects.create(
        qualification=qualification, worker=worker, granted=True, by=by, why=why
    )


def revoke(qualification: Qualification, worker: Worker, by: User | None, why: str) -> QualificationGrant:
    """Raises QualificationError without a reason, or where there is nothing to take away."""
    if not why.strip():
        raise QualificationError(_("Say why: the worker may ask."))
    before = newest(qualification, worker)
    if before is None or not before.granted:
        text = _("%(worker)s does not have %(name)s.")
        raise QualificationError(text % {"worker": worker.pseudonym, "name": qualification.name})
    return QualificationGrant.objects.create(
        qualification=qualification, worker=worker, granted=False, by=by, why=why.strip()
    )


def passed(attempt: QualificationAttempt) -> None:
    QualificationGrant.objects.create(
        qualification=attempt.qualification, worker=attempt.worker, granted=True, attempt=attempt
    )


def newest(qualification: Qualification, worker: Worker) -> QualificationGrant | None:
    return QualificationGrant.objects.filter(qualification=qualification, worker=worker).first()


def holds(qualification: Qualification, worker: Worker) -> bool:
    found = newest(qualification, worker)
    return found is not None and found.granted


def standing(qualification: Qualification) -> QuerySet[QualificationGrant]:
    """The newest row of every worker who ever had it, with worker and user at hand."""
    rows = QualificationGrant.objects.filter(qualification=qualification)
    same = rows.filter(worker=OuterRef("worker")).order_by("-pk").values("pk")[:1]
    return rows.filter(pk=Subquery(same)).select_related("worker", "by", "attempt").order_by("-pk")
