"""Drafts of how the clocks of a folder's videos fit together; nothing is imported yet."""

from __future__ import annotations

from django.conf import settings
from django.db import models


class VideoSync(models.Model):
    """One folder's videos on one time line; `position` is the number of the state in place.

    Undoing and redoing move it, a change takes away what lies beyond it and adds a state.
    """

    source = models.CharField(max_length=300, unique=True, help_text="key of the folder on the server")
    facts = models.JSONField(help_text="file, size, seconds of every video, as their headers tell")
    guess = models.JSONField(default=dict, help_text="what was guessed last")
    position = models.PositiveIntegerField(default=1)
    revision = models.PositiveIntegerField(default=1, help_text="grows with every change, undo and redo")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)
    changed_at = models.DateTimeField(auto_now=True)

    class Meta:
        ordering = ["-changed_at"]

    def __str__(self) -> str:
        return f"clocks of {self.source}"


class VideoSyncState(models.Model):
    """What a draft was after one change."""

    sync = models.ForeignKey(VideoSync, on_delete=models.CASCADE, related_name="states")
    number = models.PositiveIntegerField(help_text="from 1")
    content = models.JSONField(help_text="clocks and events")
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["sync", "number"]
        constraints = [
            models.UniqueConstraint(fields=["sync", "number"], name="video_sync_state_once"),
        ]

    def __str__(self) -> str:
        return f"{self.sync} after {self.number}"
