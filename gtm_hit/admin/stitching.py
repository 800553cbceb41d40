"""Ground truth made of accepted batches, and what was decided on the way."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import Dataset, Layer, StitchConflict, StitchedFrame, Stitching, StitchingRun


@admin.register(Stitching)
class StitchingAdmin(LookOnlyAdmin):
    list_display = ["dataset", "campaign", "layer", "created_at"]
    list_select_related = ["dataset", "campaign__dataset", "layer"]
    search_fields = ["dataset__slug", "campaign__name"]


@admin.register(StitchingRun)
class StitchingRunAdmin(LookOnlyAdmin):
    list_display = ["pk", "dataset", "layer", "created_by", "created_at"]
    list_select_related = ["stitching__dataset", "stitching__layer", "created_by"]
    search_fields = ["stitching__dataset__slug"]
    exclude = ["numbers"]

    @admin.display(ordering="stitching__dataset")
    def dataset(self, run: StitchingRun) -> Dataset:
        return run.stitching.dataset

    @admin.display(ordering="stitching__layer")
    def layer(self, run: StitchingRun) -> Layer:
        return run.stitching.layer


@admin.register(StitchedFrame)
class StitchedFrameAdmin(LookOnlyAdmin):
    list_display = ["layer", "frame", "revision"]
    list_select_related = ["layer", "frame"]
    search_fields = ["=layer__name", "=frame__number"]


@admin.register(StitchConflict)
class StitchConflictAdmin(LookOnlyAdmin):
    list_display = ["pk", "kind", "left_at", "came_at", "state", "decision", "decided_by", "decided_at"]
    list_filter = ["state", "kind", "decision"]
    list_select_related = ["decided_by"]
    search_fields = ["=left_at", "=came_at"]
