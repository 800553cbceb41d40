"""Marks by which a camera is known to stand still, and what looking for them again has told."""

from __future__ import annotations

from django.conf import settings
from django.db import models

from gtm_hit.models.calibration import Calibration
from gtm_hit.models.dataset import Camera, Dataset
from gtm_hit.models.job import Job


class DriftMarks(models.Model):
    """One camera's, for one calibration: remembered again, they replace those that were there."""

    calibration = models.ForeignKey(Calibration, on_delete=models.CASCADE, related_name="drift_marks")
    camera = models.ForeignKey(Camera, on_delete=models.CASCADE, related_name="drift_marks")
    frames = models.JSONField(help_text="numbers of the frames they were taken from")
    count = models.PositiveIntegerField(help_text="how many marks")
    content = models.JSONField(help_text="size of the picture; place and piece of each mark")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now=True)

    class Meta:
        ordering = ["calibration", "camera__index"]
        constraints = [
            models.UniqueConstraint(fields=["calibration", "camera"], name="drift_marks_once"),
        ]

    def __str__(self) -> str:
        return f"marks of {self.camera} for {self.calibration}"


class DriftCheck(models.Model):
    """All cameras over a range of frames, compared with the marks of one calibration."""

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="drift_checks")
    calibration = models.ForeignKey(Calibration, on_delete=models.CASCADE, related_name="drift_checks")
    job = models.OneToOneField(
        Job, null=True, blank=True, on_delete=models.SET_NULL, related_name="drift_check"
    )
    frames = models.JSONField(help_text="numbers of the frames looked at")
    cameras = models.JSONField(help_text="per camera: verdict, figures, and the figures of every frame")
    warns = models.BooleanField(help_text="a camera has moved by more than is tolerated")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["-created_at", "-pk"]

    def __str__(self) -> str:
        return f"drift of {self.dataset}, check {self.pk}"
