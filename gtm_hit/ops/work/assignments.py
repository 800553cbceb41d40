"""Leases: who gets which batch, until when, and what ends it. The database decides who was first.

Locks are taken in one order: worker, batch, assignment, frame. They are `no_key`, because full ones
also block PostgreSQL's checks of foreign keys at the end of other transactions.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import Any

from django.conf import settings
from django.db import IntegrityError, transaction
from django.db.models import Count, Exists, F, OuterRef, Q, QuerySet, Sum
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Batch, Dataset, Frame, Layer, Save, Worker
from gtm_hit.models.work import completion_code
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.work import unsaved_leases

State = Assignment.State

# Each failed try means that somebody else got the batch, so tries end when the batches do.
MAX_TRIES = 200


class AssignmentError(OperationError):
    pass


class NoFreeBatch(AssignmentError):
    """Every batch this worker could take is held or was his already."""


class BusyElsewhere(AssignmentError):
    """The worker has an unfinished batch of another dataset."""

    def __init__(self, assignment: Assignment) -> None:
        super().__init__(f"{assignment.worker} still works on {assignment.batch}")
        self.assignment = assignment


class ReadOnly(AssignmentError):
    """The layer may not be changed now; `reason` is `submitted`, `expired`, `not_author` or `protected`."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class Unfinished(AssignmentError):
    """Frames of the batch that are not done on the server's record."""

    def __init__(self, frames: list[int]) -> None:
        super().__init__(f"frames not done: {frames}")
        self.frames = frames


def lease_end() -> datetime:
    return timezone.now() + timedelta(minutes=settings.LEASE_MINUTES)


def first_lease_end() -> datetime:
    """Until something is saved; then `extend` gives the whole time."""
    return timezone.now() + timedelta(minutes=min(settings.FIRST_SAVE_MINUTES, settings.LEASE_MINUTES))


def expire_leases(now: datetime | None = None) -> int:
    """Return overdue batches to the pool; the number of leases that ended."""
    overdue = Assignment.objects.filter(state=State.LEASED, expires_at__lte=now or timezone.now())
    with transaction.atomic():
        # Whoever else is ending one of these leases at this moment must not be waited for: two who
        # wait for each other are a deadlock.
        ended = list(overdue.select_for_update(no_key=True, skip_locked=True).values_list("pk", flat=True))
        return Assignment.objects.filter(pk__in=ended).update(state=State.EXPIRED) if ended else 0


def running() -> QuerySet[Assignment]:
    """Leases that have not run out: a row may say `leased` for a moment longer than it is true."""
    return Assignment.objects.filter(state=State.LEASED, expires_at__gt=timezone.now())


def current(worker: Worker, dataset: Dataset) -> Assignment | None:
    """What the worker has to do in the dataset now: returned work first, then the running lease."""
    mine = Assignment.objects.filter(worker=worker, batch__dataset=dataset).select_related("batch")
    returned = mine.filter(state=State.RETURNED).first()
    return returned or running().filter(pk__in=mine).select_related("batch").first()


def claim(worker: Worker, dataset: Dataset, address: str = "") -> Assignment:
    """The worker's running lease, else his expired batch if it is still free, else the next free batch.

    `address` is where the request came from. Raises NoFreeBatch, BusyElsewhere or TooManyUnsaved.
    """
    for _attempt in range(MAX_TRIES):
        # In a transaction of its own: one that ends leases and then waits for a batch blocks whoever
        # is about to take that batch.
        expire_leases()
        try:
            with transaction.atomic():
                return claim_once(worker, dataset, address)
        except IntegrityError:
            continue
    raise NoFreeBatch(f"{dataset}: no batch for {worker} after {MAX_TRIES} tries")


