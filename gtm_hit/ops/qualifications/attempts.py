"""Tries: a batch for one worker, out of the frames of a qualification."""

from __future__ import annotations

from django.db import transaction
from django.db.models import QuerySet
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import (
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
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import expire_all, transition
from gtm_hit.ops.work import assignments, leases

NUMBER = 0  # of their batches: dataset and campaigns count from 1


class NoMoreTries(QualificationError):
    """All tries are used, or the worker has the qualification."""


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
    changes = {"leased_at": timezone.now(), "expires_at": leases.lease_end(None)}
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
        batch=batch, worker=worker, layer=layer, expires_at=leases.lease_end(None)
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
