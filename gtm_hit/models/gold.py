"""Known truth inside ordinary work, deliberate errors in what is carried over, and what became of them."""

from __future__ import annotations

from django.core.validators import MaxValueValidator, MinValueValidator
from django.db import models
from django.db.models import Q

from gtm_hit.models.annotation import Layer, Save
from gtm_hit.models.campaign import Campaign
from gtm_hit.models.dataset import Frame
from gtm_hit.models.work import Assignment

SHARE = [MinValueValidator(0.0), MaxValueValidator(1.0)]


class GoldFrame(models.Model):
    """A frame of a campaign whose truth is known; its batch holds it like any other frame."""

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="gold_frames")
    frame = models.ForeignKey(Frame, on_delete=models.CASCADE, related_name="+")
    truth = models.ForeignKey(Layer, on_delete=models.PROTECT, related_name="+")
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["campaign", "frame"]
        constraints = [models.UniqueConstraint(fields=["campaign", "frame"], name="gold_frame_once")]

    def __str__(self) -> str:
        return f"{self.campaign} {self.frame}"


class Planting(models.Model):
    """What a campaign's batches start with, and how many faults are planted in it."""

    campaign = models.OneToOneField(Campaign, on_delete=models.CASCADE, related_name="planting")
    starting_layer = models.ForeignKey(
        Layer,
        null=True,
        blank=True,
        on_delete=models.PROTECT,
        related_name="+",
        help_text="whom batches start with; empty: accepted work in frames shared with a neighbour",
    )
    share = models.FloatField(default=0.0, validators=SHARE, help_text="of the batches that get faults")
    faults = models.PositiveSmallIntegerField(
        default=2,
        validators=[MinValueValidator(1), MaxValueValidator(20)],
        help_text="per such batch",
    )
    kinds = models.JSONField(default=list, help_text="kinds of faults")
    seed = models.PositiveIntegerField(default=1, help_text="the same seed plants the same")

    class Meta:
        constraints = [
            models.CheckConstraint(condition=Q(share__range=(0, 1)), name="planting_share_is_a_share"),
        ]

    def __str__(self) -> str:
        return f"{self.campaign}: faults in {self.share:.0%}"


class PlantedFault(models.Model):
    """A deliberate error in what an assignment started with, and whether it was repaired."""

    class Kind(models.TextChoices):
        SHIFTED = "shifted", "person shifted"
        REMOVED = "removed", "person removed"
        SWAPPED = "swapped", "identities swapped"
        INVENTED = "invented", "person who is not there"

    assignment = models.ForeignKey(Assignment, on_delete=models.CASCADE, related_name="planted_faults")
    frame = models.ForeignKey(Frame, on_delete=models.CASCADE, related_name="+")
    kind = models.CharField(max_length=10, choices=Kind.choices)
    person = models.PositiveIntegerField()
    other = models.PositiveIntegerField(null=True, blank=True, help_text="of a swap: the second person")
    position_from = models.PositiveIntegerField(null=True, blank=True, help_text="empty: nobody was there")
    position_to = models.PositiveIntegerField(null=True, blank=True, help_text="empty: removed")
    planted_at = models.DateTimeField(auto_now_add=True)
    repaired = models.BooleanField(null=True, help_text="empty: not judged yet")
    judged_at = models.DateTimeField(null=True, blank=True)
    withdrawn_by = models.ForeignKey(
        Save,
        null=True,
        blank=True,
        on_delete=models.RESTRICT,
        related_name="+",
        help_text="the save that took out what the worker left of it",
    )

    class Meta:
        ordering = ["assignment", "frame", "person"]
        constraints = [
            models.UniqueConstraint(fields=["assignment", "frame", "person"], name="planted_fault_once"),
            models.CheckConstraint(
                condition=Q(kind="swapped", other__isnull=False) | ~Q(kind="swapped"),
                name="planted_swap_names_two",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.kind} {self.person} in {self.frame} of {self.assignment}"
