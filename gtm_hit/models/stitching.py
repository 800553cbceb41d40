"""How batches became one ground-truth layer: from what, by which rules, and what people decided."""

from __future__ import annotations

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.models.annotation import Layer
from gtm_hit.models.campaign import Campaign
from gtm_hit.models.dataset import Dataset, Frame
from gtm_hit.models.job import Job


class Stitching(models.Model):
    """One ground-truth layer and whose accepted batches go into it."""

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="stitchings")
    campaign = models.OneToOneField(
        Campaign,
        null=True,
        blank=True,
        on_delete=models.CASCADE,
        related_name="stitching",
        help_text="empty: the dataset's batches that belong to no campaign",
    )
    layer = models.OneToOneField(Layer, on_delete=models.PROTECT, related_name="stitching")
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        constraints = [
            models.UniqueConstraint(
                fields=["dataset"], condition=Q(campaign__isnull=True), name="stitching_once_without_campaign"
            ),
        ]

    def __str__(self) -> str:
        return f"stitching of {self.campaign or self.dataset}"


class StitchingRun(models.Model):
    """One time it was done; the newest says how the layer came about."""

    stitching = models.ForeignKey(Stitching, on_delete=models.CASCADE, related_name="runs")
    job = models.OneToOneField(Job, null=True, blank=True, on_delete=models.SET_NULL, related_name="+")
    rules = models.JSONField(help_text="metres, seconds and frames it went by")
    numbers = models.JSONField(help_text="what came out")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["-created_at", "-pk"]

    def __str__(self) -> str:
        return f"run {self.pk} of {self.stitching}"


class StitchedFrame(models.Model):
    """Where the people of one frame of a ground-truth layer come from.

    `sources` is a list per person: the person's number, then layer and person of each annotation it was
    made of. A row per frame keeps an hour's provenance in some ten megabytes.
    """

    layer = models.ForeignKey(Layer, on_delete=models.CASCADE, related_name="stitched_frames")
    frame = models.ForeignKey(Frame, on_delete=models.CASCADE, related_name="+")
    revision = models.PositiveIntegerField(help_text="as stitching left it; a later one is by hand")
    sources = models.JSONField()

    class Meta:
        constraints = [models.UniqueConstraint(fields=["layer", "frame"], name="stitched_frame_once")]

    def __str__(self) -> str:
        return f"{self.layer} {self.frame}"


class StitchConflict(models.Model):
    """Two tracks that may be one person: somebody decides, and every later run remembers.

    A track is known by what it was made of, pairs of layer and person, so that it is found again.
    """

    class Kind(models.TextChoices):
        JOIN = "join", "goes on as"
        RETURN = "return", "came back as"

    class State(models.TextChoices):
        OPEN = "open", "open"
        DECIDED = "decided", "decided"

    class Decision(models.TextChoices):
        SAME = "same", "the same person"
        APART = "apart", "two people"

    stitching = models.ForeignKey(Stitching, on_delete=models.CASCADE, related_name="conflicts")
    kind = models.CharField(max_length=8, choices=Kind.choices)
    key = models.CharField(max_length=64, help_text="digest of both sides")
    before = models.JSONField(help_text="[layer, person] of everything the earlier track was made of")
    after = models.JSONField(help_text="likewise, the later one")
    left_at = models.PositiveIntegerField(help_text="number of the earlier track's last frame")
    came_at = models.PositiveIntegerField(help_text="number of the later track's first frame")
    metres = models.FloatField(help_text="between those two places")
    seconds = models.FloatField(help_text="between them; 0 or less where they share frames")
    lead = models.FloatField(null=True, blank=True, help_text="log odds for one person; empty for a return")
    state = models.CharField(max_length=8, choices=State.choices, default=State.OPEN)
    decision = models.CharField(max_length=8, choices=Decision.choices, blank=True)
    decided_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    decided_at = models.DateTimeField(null=True, blank=True)
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["kind", "left_at", "pk"]
        constraints = [
            models.UniqueConstraint(fields=["stitching", "key"], name="stitch_conflict_once"),
            models.CheckConstraint(
                condition=(
                    Q(state="open", decision="", decided_at__isnull=True)
                    | (Q(state="decided", decided_at__isnull=False) & ~Q(decision=""))
                ),
                name="stitch_conflict_decided_or_open",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.kind} at {self.left_at} and {self.came_at}"
