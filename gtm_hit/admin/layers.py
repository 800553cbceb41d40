"""Layers, and what annotators and programs wrote into them."""

from __future__ import annotations

from django.contrib import admin
from django.http import HttpRequest

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import Annotation, Layer, LayerFrame, Save


@admin.register(Layer)
class LayerAdmin(admin.ModelAdmin):
    list_display = ["name", "dataset", "kind", "hidden", "created_at"]
    list_filter = ["kind", "hidden", "dataset"]
    list_select_related = ["dataset"]
    search_fields = ["name", "dataset__slug"]
    autocomplete_fields = ["dataset"]
    readonly_fields = ["last_person", "created_at"]

    def get_readonly_fields(self, request: HttpRequest, obj: Layer | None = None) -> list[str]:
        return [*self.readonly_fields, *(["dataset", "kind"] if obj else [])]


@admin.register(LayerFrame)
class LayerFrameAdmin(LookOnlyAdmin):
    list_display = ["frame", "layer", "dataset", "revision", "done", "nobody", "seconds", "changed_at"]
    list_filter = ["done", "nobody", "layer__dataset", "layer__kind"]
    list_select_related = ["frame", "layer__dataset"]
    search_fields = ["layer__name", "=frame__number"]

    @admin.display(ordering="layer__dataset")
    def dataset(self, row: LayerFrame) -> str:
        return row.layer.dataset.slug


@admin.register(Annotation)
class AnnotationAdmin(LookOnlyAdmin):
    list_display = ["person", "position", "frame", "layer", "state", "origin", "height", "radius"]
    list_filter = ["state", "origin", "layer__dataset", "layer__kind"]
    list_select_related = ["frame", "layer"]
    search_fields = ["=person", "=position", "layer__name"]


@admin.register(Save)
class SaveAdmin(LookOnlyAdmin):
    list_display = ["layer_frame", "revision", "author", "done", "nobody", "seconds", "created_at"]
    list_filter = ["done", "nobody", "layer_frame__layer__dataset", "created_at"]
    list_select_related = ["layer_frame__layer", "layer_frame__frame", "user", "worker"]
    search_fields = ["=save_id", "layer_frame__layer__name", "worker__pseudonym", "user__username"]
    date_hierarchy = "created_at"

    @admin.display(description="author")
    def author(self, row: Save) -> str:
        return str(row.worker or row.user or "–")
