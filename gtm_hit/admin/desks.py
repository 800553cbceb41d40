"""Calibrations being made, and what was done for them."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import (
    BoardPicture,
    Click,
    ClickDecision,
    ClickFile,
    Desk,
    DeskAdjustment,
    DeskCamera,
    DeskEdit,
    DeskPicture,
    KeptClick,
    KeptPoint,
    MeasuredPoint,
)


@admin.register(Desk)
class DeskAdmin(LookOnlyAdmin):
    list_display = ["slug", "title", "dataset", "created_by", "created_at"]
    list_select_related = ["dataset", "created_by"]
    search_fields = ["slug", "title"]


@admin.register(DeskCamera)
class DeskCameraAdmin(LookOnlyAdmin):
    list_display = ["desk", "index", "name", "width", "height"]
    list_select_related = ["desk"]
    search_fields = ["desk__slug", "name"]
    exclude = ["lens_report", "pose_report", "adjusted"]


@admin.register(BoardPicture)
class BoardPictureAdmin(LookOnlyAdmin):
    list_display = ["camera", "name", "used", "reason"]
    list_select_related = ["camera"]
    search_fields = ["name"]
    exclude = ["found"]


@admin.register(MeasuredPoint)
class MeasuredPointAdmin(LookOnlyAdmin):
    list_display = ["desk", "number", "name", "x", "y", "z"]
    list_select_related = ["desk"]
    search_fields = ["desk__slug", "name"]


@admin.register(Click)
class ClickAdmin(LookOnlyAdmin):
    list_display = ["camera", "point", "x", "y"]
    list_select_related = ["camera", "point"]
    search_fields = ["point__name"]


@admin.register(KeptPoint)
class KeptPointAdmin(LookOnlyAdmin):
    list_display = ["desk", "name", "use"]
    list_select_related = ["desk"]
    list_filter = ["use"]
    search_fields = ["desk__slug", "name"]


@admin.register(KeptClick)
class KeptClickAdmin(LookOnlyAdmin):
    list_display = ["point", "camera", "x", "y"]
    list_select_related = ["point", "camera"]
    search_fields = ["point__name"]


@admin.register(ClickFile)
class ClickFileAdmin(LookOnlyAdmin):
    list_display = ["desk", "name", "used"]
    list_select_related = ["desk"]
    search_fields = ["desk__slug", "name"]
    exclude = ["points"]


@admin.register(ClickDecision)
class ClickDecisionAdmin(LookOnlyAdmin):
    list_display = ["desk", "point", "camera", "decision"]
    list_select_related = ["desk"]
    list_filter = ["decision"]
    search_fields = ["desk__slug", "point"]


@admin.register(DeskAdjustment)
class DeskAdjustmentAdmin(LookOnlyAdmin):
    list_display = ["desk", "number", "created_by", "created_at"]
    list_select_related = ["desk", "created_by"]
    search_fields = ["desk__slug"]
    exclude = ["inputs", "state", "report", "cameras"]


@admin.register(DeskEdit)
class DeskEditAdmin(LookOnlyAdmin):
    list_display = ["desk", "number", "page", "what", "undone", "author", "at"]
    list_select_related = ["desk", "author"]
    search_fields = ["desk__slug", "what"]


@admin.register(DeskPicture)
class DeskPictureAdmin(LookOnlyAdmin):
    list_display = ["desk", "full_digest"]
    list_select_related = ["desk"]
    search_fields = ["desk__slug", "full_digest"]
