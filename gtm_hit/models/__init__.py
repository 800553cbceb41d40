from __future__ import annotations

from gtm_hit.models.annotation import Annotation, AppendOnlyError, Layer, LayerFrame, Save
from gtm_hit.models.dataset import Camera, Dataset, Frame, Image
from gtm_hit.models.job import Job
from gtm_hit.models.work import Assignment, Batch, Worker

__all__ = [
    "Annotation",
    "AppendOnlyError",
    "Assignment",
    "Batch",
    "Camera",
    "Dataset",
    "Frame",
    "Image",
    "Job",
    "Layer",
    "LayerFrame",
    "Save",
    "Worker",
]
