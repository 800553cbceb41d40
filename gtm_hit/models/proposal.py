"""People whom programs propose. Nothing here is an annotation: that takes a human who accepts."""

from __future__ import annotations

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.models.annotation import Layer
from gtm_hit.models.dataset import Dataset, Frame


class ProposalRun(models.Model):
    """One way of proposing, over a dataset's frames; frames are added as they are looked at."""

    class Method(models.TextChoices):
        COVER = "cover", "detector and background, fused"
        BACKGROUND = "background", "background alone"
        POM = "pom", "probabilistic occupancy map"
        PROJECTED = "projected", "detections, projected and clustered"
        LOCATED = "located", "places of a multi-view model"
        FILE = "file", "read from a file"

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="proposal_runs")
    method = models.CharField(max_length=12, choices=Method.choices)
    model = models.CharField(max_length=200, blank=True, help_text="the detector's name and version")
    parameters = models.JSONField(default=dict)
    digest = models.CharField(max_length=64, help_text="of everything but the pictures that it depends on")
    in_use = models.BooleanField(default=False, help_text="its people are shown to annotators")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["-created_at", "-pk"]
        constraints = [
            models.UniqueConstraint(fields=["dataset", "digest"], name="proposal_run_once"),
            models.UniqueConstraint(
                fields=["dataset"], condition=Q(in_use=True), name="one_proposal_run_in_use"
            ),
        ]

    def __str__(self) -> str:
        return f"{self.get_method_display()} {self.pk}"


class ProposalFrame(models.Model):
    """A frame that a run has looked at; that nobody was found is a finding, too."""

    run = models.ForeignKey(ProposalRun, on_delete=models.CASCADE, related_name="frames")
    frame = models.ForeignKey(Frame, on_delete=models.CASCADE, related_name="proposal_frames")
    pictures = models.CharField(max_length=64, help_text="digest of the pictures looked at")
    suspicious = models.JSONField(default=list, help_text="cameras that disagree with all others")
    seconds = models.FloatField(default=0, help_text="that looking took")
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["run", "frame"]
        constraints = [models.UniqueConstraint(fields=["run", "frame"], name="proposal_frame_once")]

    def __str__(self) -> str:
        return f"{self.run} {self.frame}"


class Proposal(models.Model):
    """Somebody who seems to stand there, and why."""

    proposal_frame = models.ForeignKey(ProposalFrame, on_delete=models.CASCADE, related_name="people")
    position = models.PositiveIntegerField(help_text="the nearest of the grid")
    x = models.FloatField(help_text="metres")
    y = models.FloatField(help_text="metres")
    height = models.FloatField(null=True, blank=True, help_text="metres; empty: the dataset's cylinder")
    radius = models.FloatField(null=True, blank=True, help_text="metres; empty: the dataset's cylinder")
    score = models.FloatField(help_text="0 to 1")
    method = models.CharField(max_length=12, help_text="what found them")
    seated = models.BooleanField(default=False)
    filled = models.BooleanField(default=False, help_text="seen before and after, not in this frame")
    evidence = models.JSONField(default=list, help_text="per view: box, share not background, hidden")
    track = models.PositiveIntegerField(null=True, blank=True, help_text="who is who within the run")
    certainty = models.FloatField(default=1.0, help_text="0 to 1: that the track goes on with this one")

    class Meta:
        ordering = ["proposal_frame", "-score", "pk"]
        constraints = [
            models.CheckConstraint(condition=Q(score__gte=0, score__lte=1), name="proposal_score_share"),
        ]

    def __str__(self) -> str:
        return f"{self.score:.2f} at {self.position}"


class PictureBoxes(models.Model):
    """What a detector found in one picture: the slow part, kept by what it depends on."""

    picture = models.CharField(max_length=64, help_text="SHA-256 of the picture")
    model = models.CharField(max_length=200, help_text="the detector's name and version")
    boxes = models.JSONField(help_text="x1, y1, x2, y2 in pixels of the calibrated picture, score")
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        verbose_name_plural = "picture boxes"
        constraints = [models.UniqueConstraint(fields=["picture", "model"], name="picture_boxes_once")]

    def __str__(self) -> str:
        return f"{self.picture[:12]} {self.model}"


class Refusal(models.Model):
    """Somebody looked and said that nobody stands there. It outlives the run that proposed them."""

    layer = models.ForeignKey(Layer, on_delete=models.CASCADE, related_name="refusals")
    frame = models.ForeignKey(Frame, on_delete=models.CASCADE, related_name="+")
    position = models.PositiveIntegerField()
    worker = models.ForeignKey(
        "gtm_hit.Worker", null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    user = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["layer", "frame", "position"]
        constraints = [
            models.UniqueConstraint(fields=["layer", "frame", "position"], name="refusal_once"),
        ]

    def __str__(self) -> str:
        return f"nobody at {self.position}"
