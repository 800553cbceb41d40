"""Long work, as a row that says how far it is. The row is the truth; a message only wakes somebody."""

from __future__ import annotations

from django.conf import settings
from django.db import models
from django.db.models import F, Q

from gtm_hit.models.dataset import Dataset


class Job(models.Model):
    class State(models.TextChoices):
        QUEUED = "queued", "waiting"
        RUNNING = "running", "running"
        DONE = "done", "done"
        FAILED = "failed", "failed"
        CANCELLED = "cancelled", "cancelled"

    class Kind(models.TextChoices):
        EXPORT_LAYER = "export_layer", "export of a layer"
        IMPORT_DATASET = "import_dataset", "import of a dataset"
        IMPORT_VIDEOS = "import_videos", "import of videos"
        IMPORT_ANNOTATIONS = "import_annotations", "import of annotations"
        REPLACE_CALIBRATION = "replace_calibration", "change of calibration"
        MAKE_RELEASE = "make_release", "release"
        STITCH = "stitch", "stitching into ground truth"
        SEND_OUTBOX = "send_outbox", "messages to a platform"
        PROPOSE = "propose", "proposals of people"
        SOLVE_LENS = "solve_lens", "lens from pictures of a board"
        ADJUST = "adjust", "adjustment of cameras"
        DRIFT = "drift", "drift of cameras"
        SYNC_VIDEOS = "sync_videos", "guess of videos' offsets"

    dataset = models.ForeignKey(
        Dataset,
        null=True,
        blank=True,
        on_delete=models.CASCADE,
        related_name="jobs",
        help_text="empty while an import has not made it yet",
    )
    kind = models.CharField(max_length=40, choices=Kind.choices)
    parameters = models.JSONField(default=dict)
    state = models.CharField(max_length=12, choices=State.choices, default=State.QUEUED)
    done = models.PositiveIntegerField(default=0, help_text="steps done")
    total = models.PositiveIntegerField(default=0, help_text="steps in all; 0: not yet known")
    message = models.TextField(blank=True, help_text="what it is doing, or why it failed")
    result = models.JSONField(default=dict)
    attempts = models.PositiveSmallIntegerField(default=0)
    cancel_requested = models.BooleanField(default=False)
    heartbeat_at = models.DateTimeField(null=True, blank=True, help_text="last sign of life")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="jobs"
    )
    created_at = models.DateTimeField(auto_now_add=True)
    started_at = models.DateTimeField(null=True, blank=True)
    finished_at = models.DateTimeField(null=True, blank=True)

    class Meta:
        ordering = ["-created_at"]
        constraints = [
            models.CheckConstraint(
                condition=Q(total=0) | Q(done__lte=F("total")), name="job_done_within_total"
            ),
        ]

    def __str__(self) -> str:
        return f"{self.get_kind_display()} {self.pk}"

    @property
    def finished(self) -> bool:
        return self.state in {self.State.DONE, self.State.FAILED, self.State.CANCELLED}
