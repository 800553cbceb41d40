"""Who may take batches of a campaign. Claiming asks here, with the worker's row locked."""

from __future__ import annotations

from dataclasses import dataclass

from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Campaign, CampaignWorker, Worker
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.qualifications.requirements import missing_qualifications

State = Assignment.State
Standing = CampaignWorker.Standing

# What uses up a worker's share: everything but a batch that went back to the others unfinished.
COUNTED = [State.LEASED, State.SUBMITTED, State.ACCEPTED, State.RETURNED, State.REJECTED]


@dataclass(frozen=True)
class Refusal:
    """Why somebody gets no batch: a word for programs, a sentence for people."""

    reason: str  # not_open, blocked, not_invited, not_qualified, limit
    text: str


class NotAdmitted(OperationError):
    """The campaign's rules give this worker no batch now."""

    def __init__(self, refusal: Refusal) -> None:
        super().__init__(refusal.text)
        self.refusal = refusal


def refusal(campaign: Campaign, worker: Worker) -> Refusal | None:
    """Why the worker may not take another batch; None when they may."""
    return state_refusal(campaign) or standing_refusal(campaign, worker) or limit_refusal(campaign, worker)


def state_refusal(campaign: Campaign) -> Refusal | None:
    if campaign.state == Campaign.State.OPEN:
        return None
    texts = {
        Campaign.State.DRAFT: _("This work has not begun yet."),
        Campaign.State.PAUSED: _("This work is paused. Nothing you did is lost; try again later."),
        Campaign.State.CLOSED: _("This work is finished; no more batches are handed out."),
    }
    return Refusal("not_open", texts[Campaign.State(campaign.state)])


def standing_refusal(campaign: Campaign, worker: Worker) -> Refusal | None:
    """A block counts before everything, and an invitation opens what others need a qualification for."""
    row = CampaignWorker.objects.filter(campaign=campaign, worker=worker).first()
    standing = row.standing if row else ""
    if standing == Standing.BLOCKED:
        return Refusal("blocked", _("You get no more batches of this work."))
    if standing == Standing.INVITED or campaign.entry == Campaign.Entry.ANYONE:
        return None
    if campaign.entry == Campaign.Entry.INVITED:
        return Refusal("not_invited", _("Only invited people take part in this work."))
    if missing := missing_qualifications(campaign, worker):
        names = ", ".join(missing)
        return Refusal("not_qualified", _("First you need: %(names)s.") % {"names": names})
    return None


def limit_refusal(campaign: Campaign, worker: Worker) -> Refusal | None:
    most = campaign.batches_per_worker
    if most is None or taken(campaign, worker) < most:
        return None
    text = _("You have had as many batches of this work as one person may have: %(most)d.")
    return Refusal("limit", text % {"most": most})


def taken(campaign: Campaign, worker: Worker) -> int:
    rows = Assignment.objects.filter(worker=worker, batch__campaign=campaign)
    return rows.filter(state__in=COUNTED).count()
