from __future__ import annotations

from gtm_hit.models.access import Attempt, EntryLink
from gtm_hit.models.annotation import Annotation, AppendOnlyError, Layer, LayerFrame, Save
from gtm_hit.models.api_token import ApiToken
from gtm_hit.models.calibration import Calibration
from gtm_hit.models.campaign import Campaign, CampaignWorker
from gtm_hit.models.dataset import Camera, Dataset, Frame, Image
from gtm_hit.models.job import Job
from gtm_hit.models.proposal import PictureBoxes, Proposal, ProposalFrame, ProposalRun, Refusal
from gtm_hit.models.release import Release
from gtm_hit.models.work import Assignment, Batch, Worker

__all__ = [
    "Annotation",
    "ApiToken",
    "AppendOnlyError",
    "Assignment",
    "Attempt",
    "Batch",
    "Calibration",
    "Camera",
    "Campaign",
    "CampaignWorker",
    "Dataset",
    "EntryLink",
    "Frame",
    "Image",
    "Job",
    "Layer",
    "LayerFrame",
    "PictureBoxes",
    "Proposal",
    "ProposalFrame",
    "ProposalRun",
    "Refusal",
    "Release",
    "Save",
    "Worker",
]
