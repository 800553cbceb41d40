"""The one way an assignment changes its state. Every step is written down: who, when, from where, why."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.contrib.auth.models import User
from django.db.models import Max
from django.db.transaction import atomic

from gtm_hit.models import Assignment, Batch, Transition, Worker
from gtm_hit.ops.review import effects, machine
from gtm_hit.ops.review.actors import Actor
from gtm_hit.ops.review.asked import Asked
from gtm_hit.ops.review.happened import Happened
from gtm_hit.ops.review.machine import Action


def transition(
    assignment: Assignment,
    action: Action,
    by: Actor,
    *,
    category: str = "",
    reason: str = "",
    changes: Mapping[str, Any] | None = None,
) -> Assignment:
    """Take the step, or raise ReviewRefused and change nothing. Returns the assignment as it is now.

    `changes`: columns written with the state. Steps that follow of themselves are taken as well.
    """
    with atomic():
        locked = lock(assignment, action)
        asked = Asked(locked, by, category.strip(), reason.strip(), dict(changes or {}))
        step = machine.required(action, asked)
        begins = locked.state
        for deed in step.does:
            deed(asked)
        write(asked, step.ends)
        written = audit([(locked, begins)], action, step.ends, by, asked)[0]
        for following in effects.following(Happened(locked, written, action, by)):
            locked = transition(locked, following.action, None, reason=following.reason)
        return locked


def lock(assignment: Assignment, action: Action) -> Assignment:
    """Batch, then assignment, as everywhere; only one step makes batches."""
    if action is Action.OVERTURN:
        same = Batch.objects.filter(dataset=assignment.batch.dataset_id, number=assignment.batch.number)
        list(same.order_by("pk").select_for_update(no_key=True))
    rows = Assignment.objects.select_related("batch__dataset", "batch__campaign", "worker", "layer")
    return rows.select_for_update(no_key=True, of=("self",)).get(pk=assignment.pk)


def write(asked: Asked, state: str) -> None:
    assignment = asked.assignment
    for name, value in asked.changes.items():
        setattr(assignment, name, value)
    assignment.state = state
    assignment.save(update_fields=["state", *asked.changes])


def audit(
    steps: list[tuple[Assignment, str]], action: Action, ends: str, by: Actor, asked: Asked | None = None
) -> list[Transition]:
    """One row for each, of assignments whose rows are locked, with the state each comes from."""
    ids = [assignment.pk for assignment, _begins in steps]
    found = Transition.objects.filter(assignment__in=ids).order_by()
    last = dict(found.values_list("assignment").annotate(last=Max("number")))
    return Transition.objects.bulk_create(
        Transition(
            assignment=assignment,
            number=last.get(assignment.pk, 0) + 1,
            action=action.value,
            from_state=begins,
            to_state=ends,
            user=by if isinstance(by, User) else None,
            worker=by if isinstance(by, Worker) else None,
            category=asked.category if asked else "",
            reason=asked.reason if asked else "",
        )
        for assignment, begins in steps
    )


def expire_all(locked: list[Assignment]) -> int:
    """End the overdue leases, whose rows the caller has locked, with three queries; how many there were."""
    step = machine.TABLE[Action.EXPIRE]
    steps = [(assignment, assignment.state) for assignment in locked if assignment.state in step.begins]
    if not steps:
        return 0
    ends = step.ends
    Assignment.objects.filter(pk__in=[assignment.pk for assignment, _begins in steps]).update(state=ends)
    audit(steps, Action.EXPIRE, ends, None)
    return len(steps)
