"""The rows behind a campaign's addresses: made, used, rotated, revoked."""

from __future__ import annotations

from datetime import datetime, timedelta

from django.conf import settings
from django.contrib.auth.models import User
from django.db.models import F
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, CampaignLink, Worker
from gtm_hit.models.campaign_link import link_nonce
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work.signing import BadToken, sign, unsign

Kind = CampaignLink.Kind
MAX_NOTE = 120
MAX_DAYS = 3650


def token(link: CampaignLink) -> str:
    return sign("link", [link.pk, link.nonce])


def find(token: str) -> CampaignLink:
    """The link of this token, over or not; raises BadToken when it was rotated or never made."""
    pk, nonce = unsign("link", token)
    rows = CampaignLink.objects.select_related("campaign__dataset", "worker")
    link = rows.filter(pk=pk, nonce=nonce).first()
    if link is None:
        raise BadToken("the link is gone or was replaced")
    return link


def make(
    campaign: Campaign,
    kind: str = Kind.GENERAL,
    *,
    worker: Worker | None = None,
    note: str = "",
    days: int | None = None,
    user: User | None = None,
) -> CampaignLink:
    """`days`: how long it is valid; None: as long as the server's settings say. Raises CampaignError."""
    if kind == Kind.INVITATION and campaign.platform != Campaign.Platform.OWN_TEAM:
        raise CampaignError(_("Invitations make accounts, and only the own team has them."), "kind")
    if campaign.state == Campaign.State.CLOSED:
        raise CampaignError(_("The campaign is closed; nobody comes in any more."))
    if (worker is not None) != (kind == Kind.PERSONAL):
        raise CampaignError(_("A personal link is for one worker, and no other link is."), "worker")
    if days is not None and not 1 <= days <= MAX_DAYS:
        raise CampaignError(_("A link is valid for 1 to %(most)d days.") % {"most": MAX_DAYS}, "days")
    if len(note.strip()) > MAX_NOTE:
        raise CampaignError(_("A note has at most %(most)d characters.") % {"most": MAX_NOTE}, "note")
    return CampaignLink.objects.create(
        campaign=campaign,
        kind=kind,
        worker=worker,
        note=note.strip(),
        expires_at=end(kind, days),
        created_by=user,
    )


def end(kind: str, days: int | None) -> datetime | None:
    usual = settings.WORKER_LINK_DAYS if kind == Kind.PERSONAL else settings.ENTRY_LINK_DAYS
    days = usual if days is None else days
    return timezone.now() + timedelta(days=days) if days else None


def revoke(link: CampaignLink) -> None:
    """Nobody new comes in by it; a personal link opens nothing any more. Again: the first moment stays."""
    CampaignLink.objects.filter(pk=link.pk, revoked_at=None).update(revoked_at=timezone.now())


def rotate(link: CampaignLink) -> CampaignLink:
    """Another address for the same row, open again for as long as a new one; the old address is dead."""
    if link.state == "used":
        raise CampaignError(_("The invitation was accepted already; make a new one."))
    if link.campaign.state == Campaign.State.CLOSED:
        raise CampaignError(_("The campaign is closed; nobody comes in any more."))
    link.nonce, link.revoked_at = link_nonce(), None
    link.expires_at = end(link.kind, None)
    link.save(update_fields=["nonce", "revoked_at", "expires_at"])
    return link


def used(link: CampaignLink) -> None:
    CampaignLink.objects.filter(pk=link.pk).update(uses=F("uses") + 1)
