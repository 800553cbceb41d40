"""The back door: what workers and programs wrote is looked at here and changed by the operations only."""

from __future__ import annotations

import shlex
from typing import Any

from django.contrib import admin
from django.db.models import QuerySet
from django.http import HttpRequest

from gtm_hit.models import (
    Annotation,
    ApiToken,
    Assignment,
    Attempt,
    Batch,
    Calibration,
    Camera,
    Dataset,
    EntryLink,
    Frame,
    Image,
    Job,
    Layer,
    LayerFrame,
    PictureBoxes,
    Proposal,
    ProposalFrame,
    ProposalRun,
    Refusal,
    Release,
    Save,
    Worker,
)

admin.site.site_header = admin.site.site_title = "Ground Truth Marker"


class LookOnlyAdmin(admin.ModelAdmin):
    """Rows to search and read; nobody adds, changes or deletes them here."""

    show_full_result_count = False  # counting millions of rows takes longer than showing a hundred

    def has_add_permission(self, request: HttpRequest, obj: Any = None) -> bool:
        return False

    def has_change_permission(self, request: HttpRequest, obj: Any = None) -> bool:
        return False

    def has_delete_permission(self, request: HttpRequest, obj: Any = None) -> bool:
        return False


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


@admin.register(ApiToken)
class ApiTokenAdmin(admin.ModelAdmin):
    list_display = ["name", "user", "scopes", "created_at", "expires_at", "last_used_at", "revoked_at"]
    list_filter = [("revoked_at", admin.EmptyFieldListFilter)]
    list_select_related = ["user"]
    search_fields = ["name", "user__username"]
    readonly_fields = ["user", "scopes", "created_at", "last_used_at"]

    def has_add_permission(self, request: HttpRequest) -> bool:
        return False  # a key is shown once, by the page that makes it


@admin.register(ProposalRun)
class ProposalRunAdmin(LookOnlyAdmin):
    list_display = ["pk", "dataset", "method", "model", "in_use", "created_by", "created_at"]
    list_filter = ["method", "in_use", "dataset"]
    list_select_related = ["dataset", "created_by"]
    search_fields = ["=id", "dataset__slug", "model"]


@admin.register(ProposalFrame)
class ProposalFrameAdmin(LookOnlyAdmin):
    list_display = ["run", "frame", "seconds", "suspicious", "created_at"]
    list_select_related = ["run", "frame"]
    search_fields = ["=run__id", "=frame__number"]


@admin.register(Proposal)
class ProposalAdmin(LookOnlyAdmin):
    list_display = ["pk", "proposal_frame_id", "position", "score", "method", "track", "certainty", "filled"]
    list_filter = ["method", "seated", "filled"]
    search_fields = ["=id", "=track", "=position"]
    raw_id_fields = ["proposal_frame"]


@admin.register(PictureBoxes)
class PictureBoxesAdmin(LookOnlyAdmin):
    list_display = ["picture", "model", "created_at"]
    search_fields = ["=picture", "model"]


@admin.register(Refusal)
class RefusalAdmin(LookOnlyAdmin):
    list_display = ["layer", "frame", "position", "worker", "user", "created_at"]
    list_select_related = ["layer", "frame", "worker", "user"]
    search_fields = ["layer__name", "=frame__number", "=position"]