def claim_once(worker: Worker, dataset: Dataset, address: str) -> Assignment:
    # Two tabs of one worker queue here, so that neither holds a second batch even for a moment.
    Worker.objects.select_for_update(no_key=True).get(pk=worker.pk)
    if held := current(worker, dataset):
        return held
    elsewhere = running().filter(worker=worker).exclude(batch__dataset=dataset)
    if other := elsewhere.select_related("batch__dataset").first():
        raise BusyElsewhere(other)
    if own := regained(worker, dataset, address):
        return own
    unsaved_leases.require_room(worker, dataset, address)
    # Skipping what others are about to take (SQLite has one writer at a time anyway).
    batch = free_batches(worker, dataset).select_for_update(no_key=True, skip_locked=True).first()
    if batch is None:
        raise NoFreeBatch(f"{dataset}: no batch for {worker}")
    return lease(batch, worker, address)


def holding(batch: OuterRef) -> Exists:
    """Whether somebody has the batch; leases past their end don't count."""
    held = Assignment.objects.filter(batch=batch, state__in=Assignment.HOLDING)
    return Exists(held.exclude(state=State.LEASED, expires_at__lte=timezone.now()))


def free_batches(worker: Worker, dataset: Dataset) -> QuerySet[Batch]:
    """Batches nobody holds, of numbers this worker has never had, first copies first."""
    had = Assignment.objects.filter(worker=worker, batch__dataset=dataset).values("batch__number")
    free = Batch.objects.filter(~holding(OuterRef("pk")), dataset=dataset).exclude(number__in=had)
    return free.order_by("copy", "number")


def own_expired(worker: Worker, dataset: Dataset) -> QuerySet[Assignment]:
    """The worker's assignments that ran out and whose batches are still free, newest first."""
    mine = Assignment.objects.filter(worker=worker, batch__dataset=dataset)
    over = mine.filter(state__in=[State.EXPIRED, State.LEASED], expires_at__lte=timezone.now())
    over = over.filter(batch__qualification=None)
    return over.filter(~holding(OuterRef("batch"))).select_related("batch")


def work_left(worker: Worker, dataset: Dataset) -> bool:
    """Whether `claim` would find something; nothing is taken."""
    return own_expired(worker, dataset).exists() or free_batches(worker, dataset).exists()


def finished(worker: Worker, dataset: Dataset) -> QuerySet[Assignment]:
    """What the worker submitted, newest first."""
    mine = Assignment.objects.filter(worker=worker, batch__dataset=dataset, submitted_at__isnull=False)
    mine = mine.filter(batch__qualification=None)
    return mine.select_related("batch__dataset", "layer").order_by("-submitted_at")


def regained(worker: Worker, dataset: Dataset, address: str) -> Assignment | None:
    """The worker's newest expired assignment, leased again with all its work."""
    own = own_expired(worker, dataset).first()
    if own is None:
        return None
    # The same lock as for a free batch: whoever is about to take it is let through first.
    Batch.objects.select_for_update(no_key=True).get(pk=own.batch_id)
    changes: dict[str, Any] = {"state": State.LEASED, "leased_at": timezone.now(), "expires_at": lease_end()}
    if not Save.objects.filter(layer_frame__layer=own.layer_id, worker__isnull=False).exists():
        unsaved_leases.require_room(worker, dataset, address)
        changes |= {"expires_at": first_lease_end(), "takes": F("takes") + 1}
        changes["address"] = unsaved_leases.kept(address)
    if not own_expired(worker, dataset).filter(pk=own.pk).update(**changes):
        return None
    own.refresh_from_db()
    return own


def lease(batch: Batch, worker: Worker, address: str) -> Assignment:
    name = f"batch-{batch.number:04d}-{worker.pseudonym}"
    layer = Layer.objects.create(dataset_id=batch.dataset_id, name=name, kind=Layer.Kind.ASSIGNMENT)
    end, origin = first_lease_end(), unsaved_leases.kept(address)
    made = Assignment.objects.create(batch=batch, worker=worker, layer=layer, expires_at=end, address=origin)
    begun(made)
    return made


