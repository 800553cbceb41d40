"""Numbered, immutable exports of a layer."""

from __future__ import annotations

from typing import Any

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.models.annotation import AppendOnlyError, Layer
from gtm_hit.models.dataset import Dataset


class Release(models.Model):
    """What was published under a number; its files lie in a folder of their own and never change."""

    dataset = models.ForeignKey(Dataset, on_delete=models.PROTECT, related_name="releases")
    number = models.PositiveIntegerField(help_text="from 1")
    layer = models.ForeignKey(Layer, on_delete=models.PROTECT, related_name="releases")
    calibration = models.ForeignKey(
        "gtm_hit.Calibration",
        null=True,
        editable=False,
        on_delete=models.RESTRICT,
        related_name="+",
        help_text="the version it was made with; empty: not known",
    )
    title = models.CharField(max_length=200, blank=True)
    manifest = models.JSONField(help_text="counts, parameters, digest of every file")
    manifest_digest = models.CharField(max_length=64, help_text="SHA-256 of manifest.json")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="releases"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["dataset", "-number"]
        constraints = [
            models.UniqueConstraint(fields=["dataset", "number"], name="release_number_once"),
            models.CheckConstraint(condition=Q(number__gte=1), name="release_number_from_one"),
        ]

    def __str__(self) -> str:
        return f"{self.dataset} release {self.number}"

    def save(self, *args: Any, **kwargs: Any) -> None:
        if not self._state.adding:
            raise AppendOnlyError("a release never changes: make a new one")
        super().save(*args, **kwargs)
