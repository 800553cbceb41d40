"""What programs found, and what people refused."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import PictureBoxes, Proposal, ProposalFrame, ProposalRun, Refusal


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
