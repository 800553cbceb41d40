"""What the numbers say about a piece of work and about a worker; computed anew at any time."""

from __future__ import annotations

from django.db import models
from django.db.models import F, Q

from gtm_hit.models.campaign import Campaign
from gtm_hit.models.work import Assignment, Worker


class AssignmentScore(models.Model):
    """What was counted in one submitted assignment, and how suspicious that looks."""

    assignment = models.OneToOneField(Assignment, on_delete=models.CASCADE, related_name="score")
    evidence = models.JSONField(help_text="counts; sums of them are a worker's evidence")
    suspicion = models.FloatField(help_text="0 nothing, 1 everything speaks against it")
    reasons = models.JSONField(default=list)
    computed_at = models.DateTimeField()

    class Meta:
        constraints = [
            models.CheckConstraint(
                condition=Q(suspicion__gte=0) & Q(suspicion__lte=1), name="suspicion_is_a_share"
            ),
        ]
        indexes = [models.Index(fields=["-suspicion"])]

    def __str__(self) -> str:
        return f"{self.assignment}: {self.suspicion:.2f}"


class WorkerScore(models.Model):
    """0 to 100 with an interval that holds the true value nine times out of ten."""

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="worker_scores")
    worker = models.ForeignKey(Worker, on_delete=models.PROTECT, related_name="scores")
    score = models.FloatField()
    low = models.FloatField()
    high = models.FloatField()
    assignments = models.PositiveIntegerField(default=0, help_text="that were measured")
    reasons = models.JSONField(default=list, help_text="parts of the score, what cost most first")
    computed_at = models.DateTimeField()

    class Meta:
        ordering = ["campaign", "score"]
        constraints = [
            models.UniqueConstraint(fields=["campaign", "worker"], name="worker_score_once"),
            models.CheckConstraint(
                condition=Q(low__gte=0) & Q(low__lte=F("score")) & Q(score__lte=F("high")) & Q(high__lte=100),
                name="worker_score_inside_interval",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.worker}: {self.score:.0f} ({self.low:.0f} to {self.high:.0f})"
