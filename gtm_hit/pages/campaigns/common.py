"""What the pages of a campaign share."""

from __future__ import annotations

from typing import Any

from django.http import Http404
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, Worker
from gtm_hit.ops.campaigns import seats


def worker_or_404(campaign: Campaign, pseudonym: str) -> Worker:
    worker = seats.known(campaign).select_related("user").filter(pseudonym=pseudonym).first()
    if worker is None:
        raise Http404(_("There is no worker “%(name)s”.") % {"name": pseudonym})
    return worker


def frame(campaign: Campaign, here: str, **more: Any) -> dict[str, Any]:
    """What every page of a campaign needs."""
    return {
        "section": "datasets",
        "tab": "campaigns",
        "dataset": campaign.dataset,
        "campaign": campaign,
        "here": here,
        **more,
    }
