"""Workers, how they come in, and the work they are given."""

from __future__ import annotations

import shlex
from typing import Any

from django.contrib import admin
from django.http import HttpRequest

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import Assignment, Attempt, Batch, Dataset, EntryLink, Worker


@admin.register(Worker)
class WorkerAdmin(admin.ModelAdmin):
    list_display = ["pseudonym", "platform", "external_id", "tutorial_done_at", "created_at"]
    list_filter = ["platform", ("tutorial_done_at", admin.EmptyFieldListFilter)]
    search_fields = ["pseudonym", "external_id"]
    readonly_fields = ["pseudonym", "platform", "external_id", "bound", "personal_link", "created_at"]

    @admin.display(boolean=True, description="bound to a browser")
    def bound(self, row: Worker) -> bool:
        return bool(row.browser)

    @admin.display(description="personal link, for every browser: run")
    def personal_link(self, row: Worker) -> str:
        worked_in = Dataset.objects.filter(batches__assignments__worker=row).distinct()
        slugs = list(worked_in.values_list("slug", flat=True)) or ["DATASET"]
        words = ["--platform", row.platform, "--worker", row.external_id]
        return "\n".join(f"manage.py makelink {shlex.join([slug, *words])}" for slug in slugs)

    def has_add_permission(self, request: HttpRequest) -> bool:
        return False  # workers come through their link

    def has_delete_permission(self, request: HttpRequest, obj: Any = None) -> bool:
        return False


@admin.register(EntryLink)
class EntryLinkAdmin(LookOnlyAdmin):
    list_display = ["dataset", "platform", "closed_at"]
    list_filter = ["platform", ("closed_at", admin.EmptyFieldListFilter)]
    list_select_related = ["dataset"]
    search_fields = ["dataset__slug", "platform"]


@admin.register(Attempt)
class AttemptAdmin(LookOnlyAdmin):
    list_display = ["key", "at"]
    search_fields = ["=key"]
    date_hierarchy = "at"


@admin.register(Batch)
class BatchAdmin(LookOnlyAdmin):
    list_display = ["number", "copy", "dataset", "created_at"]
    list_filter = ["dataset", "copy"]
    list_select_related = ["dataset"]
    search_fields = ["=number", "dataset__slug"]


@admin.register(Assignment)
class AssignmentAdmin(admin.ModelAdmin):
    list_display = ["batch", "worker", "state", "leased_at", "expires_at", "submitted_at"]
    list_filter = ["state", "batch__dataset", "worker__platform"]
    list_select_related = ["batch__dataset", "worker"]
    search_fields = ["worker__pseudonym", "worker__external_id", "=code", "=batch__number"]
    date_hierarchy = "leased_at"
    # A lease may be lengthened or ended by hand; everything else follows from what the worker did.
    readonly_fields = ["batch", "worker", "layer", "state", "leased_at", "submitted_at", "code"]

    def has_add_permission(self, request: HttpRequest) -> bool:
        return False

    def has_delete_permission(self, request: HttpRequest, obj: Any = None) -> bool:
        return False
