from __future__ import annotations

from gtm_hit.models.access import Attempt, EntryLink
from gtm_hit.models.annotation import Annotation, AppendOnlyError, Layer, LayerFrame, Save
from gtm_hit.models.api_token import ApiToken
from gtm_hit.models.calibration import Calibration, CalibrationPlacement
from gtm_hit.models.campaign import Campaign, CampaignWorker
from gtm_hit.models.campaign_link import CampaignLink
from gtm_hit.models.dataset import Camera, Dataset, Frame, Image
from gtm_hit.models.desk import (
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
from gtm_hit.models.drift import DriftCheck, DriftMarks
from gtm_hit.models.gold import GoldFrame, PlantedFault, Planting
from gtm_hit.models.job import Job
from gtm_hit.models.money import MoneyEntry, WorkClock
from gtm_hit.models.outbox import HookEvent, OutboxRow, PlatformAccount, Submission
from gtm_hit.models.proposal import PictureBoxes, Proposal, ProposalFrame, ProposalRun, Refusal
from gtm_hit.models.qualification import (
    Qualification,
    QualificationAttempt,
    QualificationGrant,
    RequiredQualification,
)
from gtm_hit.models.release import Release
from gtm_hit.models.review import Appeal, Category, Comment, Mend, ReviewChoice, Transition
from gtm_hit.models.role import Membership, Role, RoleChange
from gtm_hit.models.score import AssignmentScore, WorkerScore
from gtm_hit.models.stitching import StitchConflict, StitchedFrame, Stitching, StitchingRun
from gtm_hit.models.sync import VideoSync, VideoSyncState
from gtm_hit.models.work import Assignment, Batch, Worker

__all__ = [
    "Annotation",
    "ApiToken",
    "Appeal",
    "AppendOnlyError",
    "Assignment",
    "AssignmentScore",
    "Attempt",
    "Batch",
    "BoardPicture",
    "Calibration",
    "CalibrationPlacement",
    "Camera",
    "Campaign",
    "CampaignLink",
    "CampaignWorker",
    "Category",
    "Click",
    "ClickDecision",
    "ClickFile",
    "Comment",
    "Dataset",
    "Desk",
    "DeskAdjustment",
    "DeskCamera",
    "DeskEdit",
    "DeskPicture",
    "DriftCheck",
    "DriftMarks",
    "EntryLink",
    "Frame",
    "GoldFrame",
    "HookEvent",
    "Image",
    "Job",
    "KeptClick",
    "KeptPoint",
    "Layer",
    "LayerFrame",
    "MeasuredPoint",
    "Membership",
    "Mend",
    "MoneyEntry",
    "OutboxRow",
    "PictureBoxes",
    "PlantedFault",
    "Planting",
    "PlatformAccount",
    "Proposal",
    "ProposalFrame",
    "ProposalRun",
    "Qualification",
    "QualificationAttempt",
    "QualificationGrant",
    "Refusal",
    "Release",
    "RequiredQualification",
    "ReviewChoice",
    "Role",
    "RoleChange",
    "Save",
    "StitchConflict",
    "StitchedFrame",
    "Stitching",
    "StitchingRun",
    "Submission",
    "Transition",
    "VideoSync",
    "VideoSyncState",
    "WorkClock",
    "Worker",
    "WorkerScore",
]
