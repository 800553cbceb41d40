"""Qualifications, gold frames, planted faults and scores."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin.look_only import LookOnlyAdmin
from gtm_hit.models import (
    AssignmentScore,
    GoldFrame,
    PlantedFault,
    Planting,
    Qualification,
    QualificationAttempt,
    QualificationGrant,
    RequiredQualification,
    WorkerScore,
)


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
