"""Layers of annotations, their current state per frame, and every save that led there."""

from __future__ import annotations

import hashlib
from datetime import UTC
from typing import Any, NoReturn

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.geometry.cylinder import HEIGHTS, RADII
from gtm_hit.models.dataset import Dataset, Frame, name_validator


class AppendOnlyError(TypeError):
    """A row of history was about to be changed or deleted."""


class FinishedLayers(models.Manager["Layer"]):
    """Without those an import is still filling."""

    def get_queryset(self) -> models.QuerySet[Layer]:
        return super().get_queryset().filter(unfinished=False)


class Layer(models.Model):
    """A set of annotations with one author; everything that compares, copies or exports takes layers."""

    class Kind(models.TextChoices):
        ASSIGNMENT = "assignment", "a worker's assignment"
        IMPORTED = "imported", "imported"
        PROPOSAL = "proposal", "proposed by a program"
        STAFF = "staff", "made by staff"
        GROUND_TRUTH = "ground_truth", "ground truth"

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="layers")
    name = models.CharField(max_length=120, validators=[name_validator])
    kind = models.CharField(max_length=20, choices=Kind.choices)
    hidden = models.BooleanField(default=False, help_text="never shown to workers (known truth, gold)")
    unfinished = models.BooleanField(
        default=False, editable=False, help_text="an import is filling it; nobody sees it yet"
    )
    last_person = models.PositiveIntegerField(
        default=0, editable=False, help_text="largest person number any save has used"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    objects = FinishedLayers()
    with_unfinished: models.Manager[Layer] = models.Manager()

    class Meta:
        ordering = ["dataset", "name"]
        constraints = [models.UniqueConstraint(fields=["dataset", "name"], name="layer_name_once")]

    def __str__(self) -> str:
        return self.name

    @property
    def key(self) -> str:
        """A name that no other layer has, on no server: numbers begin anew in every database."""
        made = f"layer {self.pk} {self.created_at.astimezone(UTC).isoformat()}"
        return hashlib.sha256(made.encode()).hexdigest()[:32]


class LayerFrame(models.Model):
    """Where one frame of one layer stands: the newest revision and whether its author is done with it."""

    layer = models.ForeignKey(Layer, on_delete=models.CASCADE, related_name="layer_frames")
    frame = models.ForeignKey(Frame, on_delete=models.CASCADE, related_name="layer_frames")
    revision = models.PositiveIntegerField(default=0)
    done = models.BooleanField(default=False, help_text="the author left the frame as finished")
    nobody = models.BooleanField(default=False, help_text="the author confirmed that nobody is there")
    seconds = models.FloatField(default=0, help_text="active seconds over all saves")
    changed_at = models.DateTimeField(auto_now=True)

    class Meta:
        ordering = ["layer", "frame"]
        constraints = [models.UniqueConstraint(fields=["layer", "frame"], name="layer_frame_once")]

    def __str__(self) -> str:
        return f"{self.layer} {self.frame} r{self.revision}"


class Annotation(models.Model):
    """One person at one position in one frame of one layer."""

    class State(models.TextChoices):
        VALIDATED = "validated", "validated"
        CARRIED = "carried", "carried over, not yet validated"

    class Origin(models.TextChoices):
        CLICKED = "clicked", "clicked"
        CARRIED = "carried", "carried over"
        COPIED = "copied", "copied from another frame"
        INTERPOLATED = "interpolated", "interpolated"
        IMPORTED = "imported", "imported"
        PROPOSED = "proposed", "proposed by a program"

    layer = models.ForeignKey(Layer, on_delete=models.CASCADE, related_name="annotations")
    frame = models.ForeignKey(Frame, on_delete=models.CASCADE, related_name="annotations")
    person = models.PositiveIntegerField(help_text="personID in files")
    position = models.PositiveIntegerField(help_text="positionID in files")
    state = models.CharField(max_length=12, choices=State.choices, default=State.VALIDATED)
    origin = models.CharField(max_length=12, choices=Origin.choices, default=Origin.CLICKED)
    height = models.FloatField(null=True, blank=True, help_text="metres; empty: the dataset's cylinder")
    radius = models.FloatField(null=True, blank=True, help_text="metres; empty: the dataset's cylinder")

    class Meta:
        ordering = ["layer", "frame", "person"]
        constraints = [
            models.UniqueConstraint(fields=["layer", "frame", "person"], name="person_once_per_frame"),
            models.CheckConstraint(
                condition=Q(height__isnull=True) | Q(height__range=HEIGHTS),
                name="annotation_height_sensible",
            ),
            models.CheckConstraint(
                condition=Q(radius__isnull=True) | Q(radius__range=RADII),
                name="annotation_radius_sensible",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.person} at {self.position}"


class Save(models.Model):
    """One accepted save: the whole frame as it was then. Rows are only ever added."""

    layer_frame = models.ForeignKey(LayerFrame, on_delete=models.CASCADE, related_name="saves")
    revision = models.PositiveIntegerField()
    save_id = models.UUIDField(unique=True, help_text="chosen by the sender; makes a repeated save harmless")
    annotations = models.JSONField()
    done = models.BooleanField(default=False)
    nobody = models.BooleanField(default=False)
    seconds = models.FloatField(default=0, help_text="active seconds since the save before")
    user = models.ForeignKey(settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.PROTECT)
    worker = models.ForeignKey("gtm_hit.Worker", null=True, blank=True, on_delete=models.PROTECT)
    calibration = models.ForeignKey(
        "gtm_hit.Calibration",
        null=True,
        editable=False,
        on_delete=models.RESTRICT,
        related_name="+",
        help_text="the version in place then; empty: not known",
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["layer_frame", "revision"]
        constraints = [
            models.UniqueConstraint(fields=["layer_frame", "revision"], name="revision_once"),
            models.CheckConstraint(condition=Q(revision__gte=1), name="revision_from_one"),
            models.CheckConstraint(
                condition=~(Q(user__isnull=False) & Q(worker__isnull=False)), name="save_one_author"
            ),
        ]

    def __str__(self) -> str:
        return f"{self.layer_frame_id} r{self.revision}"

    def save(self, *args: Any, **kwargs: Any) -> None:
        if not self._state.adding:
            raise AppendOnlyError("saves are history: they are added, never changed")
        super().save(*args, **kwargs)

    def delete(self, *args: Any, **kwargs: Any) -> NoReturn:
        raise AppendOnlyError("saves are history: they are added, never deleted")
