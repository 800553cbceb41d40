"""Money of a campaign's workers: earned, bonuses, paid; and the clock by which time is believed."""

from __future__ import annotations

from typing import Any, NoReturn

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.models.annotation import AppendOnlyError
from gtm_hit.models.campaign import Campaign


class MoneyEntry(models.Model):
    """One line of the ledger. What was wrong is taken back by a line of its own, with the amount negative."""

    class Kind(models.TextChoices):
        EARNED = "earned", "earned"
        BONUS_PROPOSED = "bonus_proposed", "bonus proposed"
        BONUS_APPROVED = "bonus_approved", "bonus approved"
        PAID = "paid", "paid"

    campaign = models.ForeignKey(Campaign, on_delete=models.PROTECT, related_name="money")
    worker = models.ForeignKey("gtm_hit.Worker", on_delete=models.PROTECT, related_name="money")
    assignment = models.ForeignKey(
        "gtm_hit.Assignment", null=True, blank=True, on_delete=models.PROTECT, related_name="money"
    )
    kind = models.CharField(max_length=14, choices=Kind.choices)
    amount = models.DecimalField(max_digits=11, decimal_places=2)
    currency = models.CharField(max_length=3)
    key = models.CharField(
        max_length=80, unique=True, editable=False, help_text="names the reason; nothing is booked twice"
    )
    note = models.CharField(max_length=300, blank=True, help_text="how it was paid, or why it is so much")
    reverses = models.OneToOneField(
        "self", null=True, blank=True, on_delete=models.PROTECT, related_name="reversal"
    )
    user = models.ForeignKey(
        settings.AUTH_USER_MODEL,
        null=True,
        blank=True,
        on_delete=models.PROTECT,
        related_name="+",
        help_text="empty: the program, out of decisions or the platform's answers",
    )
    at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["at", "pk"]
        verbose_name_plural = "money entries"
        indexes = [models.Index(fields=["campaign", "worker", "kind"])]
        constraints = [
            models.CheckConstraint(condition=~Q(amount=0), name="money_entry_is_something"),
            models.CheckConstraint(
                condition=Q(amount__gt=0) | Q(kind="earned") | Q(reverses__isnull=False),
                name="money_taken_back_names_what",
            ),
        ]

    def __str__(self) -> str:
        return f"{self.worker} {self.get_kind_display()} {self.amount} {self.currency}"

    def save(self, *args: Any, **kwargs: Any) -> None:
        if not self._state.adding:
            raise AppendOnlyError("money is history: lines are added, never changed")
        super().save(*args, **kwargs)

    def delete(self, *args: Any, **kwargs: Any) -> NoReturn:
        raise AppendOnlyError("money is history: lines are added, never deleted")


class WorkClock(models.Model):
    """How much real time of an assignment has not been counted as active yet; a save counts from it."""

    assignment = models.OneToOneField(
        "gtm_hit.Assignment", on_delete=models.CASCADE, primary_key=True, related_name="clock"
    )
    seen_at = models.DateTimeField(help_text="last save, or the lease")
    burst_at = models.DateTimeField(help_text="first of the saves that came together")
    spare = models.FloatField(default=0, help_text="seconds of real time not counted yet")
    counted = models.FloatField(default=0, help_text="active seconds, all saves")
    told = models.FloatField(default=0, help_text="active seconds as the browser told them")

    class Meta:
        constraints = [
            models.CheckConstraint(
                condition=Q(spare__gte=0) & Q(counted__gte=0) & Q(told__gte=0), name="clock_never_negative"
            ),
        ]

    def __str__(self) -> str:
        return f"{self.counted:.0f} s of {self.told:.0f} s"
