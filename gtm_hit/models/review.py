"""What became of an assignment and why: transitions, comments, an appeal, and whether it was looked at."""

from __future__ import annotations

from typing import Any, NoReturn

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.models.annotation import AppendOnlyError, Layer
from gtm_hit.models.dataset import Frame
from gtm_hit.models.work import Assignment, Worker


class Category(models.TextChoices):
    """Why work is rejected; what platforms know under other names is translated by their adapters."""

    LOW_EFFORT = "low_effort", "hardly any effort"
    FAILED_INSTRUCTIONS = "failed_instructions", "the instructions were not followed"
    FAILED_CHECK = "failed_check", "known people were missed or put wrong"
    NO_DATA = "no_data", "nothing or next to nothing was annotated"
    OTHER = "other", "another reason"


class Transition(models.Model):
    """One step of one assignment from state to state. Rows are only ever added, and each begins where the
    one before it ended."""

    assignment = models.ForeignKey(Assignment, on_delete=models.PROTECT, related_name="transitions")
    number = models.PositiveIntegerField(help_text="of the assignment, from 1")
    action = models.CharField(max_length=16)
    from_state = models.CharField(max_length=12, choices=Assignment.State.choices)
    to_state = models.CharField(max_length=12, choices=Assignment.State.choices)
    user = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.PROTECT, related_name="+"
    )
    worker = models.ForeignKey(Worker, null=True, blank=True, on_delete=models.PROTECT, related_name="+")
    category = models.CharField(max_length=24, choices=Category.choices, blank=True)
    reason = models.TextField(blank=True)
    at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["assignment", "number"]
        indexes = [models.Index(fields=["user", "at"])]
        constraints = [
            models.UniqueConstraint(fields=["assignment", "number"], name="transition_number_once"),
            models.CheckConstraint(
                condition=~(Q(user__isnull=False) & Q(worker__isnull=False)), name="transition_one_actor"
            ),
        ]

    def __str__(self) -> str:
        return f"{self.assignment} {self.action}: {self.from_state} to {self.to_state}"

    def save(self, *args: Any, **kwargs: Any) -> None:
        if not self._state.adding:
            raise AppendOnlyError("transitions are history: they are added, never changed")
        super().save(*args, **kwargs)

    def delete(self, *args: Any, **kwargs: Any) -> NoReturn:
        raise AppendOnlyError("transitions are history: they are added, never deleted")


class Comment(models.Model):
    """A remark on an assignment, pinned to a frame and there to a person or a place; or an answer to one."""

    assignment = models.ForeignKey(Assignment, on_delete=models.CASCADE, related_name="comments")
    answers = models.ForeignKey(
        "self",
        null=True,
        blank=True,
        on_delete=models.CASCADE,
        related_name="replies",
        help_text="the remark",
    )
    frame = models.ForeignKey(
        Frame, null=True, blank=True, on_delete=models.CASCADE, related_name="+", help_text="empty: all of it"
    )
    person = models.PositiveIntegerField(null=True, blank=True, help_text="number in the worker's layer")
    position = models.PositiveIntegerField(null=True, blank=True, help_text="positionID in files")
    text = models.TextField()
    user = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.PROTECT, related_name="+"
    )
    worker = models.ForeignKey(Worker, null=True, blank=True, on_delete=models.PROTECT, related_name="+")
    created_at = models.DateTimeField(auto_now_add=True)
    resolved_at = models.DateTimeField(null=True, blank=True)

    class Meta:
        ordering = ["created_at", "pk"]
        constraints = [
            models.CheckConstraint(
                condition=Q(user__isnull=False, worker__isnull=True)
                | Q(user__isnull=True, worker__isnull=False),
                name="comment_one_author",
            ),
            models.CheckConstraint(
                condition=Q(frame__isnull=False) | Q(person__isnull=True, position__isnull=True),
                name="comment_pin_has_frame",
            ),
        ]

    def __str__(self) -> str:
        return self.text[:60]


class Appeal(models.Model):
    """A rejected worker's objection. There is one at most, and somebody else decides it."""

    class Outcome(models.TextChoices):
        OPEN = "open", "not decided yet"
        UPHELD = "upheld", "the rejection stands"
        OVERTURNED = "overturned", "accepted after all"

    assignment = models.OneToOneField(Assignment, on_delete=models.PROTECT, related_name="appeal")
    text = models.TextField()
    created_at = models.DateTimeField(auto_now_add=True)
    outcome = models.CharField(max_length=10, choices=Outcome.choices, default=Outcome.OPEN)
    answer = models.TextField(blank=True)
    decided_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.PROTECT, related_name="+"
    )
    decided_at = models.DateTimeField(null=True, blank=True)

    class Meta:
        constraints = [
            models.CheckConstraint(
                condition=Q(outcome="open", decided_by__isnull=True, decided_at__isnull=True)
                | Q(~Q(outcome="open"), decided_by__isnull=False, decided_at__isnull=False),
                name="appeal_decided_by_somebody",
            ),
        ]

    def __str__(self) -> str:
        return f"appeal of {self.assignment}: {self.outcome}"


class ReviewChoice(models.Model):
    """Whether a person looks at a submission, and why; what is not chosen is accepted by the system."""

    class Why(models.TextChoices):
        ALL = "all", "everything is reviewed"
        NEWCOMER = "newcomer", "of a newcomer"
        SUSPICION = "suspicion", "chosen by suspicion"
        CHANCE = "chance", "chosen by chance"
        UNKNOWN = "unknown", "its score could not be told"
        TRUSTED = "trusted", "of a trusted worker, not chosen"

    assignment = models.OneToOneField(Assignment, on_delete=models.CASCADE, related_name="review_choice")
    chosen = models.BooleanField()
    why = models.CharField(max_length=10, choices=Why.choices)
    suspicion = models.FloatField(null=True, blank=True, help_text="0 to 1; empty: not known")
    reasons = models.JSONField(default=list, blank=True, help_text="of the suspicion, in words")
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        indexes = [models.Index(fields=["chosen", "suspicion"])]

    def __str__(self) -> str:
        return f"{self.assignment}: {self.why}"


class Mend(models.Model):
    """A reviewer's own copy of a worker's layer, put right; once accepted it stands in the worker's place."""

    assignment = models.OneToOneField(Assignment, on_delete=models.PROTECT, related_name="mend")
    layer = models.OneToOneField(Layer, on_delete=models.PROTECT, related_name="mend")
    user = models.ForeignKey(settings.AUTH_USER_MODEL, on_delete=models.PROTECT, related_name="+")
    created_at = models.DateTimeField(auto_now_add=True)
    accepted_at = models.DateTimeField(null=True, blank=True)

    def __str__(self) -> str:
        return f"{self.layer} for {self.assignment}"
