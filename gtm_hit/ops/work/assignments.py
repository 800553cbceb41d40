"""Leases: who gets which batch, until when, and what ends it. The database decides who was first.

Locks are taken in one order: worker, batch, assignment, frame. They are `no_key`, because full ones
also block PostgreSQL's checks of foreign keys at the end of other transactions.
"""

from __future__ import annotations

from datetime import datetime
from typing import Any

from django.db import IntegrityError, transaction
from django.db.models import Count, Exists, OuterRef, Q, QuerySet, Sum
from django.utils import timezone

from gtm_hit.models import Assignment, Batch, Frame, Layer, Save, Submission, Worker
from gtm_hit.ops.campaigns import entry_rules
from gtm_hit.ops.gold import starting
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import expire_all, transition
from gtm_hit.ops.work import unsaved_leases
from gtm_hit.ops.work.leases import first_lease_end, lease_end
from gtm_hit.ops.work.pools import Place, Pool, pool_of
from gtm_hit.ops.work.readiness import AssignmentError as AssignmentError
from gtm_hit.ops.work.readiness import ReadOnly as ReadOnly
from gtm_hit.ops.work.readiness import Unfinished as Unfinished
from gtm_hit.ops.work.readiness import done_frames as done_frames
from gtm_hit.ops.work.readiness import explained as explained
from gtm_hit.ops.work.readiness import read_only_reason as read_only_reason
from gtm_hit.ops.work.readiness import unfinished_frames as unfinished_frames

State = Assignment.State

# Each failed try means that somebody else got the batch, so tries end when the batches do.
MAX_TRIES = 200


class NoFreeBatch(AssignmentError):
    """Every batch this worker could take is held or was his already."""


class BusyElsewhere(AssignmentError):
    """The worker has an unfinished batch of another dataset."""

    def __init__(self, assignment: Assignment) -> None:
        super().__init__(f"{assignment.worker} still works on {assignment.batch}")
        self.assignment = assignment


def expire_leases(now: datetime | None = None) -> int:
    """Return overdue batches to the pool; the number of leases that ended."""
    overdue = Assignment.objects.filter(state=State.LEASED, expires_at__lte=now or timezone.now())
    with transaction.atomic():
        # Whoever else is ending one of these leases at this moment must not be waited for: two who
        # wait for each other are a deadlock.
        return expire_all(list(overdue.select_for_update(no_key=True, skip_locked=True)))


def running() -> QuerySet[Assignment]:
    """Leases that have not run out: a row may say `leased` for a moment longer than it is true."""
    return Assignment.objects.filter(state=State.LEASED, expires_at__gt=timezone.now())


def current(worker: Worker, place: Place) -> Assignment | None:
    """What the worker has to do here now: returned work first, then the running lease that ends first."""
    return next(iter(held(worker, pool_of(place))), None)


def held(worker: Worker, pool: Pool) -> list[Assignment]:
    """All the worker has to do here now."""
    mine = pool.mine(worker).select_related("batch__campaign")
    returned = list(mine.filter(state=State.RETURNED))
    return returned + list(mine.filter(pk__in=running()).order_by("expires_at"))


def room_for_another(worker: Worker, place: Place) -> bool:
    """Whether he may hold one more beside those he holds."""
    pool = pool_of(place)
    return len(held(worker, pool)) < pool.batches_at_once


def claim(worker: Worker, place: Place, address: str = "", another: bool = False) -> Assignment:
    """The worker's running lease, else his expired batch if it is still free, else the next free batch.

    `address` is where the request came from; `another` asks for one more beside those he holds. Raises
    NoFreeBatch, BusyElsewhere, TooManyUnsaved, or NotAdmitted when a campaign's rules give him none.
    """
    pool = pool_of(place)
    for _attempt in range(MAX_TRIES):
        # In a transaction of its own: one that ends leases and then waits for a batch blocks whoever
        # is about to take that batch.
        expire_leases()
        try:
            with transaction.atomic():
                return claim_once(worker, pool, address, another)
        except IntegrityError:
            continue
    raise NoFreeBatch(f"{pool.dataset}: no batch for {worker} after {MAX_TRIES} tries")


def claim_once(worker: Worker, pool: Pool, address: str, another: bool) -> Assignment:
    # Two tabs of one worker queue here, so that neither holds more than may be held even for a moment.
    Worker.objects.select_for_update(no_key=True).get(pk=worker.pk)
    mine = held(worker, pool)
    if mine and not (another and len(mine) < pool.batches_at_once):
        return mine[0]
    require_admitted(worker, pool)
    if own := regained(worker, pool, address):
        return own
    unsaved_leases.require_room(worker, pool.dataset, address)
    # Skipping what others are about to take (SQLite has one writer at a time anyway).
    batch = free_batches(worker, pool).select_for_update(no_key=True, skip_locked=True).first()
    if batch is None:
        raise NoFreeBatch(f"{pool.dataset}: no batch for {worker}")
    batch.campaign = pool.campaign
    return lease(batch, worker, address, pool.submission)


