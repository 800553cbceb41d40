"""Jobs, and the releases they make."""

from __future__ import annotations

from django.contrib import admin
from django.db.models import QuerySet
from django.http import HttpRequest

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import Job, Release


@admin.register(Job)
class JobAdmin(LookOnlyAdmin):
    list_display = ["pk", "kind", "dataset", "state", "done", "total", "attempts", "created_by", "created_at"]
    list_filter = ["state", "kind", "dataset"]
    list_select_related = ["dataset", "created_by"]
    search_fields = ["=id", "dataset__slug", "message"]
    date_hierarchy = "created_at"


@admin.register(Release)
class ReleaseAdmin(LookOnlyAdmin):
    list_display = ["number", "title", "dataset", "layer", "manifest_digest", "created_by", "created_at"]
    list_filter = ["dataset"]
    list_select_related = ["dataset", "layer", "created_by"]
    search_fields = ["=number", "title", "dataset__slug", "layer__name", "=manifest_digest"]
    exclude = ["manifest"]

    def get_queryset(self, request: HttpRequest) -> QuerySet[Release]:
        return super().get_queryset(request).defer("manifest")  # thousands of digests
