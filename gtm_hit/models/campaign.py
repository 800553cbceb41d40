"""Work handed out under one set of rules: whose frames, to whom, how much of it, for how much."""

from __future__ import annotations

from decimal import Decimal

from django.conf import settings
from django.core.validators import MaxValueValidator, MinValueValidator, RegexValidator
from django.db import models
from django.db.models import F, Q

from gtm_hit.models.dataset import Dataset, name_validator


class Campaign(models.Model):
    """Batches of a dataset + a platform + rules + pay. Money is decimal, in one currency."""

    class State(models.TextChoices):
        DRAFT = "draft", "draft"
        OPEN = "open", "open"
        PAUSED = "paused", "paused"
        CLOSED = "closed", "closed"

    class Platform(models.TextChoices):
        OWN_TEAM = "own_team", "own team, with a login"
        LINK = "link", "any panel, by link and code"
        EXTERNAL_QUESTION = "external_question", "panel that embeds the page (ExternalQuestion)"
        PROLIFIC = "prolific", "Prolific"

    class Entry(models.TextChoices):
        ANYONE = "anyone", "anyone with the link"
        INVITED = "invited", "invited workers"
        QUALIFIED = "qualified", "workers with the qualifications asked for"

    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="campaigns")
    name = models.CharField(max_length=120, validators=[name_validator])
    title = models.CharField(max_length=200, blank=True, help_text="what workers read")
    instructions = models.TextField(blank=True)
    platform = models.CharField(max_length=20, choices=Platform.choices, default=Platform.OWN_TEAM)
    platform_settings = models.JSONField(
        default=dict, blank=True, help_text="checked by the platform's adapter"
    )
    state = models.CharField(max_length=8, choices=State.choices, default=State.DRAFT)
    entry = models.CharField(max_length=10, choices=Entry.choices, default=Entry.ANYONE)

    batch_size = models.PositiveSmallIntegerField(
        default=10, validators=[MinValueValidator(1), MaxValueValidator(500)]
    )
    overlap = models.PositiveSmallIntegerField(default=1, help_text="frames that neighbouring batches share")
    copies = models.PositiveSmallIntegerField(
        default=1, validators=[MinValueValidator(1), MaxValueValidator(20)]
    )
    lease_minutes = models.PositiveIntegerField(default=120, validators=[MinValueValidator(1)])
    batches_per_worker = models.PositiveIntegerField(null=True, blank=True, help_text="empty: no limit")
    batches_at_once = models.PositiveSmallIntegerField(default=1, validators=[MinValueValidator(1)])

    expected_minutes = models.PositiveIntegerField(default=15, help_text="for one batch")
    currency = models.CharField(max_length=3, default="USD", validators=[RegexValidator(r"^[A-Z]{3}\Z")])
    pay_per_batch = models.DecimalField(
        max_digits=9,
        decimal_places=2,
        default=Decimal("0.00"),
        validators=[MinValueValidator(Decimal("0.00"))],
    )
    hourly_floor = models.DecimalField(
        max_digits=9,
        decimal_places=2,
        default=Decimal("0.00"),
        validators=[MinValueValidator(Decimal("0.00"))],
    )
    review_share = models.FloatField(
        default=0.1,
        validators=[MinValueValidator(0.0), MaxValueValidator(1.0)],
        help_text="of a trusted worker's work",
    )
    newcomer_batches = models.PositiveSmallIntegerField(
        default=2, help_text="reviewed in full before anybody is trusted"
    )

    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)
    opened_at = models.DateTimeField(null=True, blank=True)
    closed_at = models.DateTimeField(null=True, blank=True)

    class Meta:
        ordering = ["dataset", "name"]
        constraints = [
            models.UniqueConstraint(fields=["dataset", "name"], name="campaign_name_once"),
            models.CheckConstraint(
                condition=Q(overlap__lt=F("batch_size")), name="campaign_overlap_below_size"
            ),
            models.CheckConstraint(
                condition=Q(pay_per_batch__gte=0) & Q(hourly_floor__gte=0),
                name="campaign_pays_nothing_negative",
            ),
            models.CheckConstraint(
                condition=Q(review_share__gte=0) & Q(review_share__lte=1),
                name="campaign_review_share_is_a_share",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.dataset} {self.name}"


class CampaignWorker(models.Model):
    """What a campaign's manager decided about one worker: invited, or blocked."""

    class Standing(models.TextChoices):
        INVITED = "invited", "invited"
        BLOCKED = "blocked", "blocked"

    campaign = models.ForeignKey(Campaign, on_delete=models.CASCADE, related_name="workers")
    worker = models.ForeignKey("gtm_hit.Worker", on_delete=models.PROTECT, related_name="campaigns")
    standing = models.CharField(max_length=8, choices=Standing.choices)
    reason = models.TextField(blank=True)
    changed_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    changed_at = models.DateTimeField(auto_now=True)

    class Meta:
        constraints = [models.UniqueConstraint(fields=["campaign", "worker"], name="campaign_worker_once")]

    def __str__(self) -> str:
        return f"{self.worker} {self.standing} in {self.campaign}"
