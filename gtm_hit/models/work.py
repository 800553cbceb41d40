"""Who annotates what: workers, batches, and the leases that join them."""

from __future__ import annotations

import secrets

from django.conf import settings
from django.db import models
from django.db.models import Q
from django.utils import timezone

from gtm_hit.models.annotation import Layer
from gtm_hit.models.campaign import Campaign
from gtm_hit.models.dataset import Dataset, Frame


def pseudonym() -> str:
    return "w-" + secrets.token_hex(5)


def completion_code() -> str:
    """20 characters, 100 bits, without letters that are misread."""
    return "".join(secrets.choice("ABCDEFGHJKLMNPQRSTUVWXYZ23456789") for _ in range(20))


def nonce() -> str:
    """Part of an assignment's token; changing it revokes every link handed out."""
    return secrets.token_hex(16)


class Worker(models.Model):
    """Whoever annotates; the platform's own id is opaque and never leaves the server."""

    platform = models.SlugField(max_length=40, default="link")
    external_id = models.CharField(max_length=255)
    pseudonym = models.CharField(max_length=20, unique=True, default=pseudonym, editable=False)
    user = models.OneToOneField(
        settings.AUTH_USER_MODEL,
        null=True,
        blank=True,
        on_delete=models.SET_NULL,
        related_name="worker",
        help_text="the account of who works with a login",
    )
    nonce = models.CharField(
        max_length=32,
        blank=True,
        editable=False,
        help_text="part of the worker's own links; a new one revokes them all",
    )
    tutorial_steps = models.JSONField(default=list, blank=True, help_text="steps of the tutorial done right")
    tutorial_done_at = models.DateTimeField(null=True, blank=True)
    browser = models.CharField(
        max_length=64, blank=True, editable=False, help_text="digest of the secret of the browser he began in"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["-created_at"]
        constraints = [
            models.UniqueConstraint(fields=["platform", "external_id"], name="worker_once_per_platform"),
            models.CheckConstraint(condition=~Q(external_id=""), name="worker_has_external_id"),
        ]

    def __str__(self) -> str:
        return self.pseudonym


class OrdinaryBatches(models.Manager["Batch"]):
    """Without those of qualifications, which are handed out to one worker for one try."""

    def get_queryset(self) -> models.QuerySet[Batch]:
        return super().get_queryset().filter(qualification__isnull=True)


class Batch(models.Model):
    """Consecutive frames to be annotated together. Several copies give several opinions."""

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="batches")
    campaign = models.ForeignKey(
        Campaign,
        null=True,
        blank=True,
        on_delete=models.PROTECT,
        related_name="batches",
        help_text="empty: made for the dataset itself",
    )
    qualification = models.ForeignKey(
        "gtm_hit.Qualification",
        null=True,
        blank=True,
        on_delete=models.PROTECT,
        related_name="batches",
        help_text="a try of it; its number is 0",
    )
    number = models.PositiveIntegerField(help_text="position along the dataset, from 1")
    copy = models.PositiveSmallIntegerField(default=1, help_text="the n-th independent annotation")
    frames = models.ManyToManyField(Frame, related_name="batches")
    created_at = models.DateTimeField(auto_now_add=True)

    objects = OrdinaryBatches()
    with_qualifications: models.Manager[Batch] = models.Manager()

    class Meta:
        ordering = ["dataset", "copy", "number"]
        verbose_name_plural = "batches"
        constraints = [
            models.UniqueConstraint(
                fields=["dataset", "number", "copy"],
                condition=Q(campaign__isnull=True, qualification__isnull=True),
                name="batch_number_once",
            ),
            models.UniqueConstraint(
                fields=["campaign", "number", "copy"], name="batch_number_once_in_campaign"
            ),
        ]

    def __str__(self) -> str:
        if self.qualification_id is not None:
            return f"{self.dataset} qualification"
        return f"{self.dataset} batch {self.number}" + (f"/{self.copy}" if self.copy > 1 else "")


class Assignment(models.Model):
    """One batch leased to one worker; owns one layer."""

    class State(models.TextChoices):
        LEASED = "leased", "being annotated"
        EXPIRED = "expired", "expired"
        SUBMITTED = "submitted", "submitted"
        ACCEPTED = "accepted", "accepted"
        RETURNED = "returned", "returned with comments"
        REJECTED = "rejected", "rejected"

    # States in which nobody else may have the batch.
    HOLDING = [State.LEASED, State.SUBMITTED, State.ACCEPTED, State.RETURNED]
    EDITABLE = [State.LEASED, State.RETURNED]

    batch = models.ForeignKey(Batch, on_delete=models.PROTECT, related_name="assignments")
    worker = models.ForeignKey(Worker, on_delete=models.PROTECT, related_name="assignments")
    layer = models.OneToOneField(Layer, on_delete=models.PROTECT, related_name="assignment")
    state = models.CharField(max_length=12, choices=State.choices, default=State.LEASED)
    nonce = models.CharField(max_length=32, default=nonce, editable=False)
    leased_at = models.DateTimeField(default=timezone.now)
    expires_at = models.DateTimeField()
    submitted_at = models.DateTimeField(null=True, blank=True)
    code = models.CharField(max_length=20, unique=True, null=True, blank=True, editable=False)
    submission = models.CharField(
        max_length=120, blank=True, editable=False, help_text="the platform's own id of this piece of work"
    )
    takes = models.PositiveIntegerField(default=1, editable=False, help_text="how often taken before a save")
    address = models.CharField(
        max_length=64, blank=True, editable=False, help_text="digest of the address it was taken from"
    )

    class Meta:
        ordering = ["-leased_at"]
        # How many batches a worker may hold at once is the campaign's rule; `claim` locks the worker for it.
        indexes = [
            models.Index(fields=["address", "leased_at"]),
            models.Index(fields=["worker", "submission"], name="assignment_submission"),
        ]
        constraints = [
            models.UniqueConstraint(
                fields=["batch"],
                condition=Q(state__in=["leased", "submitted", "accepted", "returned"]),
                name="batch_held_by_one",
            ),
            models.CheckConstraint(
                condition=Q(state__in=["leased", "expired"]) | Q(submitted_at__isnull=False),
                name="submitted_has_time",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.batch} by {self.worker}"

    @property
    def editable(self) -> bool:
        return self.state in self.EDITABLE and (
            self.state == self.State.RETURNED or self.expires_at > timezone.now()
        )
