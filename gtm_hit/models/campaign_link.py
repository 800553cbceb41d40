"""The links that let workers into a campaign: made, used, rotated, revoked, and one day over."""

from __future__ import annotations

import secrets

from django.conf import settings
from django.db import models
from django.db.models import Q
from django.utils import timezone

from gtm_hit.models.campaign import Campaign


def link_nonce() -> str:
    """Part of a link's token; a new one makes every copy of the old address worthless."""
    return secrets.token_hex(8)


class CampaignLink(models.Model):
    """One address. It ends by its date or by a decision, and what was begun through it goes on."""

    class Kind(models.TextChoices):
        GENERAL = "general", "for everybody who is let in"
        PERSONAL = "personal", "one worker's own"
        INVITATION = "invitation", "invitation to an account"

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="links")
    kind = models.CharField(max_length=10, choices=Kind.choices, default=Kind.GENERAL)
    worker = models.ForeignKey(
        "gtm_hit.Worker",
        null=True,
        blank=True,
        on_delete=models.CASCADE,
        related_name="links",
        help_text="whose own it is; of an invitation: who accepted it",
    )
    note = models.CharField(max_length=120, blank=True, help_text="for whom, for the manager's eyes")
    nonce = models.CharField(max_length=16, default=link_nonce, editable=False)
    uses = models.PositiveIntegerField(default=0, help_text="how often somebody came in by it")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)
    expires_at = models.DateTimeField(null=True, blank=True, help_text="empty: until it is revoked")
    revoked_at = models.DateTimeField(null=True, blank=True)

    class Meta:
        ordering = ["-created_at", "-pk"]
        constraints = [
            models.CheckConstraint(
                condition=~Q(kind="personal") | Q(worker__isnull=False), name="personal_link_has_worker"
            ),
            models.CheckConstraint(
                condition=~Q(kind="general") | Q(worker__isnull=True), name="general_link_has_no_worker"
            ),
        ]

    def __str__(self) -> str:
        return f"{self.campaign} link {self.pk}"

    @property
    def state(self) -> str:
        """`open`, `used` (an invitation), `expired` or `revoked`."""
        if self.revoked_at:
            return "revoked"
        if self.kind == self.Kind.INVITATION and self.worker_id:
            return "used"
        if self.expires_at and self.expires_at <= timezone.now():
            return "expired"
        return "open"
