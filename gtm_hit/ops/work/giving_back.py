"""Work that its worker gave up at the platform goes back to the pool; what he saved stays his."""

from __future__ import annotations

from gtm_hit.models import Assignment, Campaign
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.refusals import WrongState
from gtm_hit.ops.review.transitions import transition

GIVEN_UP = [Assignment.State.LEASED, Assignment.State.RETURNED]


def of_submission(campaign: Campaign, submission: str, why: str) -> int:
    """Batches under way for it that were freed; what is handed in or decided is left alone."""
    held = Assignment.objects.filter(batch__campaign=campaign, submission=submission, state__in=GIVEN_UP)
    return sum(given_up(assignment, why) for assignment in held.order_by("pk"))


def given_up(assignment: Assignment, why: str) -> bool:
    """False when he handed it in at this very moment."""
    try:
        transition(assignment, Action.GIVE_UP, None, reason=why)
    except WrongState:
        return False
    return True
