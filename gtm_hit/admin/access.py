"""Who may do what, and with which key."""

from __future__ import annotations

from django.contrib import admin
from django.http import HttpRequest

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import ApiToken, Membership, RoleChange


@admin.register(Membership)
class MembershipAdmin(LookOnlyAdmin):
    list_display = ["user", "role", "dataset"]
    list_filter = ["role", "dataset"]
    list_select_related = ["user", "dataset"]
    search_fields = ["user__username", "dataset__slug"]


@admin.register(RoleChange)
class RoleChangeAdmin(LookOnlyAdmin):
    list_display = ["at", "username", "role", "dataset", "granted", "by"]
    list_filter = ["role", "granted"]
    search_fields = ["username", "dataset", "by"]
    date_hierarchy = "at"


@admin.register(ApiToken)
class ApiTokenAdmin(admin.ModelAdmin):
    list_display = ["name", "user", "scopes", "created_at", "expires_at", "last_used_at", "revoked_at"]
    list_filter = [("revoked_at", admin.EmptyFieldListFilter)]
    list_select_related = ["user"]
    search_fields = ["name", "user__username"]
    readonly_fields = ["user", "scopes", "created_at", "last_used_at"]

    def has_add_permission(self, request: HttpRequest) -> bool:
        return False  # a key is shown once, by the page that makes it
