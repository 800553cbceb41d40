"""Numbered calibrations of a dataset: what its cameras were, each time they were others."""

from __future__ import annotations

from typing import Any

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.models.annotation import AppendOnlyError
from gtm_hit.models.dataset import Dataset


class Calibration(models.Model):
    """All cameras of a dataset as they were put in place together; never changes.

    The dataset's `calibration` is the one in place; the rows of `Camera` hold the same numbers.
    """

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="calibrations")
    number = models.PositiveIntegerField(help_text="from 1")
    cameras = models.JSONField(help_text="the content of a cameras.json")
    digest = models.CharField(max_length=64, help_text="SHA-256 of the cameras' numbers")
    source = models.CharField(max_length=300, blank=True, help_text="where it came from, in words")
    report = models.JSONField(
        default=dict, blank=True, help_text="a desk's: digests of its inputs, settings, figures per camera"
    )
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["dataset", "-number"]
        constraints = [
            models.UniqueConstraint(fields=["dataset", "number"], name="calibration_number_once"),
            models.UniqueConstraint(fields=["dataset", "digest"], name="calibration_digest_once"),
            models.CheckConstraint(condition=Q(number__gte=1), name="calibration_number_from_one"),
        ]

    def __str__(self) -> str:
        return f"{self.dataset} calibration {self.number}"

    def save(self, *args: Any, **kwargs: Any) -> None:
        if not self._state.adding:
            raise AppendOnlyError("a calibration never changes: add another version")
        super().save(*args, **kwargs)


class CalibrationPlacement(models.Model):
    """Another time that a calibration was put in place: somebody went back, or came to the numbers again.

    The first time is told by the calibration itself. What the other one says of its origin is kept as well.
    """

    calibration = models.ForeignKey(Calibration, on_delete=models.CASCADE, related_name="placements")
    source = models.CharField(max_length=300, blank=True, help_text="where it came from, in words")
    report = models.JSONField(default=dict, blank=True, help_text="as the calibration's own")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["calibration", "created_at", "pk"]

    def __str__(self) -> str:
        return f"{self.calibration} again"

    def save(self, *args: Any, **kwargs: Any) -> None:
        if not self._state.adding:
            raise AppendOnlyError("what was put in place when never changes: add another line")
        super().save(*args, **kwargs)
