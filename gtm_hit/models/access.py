"""Which links are open, and who tried too often."""

from __future__ import annotations

from django.db import models
from django.utils import timezone

from gtm_hit.models.dataset import Dataset


class EntryLink(models.Model):
    """The general link of a dataset for one platform; there is a row once somebody closed it."""

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="entry_links")
    platform = models.SlugField(max_length=40, default="link")
    nonce = models.CharField(max_length=32, blank=True, editable=False, help_text="changed by every opening")
    closed_at = models.DateTimeField(null=True, blank=True)

    class Meta:
        constraints = [
            models.UniqueConstraint(fields=["dataset", "platform"], name="entry_link_once_per_platform"),
        ]

    def __str__(self) -> str:
        return f"{self.dataset} for {self.platform}"


class Attempt(models.Model):
    """One try of something that is limited; in the database, because all processes count together."""

    key = models.CharField(max_length=64, help_text="digest of what is limited and for whom")
    at = models.DateTimeField(default=timezone.now)

    class Meta:
        indexes = [models.Index(fields=["key", "at"]), models.Index(fields=["at"])]

    def __str__(self) -> str:
        return f"{self.key[:8]} at {self.at}"
