"""Marks by which cameras are known to stand still, and checks."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import DriftCheck, DriftMarks


@admin.register(DriftMarks)
class DriftMarksAdmin(LookOnlyAdmin):
    list_display = ["camera", "calibration", "count", "created_by", "created_at"]
    list_select_related = ["camera", "calibration__dataset", "created_by"]
    search_fields = ["camera__name", "calibration__dataset__slug"]


@admin.register(DriftCheck)
class DriftCheckAdmin(LookOnlyAdmin):
    list_display = ["dataset", "calibration", "warns", "created_by", "created_at"]
    list_filter = ["warns"]
    list_select_related = ["dataset", "calibration__dataset", "created_by"]
    search_fields = ["dataset__slug"]
