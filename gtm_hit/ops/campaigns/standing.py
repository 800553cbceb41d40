"""Invited and blocked workers of a campaign."""

from __future__ import annotations

from django.contrib.auth.models import User
from django.db import transaction
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, CampaignWorker, Worker
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work import workers

Standing = CampaignWorker.Standing
MAX_REASON = 2000


def worker_named(campaign: Campaign, name: str) -> Worker | None:
    """By pseudonym, or by the platform's own id."""
    found = Worker.objects.filter(platform=campaign.platform, pseudonym=name).first()
    return found or Worker.objects.filter(platform=campaign.platform, external_id=name).first()


def invite(campaign: Campaign, name: str, user: User | None = None) -> CampaignWorker:
    """Whoever has this id on the campaign's platform may come in, known here already or not."""
    return put(campaign, known_or_new(campaign, name), Standing.INVITED, "", user)


def known_or_new(campaign: Campaign, external_id: str) -> Worker:
    """Somebody of the campaign's platform by pseudonym or id. Raises CampaignError."""
    if campaign.platform == Campaign.Platform.OWN_TEAM and worker_named(campaign, external_id) is None:
        text = _("Nobody has an account “%(name)s” here; make an invitation link instead.")
        raise CampaignError(text % {"name": external_id}, "worker")
    try:
        return worker_named(campaign, external_id) or workers.enter(campaign.platform, external_id)
    except workers.InvalidWorkerId as error:
        raise CampaignError(str(error), "worker") from error


def block(campaign: Campaign, worker: Worker, reason: str, user: User | None = None) -> CampaignWorker:
    """No more batches; what is held may be finished. The reason is for managers."""
    reason = reason.strip()
    if not reason or len(reason) > MAX_REASON:
        text = _("Say why, in at most %(most)d characters.")
        raise CampaignError(text % {"most": MAX_REASON}, "reason")
    return put(campaign, worker, Standing.BLOCKED, reason, user)


def forget(campaign: Campaign, worker: Worker) -> None:
    """Neither invited nor blocked any more: the campaign's rule for everybody counts again."""
    CampaignWorker.objects.filter(campaign=campaign, worker=worker).delete()


def put(campaign: Campaign, worker: Worker, standing: str, reason: str, user: User | None) -> CampaignWorker:
    with transaction.atomic():
        row, _made = CampaignWorker.objects.update_or_create(
            campaign=campaign,
            worker=worker,
            defaults={"standing": standing, "reason": reason, "changed_by": user},
        )
    return row
