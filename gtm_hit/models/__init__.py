from __future__ import annotations

from gtm_hit.models.access import Attempt, EntryLink
from gtm_hit.models.annotation import Annotation, AppendOnlyError, Layer, LayerFrame, Save
from gtm_hit.models.api_token import ApiToken
from gtm_hit.models.calibration import Calibration
from gtm_hit.models.campaign import Campaign, CampaignWorker
from gtm_hit.models.dataset import Camera, Dataset, Frame, Image
from gtm_hit.models.gold import GoldFrame, PlantedFault, Planting
from gtm_hit.models.job import Job
from gtm_hit.models.qualification import (
    Qualification,
    QualificationAttempt,
    QualificationGrant,
    RequiredQualification,
)
from gtm_hit.models.release import Release
from gtm_hit.models.score import AssignmentScore, WorkerScore
from gtm_hit.models.work import Assignment, Batch, Worker

__all__ = [
    "Annotation",
    "ApiToken",
    "AppendOnlyError",
    "Assignment",
    "AssignmentScore",
    "Attempt",
    "Batch",
    "Calibration",
    "Camera",
    "Campaign",
    "CampaignWorker",
    "Dataset",
    "EntryLink",
    "Frame",
    "GoldFrame",
    "Image",
    "Job",
    "Layer",
    "LayerFrame",
    "PlantedFault",
    "Planting",
    "Qualification",
    "QualificationAttempt",
    "QualificationGrant",
    "Release",
    "RequiredQualification",
    "Save",
    "Worker",
    "WorkerScore",
]
