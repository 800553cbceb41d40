"""The account book, the hours it follows from, and what goes to and comes from platforms."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import HookEvent, MoneyEntry, OutboxRow, PlatformAccount, Submission, WorkClock


@admin.register(MoneyEntry)
class MoneyEntryAdmin(LookOnlyAdmin):
    list_display = ["kind", "amount", "currency", "worker", "campaign", "user", "at"]
    list_filter = ["kind", "campaign"]
    list_select_related = ["worker", "campaign__dataset", "user"]
    search_fields = ["worker__pseudonym", "campaign__name", "note"]
    date_hierarchy = "at"


@admin.register(WorkClock)
class WorkClockAdmin(LookOnlyAdmin):
    list_display = ["assignment", "counted", "told", "seen_at"]
    list_select_related = ["assignment__batch__dataset", "assignment__worker"]
    search_fields = ["assignment__worker__pseudonym"]


@admin.register(OutboxRow)
class OutboxRowAdmin(LookOnlyAdmin):
    list_display = ["kind", "state", "worker", "amount", "campaign", "attempts", "sent_at", "done_at"]
    list_filter = ["state", "kind", "campaign"]
    list_select_related = ["worker", "campaign__dataset"]
    search_fields = ["worker__pseudonym", "=submission"]


@admin.register(PlatformAccount)
class PlatformAccountAdmin(LookOnlyAdmin):
    """Keys and secrets are in none of its fields."""

    list_display = ["campaign", "study", "study_state", "address", "changed_by", "changed_at"]
    list_select_related = ["campaign__dataset", "changed_by"]
    search_fields = ["campaign__name", "=study"]
    exclude = ["token", "hook_secret"]


@admin.register(Submission)
class SubmissionAdmin(LookOnlyAdmin):
    list_display = ["submission", "status", "status_at", "campaign"]
    list_filter = ["status", "campaign"]
    list_select_related = ["campaign__dataset"]
    search_fields = ["=submission", "=participant"]


@admin.register(HookEvent)
class HookEventAdmin(LookOnlyAdmin):
    list_display = ["kind", "event_id", "campaign", "received_at"]
    list_filter = ["kind", "campaign"]
    list_select_related = ["campaign__dataset"]
    search_fields = ["=event_id"]
