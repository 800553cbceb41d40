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
    Appeal,
    Assignment,
    AssignmentScore,
    Attempt,
    Batch,
    Calibration,
    Camera,
    Campaign,
    CampaignLink,
    CampaignWorker,
    Comment,
    Dataset,
    EntryLink,
    Frame,
    GoldFrame,
    HookEvent,
    Image,
    Job,
    Layer,
    LayerFrame,
    Membership,
    Mend,
    MoneyEntry,
    OutboxRow,
    PictureBoxes,
    PlantedFault,
    Planting,
    PlatformAccount,
    Proposal,
    ProposalFrame,
    ProposalRun,
    Qualification,
    QualificationAttempt,
    QualificationGrant,
    Refusal,
    Release,
    RequiredQualification,
    ReviewChoice,
    RoleChange,
    Save,
    StitchConflict,
    StitchedFrame,
    Stitching,
    StitchingRun,
    Submission,
    Transition,
    WorkClock,
    Worker,
    WorkerScore,
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


@admin.register(Qualification)
class QualificationAdmin(LookOnlyAdmin):
    list_display = ["name", "dataset", "truth", "frames_per_try", "tries", "closed_at", "created_at"]
    list_filter = ["dataset"]
    list_select_related = ["dataset", "truth"]
    search_fields = ["name", "title", "dataset__slug"]


@admin.register(QualificationAttempt)
class QualificationAttemptAdmin(LookOnlyAdmin):
    list_display = ["qualification", "worker", "number", "passed", "started_at", "scored_at"]
    list_filter = ["passed", "qualification"]
    list_select_related = ["qualification", "worker"]
    search_fields = ["qualification__name", "worker__pseudonym"]


@admin.register(QualificationGrant)
class QualificationGrantAdmin(LookOnlyAdmin):
    list_display = ["qualification", "worker", "granted", "by", "at"]
    list_filter = ["granted", "qualification"]
    list_select_related = ["qualification", "worker", "by"]
    search_fields = ["qualification__name", "worker__pseudonym", "why"]


@admin.register(RequiredQualification)
class RequiredQualificationAdmin(LookOnlyAdmin):
    list_display = ["campaign", "qualification"]
    list_select_related = ["campaign__dataset", "qualification"]
    search_fields = ["campaign__name", "qualification__name"]


@admin.register(GoldFrame)
class GoldFrameAdmin(LookOnlyAdmin):
    list_display = ["campaign", "frame", "truth", "created_at"]
    list_filter = ["campaign"]
    list_select_related = ["campaign__dataset", "frame", "truth"]
    search_fields = ["=frame__number", "campaign__name", "truth__name"]


@admin.register(Planting)
class PlantingAdmin(LookOnlyAdmin):
    list_display = ["campaign", "starting_layer", "share", "faults", "seed"]
    list_select_related = ["campaign__dataset", "starting_layer"]
    search_fields = ["campaign__name"]


@admin.register(PlantedFault)
class PlantedFaultAdmin(LookOnlyAdmin):
    list_display = ["assignment", "frame", "kind", "person", "repaired", "judged_at"]
    list_filter = ["kind", "repaired"]
    list_select_related = ["assignment__batch__dataset", "assignment__worker", "frame"]
    search_fields = ["=frame__number", "=person", "assignment__worker__pseudonym"]


@admin.register(AssignmentScore)
class AssignmentScoreAdmin(LookOnlyAdmin):
    list_display = ["assignment", "suspicion", "computed_at"]
    list_select_related = ["assignment__batch__dataset", "assignment__worker"]
    search_fields = ["assignment__worker__pseudonym"]


@admin.register(WorkerScore)
class WorkerScoreAdmin(LookOnlyAdmin):
    list_display = ["worker", "campaign", "score", "low", "high", "assignments", "computed_at"]
    list_filter = ["campaign"]
    list_select_related = ["worker", "campaign__dataset"]
    search_fields = ["worker__pseudonym", "campaign__name"]


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


@admin.register(ApiToken)
class ApiTokenAdmin(admin.ModelAdmin):
    list_display = ["name", "user", "scopes", "created_at", "expires_at", "last_used_at", "revoked_at"]
    list_filter = [("revoked_at", admin.EmptyFieldListFilter)]
    list_select_related = ["user"]
    search_fields = ["name", "user__username"]
    readonly_fields = ["user", "scopes", "created_at", "last_used_at"]

    def has_add_permission(self, request: HttpRequest) -> bool:
        return False  # a key is shown once, by the page that makes it


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


@admin.register(Campaign)
class CampaignAdmin(LookOnlyAdmin):
    list_display = ["name", "dataset", "platform", "state", "entry", "created_by", "created_at"]
    list_filter = ["state", "platform", "dataset"]
    list_select_related = ["dataset", "created_by"]
    search_fields = ["name", "title", "dataset__slug"]
    exclude = ["platform_settings"]  # with the codes that say whose work is done


@admin.register(CampaignWorker)
class CampaignWorkerAdmin(LookOnlyAdmin):
    list_display = ["worker", "campaign", "standing", "changed_by", "changed_at"]
    list_filter = ["standing", "campaign"]
    list_select_related = ["worker", "campaign__dataset", "changed_by"]
    search_fields = ["worker__pseudonym", "campaign__name", "reason"]


@admin.register(CampaignLink)
class CampaignLinkAdmin(LookOnlyAdmin):
    """What makes an address is in none of its fields."""

    list_display = ["pk", "kind", "campaign", "worker", "uses", "created_at", "expires_at", "revoked_at"]
    list_filter = ["kind", "campaign"]
    list_select_related = ["campaign__dataset", "worker"]
    search_fields = ["campaign__name", "worker__pseudonym", "note"]
