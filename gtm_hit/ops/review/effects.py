"""What follows a transition, in the same transaction. Whoever wants to be told adds a line to the list."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from django.contrib.auth.models import User

from gtm_hit.models import Assignment
from gtm_hit.ops.gold import submission
from gtm_hit.ops.outbox import planning
from gtm_hit.ops.review import choosing
from gtm_hit.ops.review.happened import Following, Happened
from gtm_hit.ops.review.machine import DECISIONS, Action

Effect = Callable[[Happened], Following | None]


def take_out_faults(happened: Happened) -> None:
    """What was planted in submitted work leaves it, and a try is judged."""
    if happened.action is not Action.SUBMIT:
        return
    batch = happened.assignment.batch
    if batch.campaign_id is None and batch.qualification_id is None:
        return
    submission.submitted(happened.assignment)


def tell_platform(happened: Happened) -> None:
    """Plan what the worker's platform is to be told about a decision."""
    if happened.action not in {*DECISIONS, Action.ACCEPT_UNSEEN} or happened.action is Action.UPHOLD:
        return
    if happened.assignment.state == Assignment.State.EXPIRED:
        return  # taken back: whoever gets the batch next is decided about
    row = happened.transition
    planning.plan_decision(
        happened.assignment,
        happened.assignment.state,
        message=row.reason,
        category=row.category,
        by=happened.by if isinstance(happened.by, User) else None,
    )


# Faults go before anybody looks at the work.
EFFECTS: list[Effect] = [take_out_faults, choosing.after_submission, tell_platform]


def following(happened: Happened) -> Iterator[Following]:
    """Tell everybody; the steps the system is to take now."""
    for effect in EFFECTS:
        if found := effect(happened):
            yield found
