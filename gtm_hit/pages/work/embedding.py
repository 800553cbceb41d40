"""Pages that a panel shows in a frame of its own: only for the origins the campaign and the server list."""

from __future__ import annotations

from django.http import HttpResponse

from annotator import content_policy
from gtm_hit.crowd.platforms import platform_of
from gtm_hit.models import Campaign


def framed(response: HttpResponse, campaign: Campaign | None) -> HttpResponse:
    """The answer, as the campaign's platform may show it."""
    framing = platform_of(campaign).framing() if campaign else None
    if framing is None or not framing.ancestors:
        return response
    response[content_policy.HEADER] = content_policy.policy(framing.ancestors, framing.forms)
    response.xframe_options_exempt = True
    return response