def require_admitted(worker: Worker, pool: Pool) -> None:
    """Raises NotAdmitted, BusyElsewhere, or NoFreeBatch when the submission is over."""
    if pool.campaign is None:
        elsewhere = running().filter(worker=worker, batch__campaign=None).exclude(batch__dataset=pool.dataset)
        if other := elsewhere.select_related("batch__dataset").first():
            raise BusyElsewhere(other)
    elif refusal := entry_rules.refusal(pool.campaign, worker):
        raise entry_rules.NotAdmitted(refusal)
    if is_over(worker, pool):
        raise NoFreeBatch(f"{pool.dataset}: submission {pool.submission} had its batch or was given back")


def is_over(worker: Worker, pool: Pool) -> bool:
    """Whether nothing can be handed in under the seat's submission any more, so that nobody works unpaid."""
    if not pool.submission:
        return False
    returned = Submission.objects.filter(
        campaign=pool.campaign, submission=pool.submission, status=Submission.RETURNED
    )
    return pool.mine(worker).filter(submitted_at__isnull=False).exists() or returned.exists()


def holding(batch: OuterRef) -> Exists:
    """Whether somebody has the batch; leases past their end don't count."""
    held = Assignment.objects.filter(batch=batch, state__in=Assignment.HOLDING)
    return Exists(held.exclude(state=State.LEASED, expires_at__lte=timezone.now()))


def free_batches(worker: Worker, place: Place) -> QuerySet[Batch]:
    """Batches nobody holds, of numbers this worker has never had, first copies first."""
    pool = pool_of(place)
    had = pool.all_of(worker).values("batch__number")
    free = pool.batches().filter(~holding(OuterRef("pk"))).exclude(number__in=had)
    return free.order_by("copy", "number")


def own_expired(worker: Worker, place: Place) -> QuerySet[Assignment]:
    """The worker's assignments that ran out and whose batches are still free, newest first."""
    mine = pool_of(place).mine(worker)
    over = mine.filter(state__in=[State.EXPIRED, State.LEASED], expires_at__lte=timezone.now())
    over = over.filter(batch__qualification=None)
    return over.filter(~holding(OuterRef("batch"))).select_related("batch")


def work_left(worker: Worker, place: Place) -> bool:
    """Whether `claim` would find something; nothing is taken."""
    pool = pool_of(place)
    if is_over(worker, pool) or (pool.campaign and entry_rules.refusal(pool.campaign, worker)):
        return False
    return own_expired(worker, pool).exists() or free_batches(worker, pool).exists()


def finished(worker: Worker, place: Place) -> QuerySet[Assignment]:
    """What the worker submitted, newest first."""
    mine = pool_of(place).mine(worker).filter(submitted_at__isnull=False, batch__qualification=None)
    return mine.select_related("batch__dataset", "batch__campaign", "layer").order_by("-submitted_at")


def regained(worker: Worker, pool: Pool, address: str) -> Assignment | None:
    """The worker's newest expired assignment, leased again with all its work."""
    own = own_expired(worker, pool).first()
    if own is None:
        return None
    # The same lock as for a free batch: whoever is about to take it is let through first.
    Batch.objects.select_for_update(no_key=True).get(pk=own.batch_id)
    changes: dict[str, Any] = {"leased_at": timezone.now(), "expires_at": lease_end(pool.campaign)}
    if not Save.objects.filter(layer_frame__layer=own.layer_id, worker__isnull=False).exists():
        unsaved_leases.require_room(worker, pool.dataset, address)
        changes |= {"expires_at": first_lease_end(pool.campaign), "takes": own.takes + 1}
        changes["address"] = unsaved_leases.kept(address)
    own = Assignment.objects.select_for_update(no_key=True).get(pk=own.pk)
    if not own_expired(worker, pool).filter(pk=own.pk).exists():
        return None
    if own.state == State.LEASED:
        own = transition(own, Action.EXPIRE, None)
    return transition(own, Action.RENEW, worker, changes=changes)


def lease(batch: Batch, worker: Worker, address: str, submission: str = "") -> Assignment:
    place = f"{batch.campaign.name}-" if batch.campaign else ""
    name = f"{place}batch-{batch.number:04d}-{worker.pseudonym}"
    layer = Layer.objects.create(dataset_id=batch.dataset_id, name=name, kind=Layer.Kind.ASSIGNMENT)
    made = Assignment.objects.create(
        batch=batch,
        worker=worker,
        layer=layer,
        expires_at=first_lease_end(batch.campaign),
        address=unsaved_leases.kept(address),
        submission=submission,
    )
    if batch.campaign:
        starting.prepare(made)
    return made


def submit(assignment: Assignment) -> Assignment:
    """End the work and give its code; again: the same code. Raises Unfinished or ReadOnly."""
    with transaction.atomic():
        locked = Assignment.objects.select_for_update(no_key=True).get(pk=assignment.pk)
        if locked.state in {State.SUBMITTED, State.ACCEPTED, State.REJECTED}:
            return locked
        if reason := read_only_reason(locked):
            raise ReadOnly(reason)
        return transition(locked, Action.SUBMIT, locked.worker)


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
