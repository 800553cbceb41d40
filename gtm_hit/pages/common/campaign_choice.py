from __future__ import annotations

from django.http import Http404
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign


def campaign_or_404(slug: str, name: str) -> Campaign:
    """With its dataset."""
    found = Campaign.objects.select_related("dataset").filter(dataset__slug=slug, name=name)
    campaign = None if "\x00" in name else found.first()
    if campaign is None:
        raise Http404(_("There is no campaign “%(name)s”.") % {"name": name})
    return campaign
