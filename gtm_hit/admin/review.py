"""What became of assignments after they were submitted."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import Appeal, Comment, Mend, ReviewChoice, Transition


@admin.register(Transition)
class TransitionAdmin(LookOnlyAdmin):
    list_display = ["assignment", "number", "action", "from_state", "to_state", "user", "worker", "at"]
    list_filter = ["action", "to_state", "category"]
    list_select_related = ["assignment__batch__dataset", "assignment__worker", "user", "worker"]
    search_fields = ["=assignment__id", "user__username", "worker__pseudonym"]
    date_hierarchy = "at"


@admin.register(Comment)
class CommentAdmin(LookOnlyAdmin):
    list_display = ["assignment", "frame", "person", "text", "user", "worker", "created_at", "resolved_at"]
    list_select_related = ["assignment__batch__dataset", "assignment__worker", "frame", "user", "worker"]
    search_fields = ["=assignment__id", "text"]
    date_hierarchy = "created_at"


@admin.register(Appeal)
class AppealAdmin(LookOnlyAdmin):
    list_display = ["assignment", "outcome", "created_at", "decided_by", "decided_at"]
    list_filter = ["outcome"]
    list_select_related = ["assignment__batch__dataset", "assignment__worker", "decided_by"]
    search_fields = ["=assignment__id"]
    date_hierarchy = "created_at"


@admin.register(ReviewChoice)
class ReviewChoiceAdmin(LookOnlyAdmin):
    list_display = ["assignment", "chosen", "why", "suspicion", "created_at"]
    list_filter = ["chosen", "why"]
    list_select_related = ["assignment__batch__dataset", "assignment__worker"]
    search_fields = ["=assignment__id"]
    date_hierarchy = "created_at"


@admin.register(Mend)
class MendAdmin(LookOnlyAdmin):
    list_display = ["assignment", "layer", "user", "created_at", "accepted_at"]
    list_select_related = ["assignment__batch__dataset", "assignment__worker", "layer", "user"]
    search_fields = ["=assignment__id", "layer__name"]
    date_hierarchy = "created_at"
