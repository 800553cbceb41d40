"""Datasets, and the calibrations and pictures they were imported with."""

from __future__ import annotations

from django.contrib import admin
from django.http import HttpRequest

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import Calibration, CalibrationPlacement, Camera, Dataset, Frame, Image


@admin.register(Dataset)
class DatasetAdmin(admin.ModelAdmin):
    list_display = ["slug", "name", "columns", "rows", "step", "foot_rule", "created_at"]
    list_filter = ["foot_rule"]
    search_fields = ["slug", "name"]
    # Rectangles, images and annotations were made from these; a change would silently contradict them.
    readonly_fields = [
        "slug",
        "columns",
        "rows",
        "step",
        "origin_x",
        "origin_y",
        "cylinder_radius",
        "cylinder_height",
        "foot_rule",
        "undistorted",
        "calibration",
        "created_at",
    ]

    def has_add_permission(self, request: HttpRequest) -> bool:
        return False  # `manage.py importdataset` brings images and calibration along


@admin.register(Calibration)
class CalibrationAdmin(LookOnlyAdmin):
    list_display = ["number", "dataset", "source", "digest", "created_by", "created_at"]
    list_filter = ["dataset"]
    list_select_related = ["dataset", "created_by"]
    search_fields = ["=number", "dataset__slug", "source", "=digest"]


@admin.register(CalibrationPlacement)
class CalibrationPlacementAdmin(LookOnlyAdmin):
    list_display = ["calibration", "source", "created_by", "created_at"]
    list_filter = ["calibration__dataset"]
    list_select_related = ["calibration__dataset", "created_by"]
    search_fields = ["=calibration__number", "calibration__dataset__slug", "source"]


@admin.register(Camera)
class CameraAdmin(LookOnlyAdmin):
    list_display = ["name", "index", "dataset", "width", "height"]
    list_filter = ["dataset"]
    list_select_related = ["dataset"]
    search_fields = ["name", "dataset__slug"]


@admin.register(Frame)
class FrameAdmin(LookOnlyAdmin):
    list_display = ["number", "dataset"]
    list_filter = ["dataset"]
    list_select_related = ["dataset"]
    search_fields = ["=number"]


@admin.register(Image)
class ImageAdmin(LookOnlyAdmin):
    list_display = ["frame", "camera", "light_bytes", "full_bytes", "source_digest"]
    list_filter = ["camera__dataset", "camera"]
    list_select_related = ["frame", "camera"]
    search_fields = ["=frame__number", "=source_digest", "=light_digest", "=full_digest"]
