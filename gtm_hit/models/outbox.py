"""What is to be told to a campaign's platform, and what the platform told us."""

from __future__ import annotations

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.models.campaign import Campaign


class PlatformAccount(models.Model):
    """How to reach a campaign's study on its platform. The key goes in and is never shown again."""

    campaign = models.OneToOneField(Campaign, on_delete=models.CASCADE, related_name="account")
    address = models.CharField(max_length=200, blank=True, help_text="empty: the first one this server knows")
    token = models.CharField(max_length=200, blank=True, editable=False, help_text="empty: the server's own")
    hook_secret = models.CharField(max_length=200, blank=True, editable=False)
    study = models.CharField(max_length=64, blank=True, help_text="the platform's id of the study")
    study_state = models.CharField(max_length=40, blank=True, help_text="in the platform's words")
    completion_code = models.CharField(max_length=40, blank=True)
    changed_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    changed_at = models.DateTimeField(auto_now=True)

    def __str__(self) -> str:
        return f"account of {self.campaign}"


class Submission(models.Model):
    """One piece of work as the platform sees it: its newest status, in the platform's words."""

    RETURNED = "RETURNED"  # its worker gave it back: nothing is paid for it

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="submissions")
    submission = models.CharField(max_length=120, help_text="the platform's id")
    participant = models.CharField(max_length=255, blank=True)
    status = models.CharField(max_length=40)
    status_at = models.DateTimeField(help_text="when the platform said so, by its clock")

    class Meta:
        ordering = ["campaign", "submission"]
        constraints = [
            models.UniqueConstraint(fields=["campaign", "submission"], name="submission_once_in_campaign")
        ]

    def __str__(self) -> str:
        return f"{self.submission} {self.status}"


class HookEvent(models.Model):
    """A message of the platform that was taken in, so that a second delivery is known for what it is."""

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="hook_events")
    event_id = models.CharField(max_length=120)
    kind = models.CharField(max_length=60)
    received_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["-received_at"]
        constraints = [
            models.UniqueConstraint(fields=["campaign", "event_id"], name="hook_event_once_in_campaign")
        ]

    def __str__(self) -> str:
        return f"{self.kind} {self.event_id}"


class OutboxRow(models.Model):
    """One thing to be done at the platform: planned → sent → confirmed or failed, once and for all.

    `sent` is written before the request goes out: whatever is still `sent` when nobody sends has lost its
    answer. `unclear`: the platform could not tell what became of it; a person decides.
    """

    class Kind(models.TextChoices):
        APPROVE = "approve", "approve"
        REJECT = "reject", "reject"
        REQUEST_RETURN = "request_return", "ask to return it"
        BONUS_SETUP = "bonus_setup", "prepare a bonus"
        BONUS_PAY = "bonus_pay", "pay a bonus"

    class State(models.TextChoices):
        PLANNED = "planned", "planned"
        SENT = "sent", "sent, no answer yet"
        CONFIRMED = "confirmed", "confirmed"
        FAILED = "failed", "failed"
        UNCLEAR = "unclear", "unclear"
        WITHDRAWN = "withdrawn", "withdrawn before it was sent"

    UNDER_WAY = [State.PLANNED, State.SENT, State.UNCLEAR]
    MONEY = [Kind.APPROVE, Kind.BONUS_PAY]

    campaign = models.ForeignKey(Campaign, on_delete=models.PROTECT, related_name="outbox")
    kind = models.CharField(max_length=16, choices=Kind.choices)
    state = models.CharField(max_length=10, choices=State.choices, default=State.PLANNED)
    key = models.CharField(max_length=200, help_text="names the reason; nothing is planned twice")
    worker = models.ForeignKey("gtm_hit.Worker", on_delete=models.PROTECT, related_name="+")
    assignment = models.ForeignKey(
        "gtm_hit.Assignment", null=True, blank=True, on_delete=models.PROTECT, related_name="outbox"
    )
    submission = models.CharField(
        max_length=255, help_text="the platform's id of the work or the participant"
    )
    amount = models.DecimalField(
        max_digits=11, decimal_places=2, default=0, help_text="what reaches the worker by it"
    )
    payload = models.JSONField(default=dict, blank=True)
    result = models.JSONField(default=dict, blank=True)
    after = models.ForeignKey(
        "self",
        null=True,
        blank=True,
        on_delete=models.PROTECT,
        related_name="next",
        help_text="must be done first",
    )
    attempts = models.PositiveSmallIntegerField(default=0)
    error = models.TextField(blank=True)
    not_before = models.DateTimeField(null=True, blank=True)
    sent_at = models.DateTimeField(null=True, blank=True)
    done_at = models.DateTimeField(null=True, blank=True)
    planned_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    decided_by = models.ForeignKey(
        settings.AUTH_USER_MODEL,
        null=True,
        blank=True,
        on_delete=models.SET_NULL,
        related_name="+",
        help_text="who said by hand what became of it",
    )
    planned_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["pk"]
        indexes = [models.Index(fields=["campaign", "state"])]
        constraints = [
            models.UniqueConstraint(
                fields=["campaign", "key"], condition=~Q(state="withdrawn"), name="outbox_planned_once"
            ),
            models.CheckConstraint(condition=Q(amount__gte=0), name="outbox_amount_not_negative"),
        ]

    def __str__(self) -> str:
        return f"{self.get_kind_display()} {self.submission} ({self.state})"
