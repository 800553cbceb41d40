"""Drafts of how the clocks of videos fit together."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import VideoSync, VideoSyncState


@admin.register(VideoSync)
class VideoSyncAdmin(LookOnlyAdmin):
    list_display = ["source", "position", "revision", "created_by", "changed_at"]
    list_select_related = ["created_by"]
    search_fields = ["source"]


@admin.register(VideoSyncState)
class VideoSyncStateAdmin(LookOnlyAdmin):
    list_display = ["sync", "number", "created_at"]
    list_select_related = ["sync"]
    search_fields = ["sync__source"]
