"""Campaigns are made and changed here, by page, REST and command alike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.contrib.auth.models import User
from django.core.exceptions import ValidationError
from django.db import IntegrityError, transaction
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, Dataset
from gtm_hit.ops.campaigns import changes, cutting, platform_settings
from gtm_hit.ops.campaigns.errors import CampaignError

MAX_NAME = 60  # names of layers begin with it
RESERVED = {"new"}  # addresses of pages


def create(dataset: Dataset, values: Mapping[str, Any], user: User | None = None) -> Campaign:
    """A draft with these values, the others by default. Raises CampaignError."""
    campaign = Campaign(dataset=dataset, created_by=user)
    put(campaign, values)
    try:
        with transaction.atomic():
            campaign.save(force_insert=True)
    except IntegrityError:
        raise already_there(campaign.name) from None
    return campaign


def edit(campaign: Campaign, values: Mapping[str, Any]) -> Campaign:
    """Change what may be changed in the campaign's state; all of it, or nothing. Raises CampaignError."""
    try:
        with transaction.atomic():
            locked = Campaign.objects.select_for_update(no_key=True).get(pk=campaign.pk)
            for name, value in values.items():
                if name != "platform_settings" and name in changes.WHILE_OPEN:
                    changes.require_allowed(locked, name, value)
            put(locked, values)
            locked.save()
            if locked.state != Campaign.State.DRAFT:
                cutting.cut(locked)
            return locked
    except IntegrityError:
        raise already_there(str(values.get("name", ""))) from None


def put(campaign: Campaign, values: Mapping[str, Any]) -> None:
    """Write values into an unsaved row and look at the whole of it."""
    if unknown := sorted(set(values) - set(changes.FIELDS)):
        raise CampaignError(_("A campaign has no %(names)s.") % {"names": ", ".join(unknown)}, unknown[0])
    platform_before = campaign.platform
    for name, value in values.items():
        if name != "platform_settings":
            setattr(campaign, name, value)
    stored = campaign.platform_settings if campaign.platform == platform_before else {}
    given = values.get("platform_settings", {})
    after = platform_settings.checked(campaign.platform, given, stored)
    if after != campaign.platform_settings:
        changes.require_allowed(campaign, "platform_settings", after)
        campaign.platform_settings = after
    require_sound(campaign)


def require_sound(campaign: Campaign) -> None:
    if len(campaign.name) > MAX_NAME or campaign.name in RESERVED:
        text = _("A campaign's name has at most %(most)d characters, and is not “new”.")
        raise CampaignError(text % {"most": MAX_NAME}, "name")
    try:
        campaign.clean_fields(exclude=["dataset", "created_by", "platform_settings"])
    except ValidationError as error:
        name, problems = next(iter(error.message_dict.items()))
        raise CampaignError(f"{changes.label(name)}: {problems[0]}", name) from error
    if campaign.overlap >= campaign.batch_size:
        raise CampaignError(_("Neighbours share fewer frames than a batch has."), "overlap")


def already_there(name: str) -> CampaignError:
    return CampaignError(_("There is a campaign “%(name)s” already.") % {"name": name}, "name")
