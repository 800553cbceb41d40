"""Campaigns, their workers and their links."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import Campaign, CampaignLink, CampaignWorker


@admin.register(Campaign)
class CampaignAdmin(LookOnlyAdmin):
    list_display = ["name", "dataset", "platform", "state", "entry", "created_by", "created_at"]
    list_filter = ["state", "platform", "dataset"]
    list_select_related = ["dataset", "created_by"]
    search_fields = ["name", "title", "dataset__slug"]
    exclude = ["platform_settings"]  # with the codes that say whose work is done


@admin.register(CampaignWorker)
class CampaignWorkerAdmin(LookOnlyAdmin):
    list_display = ["worker", "campaign", "standing", "changed_by", "changed_at"]
    list_filter = ["standing", "campaign"]
    list_select_related = ["worker", "campaign__dataset", "changed_by"]
    search_fields = ["worker__pseudonym", "campaign__name", "reason"]


@admin.register(CampaignLink)
class CampaignLinkAdmin(LookOnlyAdmin):
    """What makes an address is in none of its fields."""

    list_display = ["pk", "kind", "campaign", "worker", "uses", "created_at", "expires_at", "revoked_at"]
    list_filter = ["kind", "campaign"]
    list_select_related = ["campaign__dataset", "worker"]
    search_fields = ["campaign__name", "worker__pseudonym", "note"]