def begun(assignment: Assignment) -> None:
    if assignment.batch.campaign_id is None:
        return
    # Whoever fills assignments reads and writes frames, which know of assignments.
    from gtm_hit.ops.gold import starting

    starting.prepare(assignment)


def locked_for_layer(layer: Layer) -> Assignment | None:
    if layer.kind != Layer.Kind.ASSIGNMENT:
        return None
    return Assignment.objects.select_for_update(no_key=True).filter(layer=layer).first()


def require_editable(layer: Layer, assignment: Assignment | None, worker: Worker | None) -> None:
    """A worker's layer is changed by that worker only, and only while he holds the batch."""
    if layer.kind != Layer.Kind.ASSIGNMENT and worker is None:
        return
    if assignment is None or worker is None or assignment.worker_id != worker.pk:
        raise ReadOnly("not_author")
    if reason := read_only_reason(assignment):
        raise ReadOnly(reason)


def read_only_reason(assignment: Assignment) -> str:
    """Why the assignment's layer may not be changed now; empty when it may."""
    if assignment.editable:
        return ""
    return "expired" if assignment.state in {State.LEASED, State.EXPIRED} else "submitted"


def explained(reason: str) -> str:
    """A `read_only_reason` in plain words; empty for empty."""
    texts = {
        "submitted": _("This batch is submitted; it can be looked at, not changed."),
        "expired": _("The time for this batch has run out. Open your start page to continue with it."),
        "protected": _("Imported, hidden and released layers are changed by staff at the browser only."),
        "not_author": _("A worker's annotations are changed by that worker only."),
    }
    return texts.get(reason, reason)


def extend(assignment: Assignment) -> None:
    """Activity keeps a lease alive."""
    Assignment.objects.filter(pk=assignment.pk, state=State.LEASED).update(expires_at=lease_end())


def submit(assignment: Assignment) -> Assignment:
    """End the work and give its code; again: the same code. Raises Unfinished or ReadOnly."""
    with transaction.atomic():
        locked = Assignment.objects.select_for_update(no_key=True).get(pk=assignment.pk)
        if locked.state in {State.SUBMITTED, State.ACCEPTED, State.REJECTED}:
            return locked
        if reason := read_only_reason(locked):
            raise ReadOnly(reason)
        if missing := unfinished_frames(locked):
            raise Unfinished(missing)
        locked.state = State.SUBMITTED
        locked.submitted_at = timezone.now()
        locked.code = locked.code or completion_code()
        locked.save(update_fields=["state", "submitted_at", "code"])
        submitted(locked)
        return locked


def submitted(assignment: Assignment) -> None:
    if assignment.batch.campaign_id is None and assignment.batch.qualification_id is None:
        return
    from gtm_hit.ops.gold import submission

    submission.submitted(assignment)


def done_frames(assignment: Assignment) -> list[int]:
    """Numbers of the batch's frames that are done on the server's record."""
    done = Frame.objects.filter(
        batches=assignment.batch_id, layer_frames__layer=assignment.layer_id, layer_frames__done=True
    )
    return list(done.order_by("number").values_list("number", flat=True))


def unfinished_frames(assignment: Assignment) -> list[int]:
    frames = Frame.objects.filter(batches=assignment.batch_id).exclude(number__in=done_frames(assignment))
    return list(frames.order_by("number").values_list("number", flat=True))


def summary(assignment: Assignment) -> dict[str, Any]:
    """What the worker did: frames, people per frame, active minutes."""
    frames = Frame.objects.filter(batches=assignment.batch_id).order_by("number")
    people = Count("annotations", filter=Q(annotations__layer=assignment.layer_id))
    counts = dict(frames.annotate(people=people).values_list("number", "people"))
    seconds = assignment.layer.layer_frames.aggregate(total=Sum("seconds"))["total"] or 0
    return {
        "batch": str(assignment.batch),
        "frames": [{"number": number, "people": count} for number, count in counts.items()],
        "annotations": sum(counts.values()),
        "minutes": round(seconds / 60, 1),
        "submitted_at": assignment.submitted_at,
    }
