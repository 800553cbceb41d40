"""Named proofs that a worker can do it: a few frames with known truth, scored in metres."""

from __future__ import annotations

from django.conf import settings
from django.core.validators import MaxValueValidator, MinValueValidator
from django.db import models
from django.db.models import Q

from gtm_hit.models.annotation import Layer
from gtm_hit.models.campaign import Campaign
from gtm_hit.models.dataset import Dataset, Frame, name_validator

SHARE = [MinValueValidator(0.0), MaxValueValidator(1.0)]
METRES = [MinValueValidator(0.01), MaxValueValidator(0.5)]


class Qualification(models.Model):
    """Frames of a dataset whose truth is known, and how good one has to be in them."""

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="qualifications")
    name = models.CharField(max_length=120, validators=[name_validator])
    title = models.CharField(max_length=200, blank=True, help_text="what workers read")
    truth = models.ForeignKey(Layer, on_delete=models.PROTECT, related_name="+")
    frames = models.ManyToManyField(Frame, related_name="+", help_text="all tries together")
    frames_per_try = models.PositiveSmallIntegerField(default=5, validators=[MinValueValidator(1)])
    tries = models.PositiveSmallIntegerField(
        default=2, validators=[MinValueValidator(1), MaxValueValidator(100)], help_text="per worker"
    )
    min_recall = models.FloatField(default=0.9, validators=SHARE)
    min_precision = models.FloatField(default=0.9, validators=SHARE)
    max_median = models.FloatField(default=0.15, validators=METRES, help_text="metres")
    max_p95 = models.FloatField(default=0.4, validators=METRES, help_text="metres")
    min_idf1 = models.FloatField(default=0.8, validators=SHARE)
    closed_at = models.DateTimeField(null=True, blank=True, help_text="no new tries since then")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["dataset", "name"]
        constraints = [models.UniqueConstraint(fields=["dataset", "name"], name="qualification_name_once")]

    def __str__(self) -> str:
        return self.name

    @property
    def shown_name(self) -> str:
        return self.title or self.name


class QualificationAttempt(models.Model):
    """One try: an assignment of its own, and what came out."""

    qualification = models.ForeignKey(Qualification, on_delete=models.PROTECT, related_name="attempts")
    worker = models.ForeignKey("gtm_hit.Worker", on_delete=models.PROTECT, related_name="attempts")
    assignment = models.OneToOneField("gtm_hit.Assignment", on_delete=models.PROTECT, related_name="attempt")
    number = models.PositiveSmallIntegerField(help_text="the worker's n-th try")
    started_at = models.DateTimeField(auto_now_add=True)
    scored_at = models.DateTimeField(null=True, blank=True)
    passed = models.BooleanField(null=True, help_text="empty: not submitted yet")
    result = models.JSONField(default=dict, blank=True, help_text="shares and metres")

    class Meta:
        ordering = ["-started_at"]
        constraints = [
            models.UniqueConstraint(fields=["qualification", "worker", "number"], name="attempt_number_once"),
        ]

    def __str__(self) -> str:
        return f"{self.worker} at {self.qualification}, try {self.number}"


class QualificationGrant(models.Model):
    """Given or taken away; rows are only ever added, the newest counts."""

    qualification = models.ForeignKey(Qualification, on_delete=models.CASCADE, related_name="grants")
    worker = models.ForeignKey("gtm_hit.Worker", on_delete=models.PROTECT, related_name="grants")
    granted = models.BooleanField(help_text="no: revoked")
    attempt = models.ForeignKey(
        QualificationAttempt, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    by = models.ForeignKey(
        settings.AUTH_USER_MODEL,
        null=True,
        blank=True,
        on_delete=models.SET_NULL,
        related_name="+",
        help_text="empty: a passed try",
    )
    why = models.TextField(blank=True)
    at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["-pk"]
        indexes = [models.Index(fields=["qualification", "worker"])]
        constraints = [
            models.CheckConstraint(
                condition=Q(granted=True) | ~Q(why=""), name="revoking_a_qualification_says_why"
            ),
        ]

    def __str__(self) -> str:
        return f"{self.worker} {'has' if self.granted else 'lost'} {self.qualification}"


class RequiredQualification(models.Model):
    """Who may come into a campaign has all of these."""

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="required_qualifications")
    qualification = models.ForeignKey(Qualification, on_delete=models.PROTECT, related_name="required_by")

    class Meta:
        ordering = ["campaign", "qualification"]
        constraints = [
            models.UniqueConstraint(fields=["campaign", "qualification"], name="required_qualification_once"),
        ]

    def __str__(self) -> str:
        return f"{self.campaign} asks for {self.qualification}"
