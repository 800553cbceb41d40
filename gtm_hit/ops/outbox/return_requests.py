"""Asking a worker to give a submission back: unpaid, and without the rejection it would come to."""

from __future__ import annotations

from django.contrib.auth.models import User
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Campaign, OutboxRow, Submission
from gtm_hit.ops.outbox.planning import DECISIONS, PLATFORMS, PlanError
from gtm_hit.ops.pay import ledger

State, Kind = OutboxRow.State, OutboxRow.Kind
MOST_LETTERS = 1000
DECIDED = {Assignment.State.ACCEPTED, Assignment.State.REJECTED}


def plan(campaign: Campaign, submission: str, reason: str, by: User | None) -> OutboxRow:
    """Once per submission: asking again gives the row there is. Raises PlanError."""
    with ledger.holding(campaign) as held:
        work = asked_about(held, submission.strip())
        row, _made = OutboxRow.objects.exclude(state=State.WITHDRAWN).get_or_create(
            campaign=held,
            key=f"{Kind.REQUEST_RETURN}:{work.submission}",
            defaults={
                "kind": Kind.REQUEST_RETURN,
                "worker_id": work.worker_id,
                "assignment": work,
                "submission": work.submission,
                "payload": {"reasons": [checked(reason)]},
                "planned_by": by,
            },
        )
    return row


def asked_about(campaign: Campaign, submission: str) -> Assignment:
    """The newest batch done under it, none of which is decided."""
    if campaign.platform not in PLATFORMS:
        raise PlanError(_("This platform cannot ask anybody to return work."))
    # PostgreSQL has no strings with a zero byte and fails instead of finding nothing.
    known = submission and "\x00" not in submission
    works = Assignment.objects.filter(batch__campaign=campaign, submission=submission).order_by("-pk")
    found = list(works) if known else []
    if not found:
        raise PlanError(_("Nobody works here under the submission %(id)s.") % {"id": submission})
    told = OutboxRow.objects.filter(campaign=campaign, submission=submission, kind__in=DECISIONS)
    if {each.state for each in found} & DECIDED or told.exclude(state=State.WITHDRAWN).exists():
        raise PlanError(_("This submission is decided; only what is not can be asked back."))
    gone = Submission.objects.filter(campaign=campaign, submission=submission, status=Submission.RETURNED)
    if gone.exists():
        raise PlanError(_("This submission was given back already."))
    return found[0]


def checked(reason: str) -> str:
    cleaned = reason.strip()
    if not cleaned or len(cleaned) > MOST_LETTERS or "\x00" in cleaned:
        text = _("Say why the work should be given back, in at most %(most)d characters.")
        raise PlanError(text % {"most": MOST_LETTERS})
    return cleaned
