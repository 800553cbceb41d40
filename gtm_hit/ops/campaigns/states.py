"""draft → open ⇄ paused → closed. Each step says why it cannot be taken."""

from __future__ import annotations

from collections.abc import Mapping

from django.db import transaction
from django.utils import timezone
from django.utils.functional import Promise
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy

from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns import cutting, platform_settings
from gtm_hit.ops.campaigns.errors import CampaignError

State = Campaign.State

STEPS: Mapping[str, tuple[frozenset[str], str]] = {
    "open": (frozenset({State.DRAFT, State.PAUSED}), State.OPEN),
    "pause": (frozenset({State.OPEN}), State.PAUSED),
    "close": (frozenset({State.DRAFT, State.OPEN, State.PAUSED}), State.CLOSED),
}
MEANS: Mapping[str, str | Promise] = {
    "open": gettext_lazy("Workers are let in and get batches."),
    "pause": gettext_lazy("Nobody gets a new batch; what is held may be finished and submitted."),
    "close": gettext_lazy(
        "For good: nobody gets a batch any more, nothing can be changed; what is held may be submitted."
    ),
}


def steps(campaign: Campaign) -> list[str]:
    """What can be done with the campaign now."""
    return [name for name, (sources, _target) in STEPS.items() if campaign.state in sources]


def take(campaign: Campaign, step: str) -> Campaign:
    """Open, pause or close. Raises CampaignError, and then nothing has changed."""
    if step not in STEPS:
        raise CampaignError(
            _("A campaign can be opened, paused and closed, not “%(step)s”.") % {"step": step}
        )
    sources, target = STEPS[step]
    with transaction.atomic():
        locked = Campaign.objects.select_for_update(no_key=True).select_related("dataset").get(pk=campaign.pk)
        if locked.state == target:
            return locked
        if locked.state not in sources:
            named = {"state": locked.get_state_display(), "step": step}
            raise CampaignError(_("A campaign that is %(state)s cannot be changed by “%(step)s”.") % named)
        if step == "open":
            prepare(locked)
        locked.state = target
        if step == "close":
            locked.closed_at = timezone.now()
        locked.save()
        return locked


def prepare(campaign: Campaign) -> None:
    """Whatever must be there when the first worker comes in."""
    if problem := platform_settings.missing(campaign):
        raise CampaignError(problem, "platform_settings")
    cutting.cut(campaign)
    campaign.opened_at = campaign.opened_at or timezone.now()
