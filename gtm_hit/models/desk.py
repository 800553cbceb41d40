"""A calibration being made: drafts of cameras, what was seen and clicked, and every step of the hand."""

from __future__ import annotations

from django.conf import settings
from django.db import models
from django.db.models import Q

from gtm_hit.models.dataset import Dataset, name_validator


class Desk(models.Model):
    """One calibration being made, for a dataset that is there or one that is to be imported with it."""

    slug = models.SlugField(max_length=80, unique=True)
    title = models.CharField(max_length=200)
    dataset = models.ForeignKey(
        Dataset,
        null=True,
        blank=True,
        on_delete=models.CASCADE,
        related_name="desks",
        help_text="empty: the cameras are for a dataset that is not there yet",
    )
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["-created_at", "-pk"]

    def __str__(self) -> str:
        return self.slug


class DeskCamera(models.Model):
    """A draft of one camera. `lens` and `pose` are what is known by now; the reports say how well."""

    desk = models.ForeignKey(Desk, on_delete=models.CASCADE, related_name="cameras")
    index = models.PositiveSmallIntegerField(help_text="viewNum in files")
    name = models.CharField(max_length=80, validators=[name_validator])
    width = models.PositiveIntegerField(default=0, help_text="pixels; 0: no picture and no lens yet")
    height = models.PositiveIntegerField(default=0, help_text="pixels")
    light_digest = models.CharField(max_length=64, blank=True, help_text="picture of the ground, for a pane")
    full_digest = models.CharField(max_length=64, blank=True, help_text="the same, every pixel")
    lens = models.JSONField(null=True, blank=True, help_text="matrix, distortion, and where they are from")
    lens_report = models.JSONField(default=dict, blank=True, help_text="of the solve the lens is from")
    board = models.JSONField(null=True, blank=True, help_text="what was looked for in the pictures of boards")
    pose = models.JSONField(null=True, blank=True, help_text="rvec and tvec, metres, world to camera")
    pose_report = models.JSONField(default=dict, blank=True, help_text="residuals and findings")
    adjusted = models.JSONField(
        null=True,
        blank=True,
        help_text="lens and pose of the adjustment in use, and those it began from: others end its use",
    )

    class Meta:
        ordering = ["desk", "index"]
        constraints = [
            models.UniqueConstraint(fields=["desk", "index"], name="desk_camera_index_once"),
            models.UniqueConstraint(fields=["desk", "name"], name="desk_camera_name_once"),
        ]

    def __str__(self) -> str:
        return self.name


class DeskPicture(models.Model):
    """A picture of the ground that a camera has or had: undoing may bring it back, so its files stay."""

    desk = models.ForeignKey(Desk, on_delete=models.CASCADE, related_name="pictures")
    light_digest = models.CharField(max_length=64, db_index=True)
    full_digest = models.CharField(max_length=64, db_index=True)

    class Meta:
        constraints = [
            models.UniqueConstraint(fields=["desk", "light_digest", "full_digest"], name="desk_picture_once")
        ]

    def __str__(self) -> str:
        return self.full_digest[:12]


class BoardPicture(models.Model):
    """A picture of a calibration board, and where the board was found in it."""

    camera = models.ForeignKey(DeskCamera, on_delete=models.CASCADE, related_name="board_pictures")
    name = models.CharField(max_length=200, help_text="its file's, or the video's with the frame")
    source_digest = models.CharField(max_length=64, help_text="SHA-256 of the file as it was sent")
    light_digest = models.CharField(max_length=64, db_index=True)
    full_digest = models.CharField(max_length=64, db_index=True)
    width = models.PositiveIntegerField()
    height = models.PositiveIntegerField()
    searched = models.CharField(
        max_length=64, blank=True, help_text="digest of the board it was searched for; empty: not yet"
    )
    found = models.JSONField(null=True, blank=True, help_text="pixels and the points of the board they show")
    reason = models.TextField(blank=True, help_text="why no board was found")
    used = models.BooleanField(default=True, help_text="whether it takes part in the solve")

    class Meta:
        ordering = ["camera", "name"]
        constraints = [models.UniqueConstraint(fields=["camera", "name"], name="board_picture_name_once")]

    def __str__(self) -> str:
        return self.name


class MeasuredPoint(models.Model):
    """A point whose place in the world was measured; the ground is z = 0."""

    desk = models.ForeignKey(Desk, on_delete=models.CASCADE, related_name="points")
    number = models.PositiveIntegerField(help_text="place in the list, from 1")
    name = models.CharField(max_length=80)
    x = models.FloatField(help_text="metres")
    y = models.FloatField(help_text="metres")
    z = models.FloatField(default=0.0, help_text="metres")

    class Meta:
        ordering = ["desk", "number"]
        constraints = [models.UniqueConstraint(fields=["desk", "name"], name="measured_point_name_once")]

    def __str__(self) -> str:
        return self.name


class Click(models.Model):
    """Where a measured point is seen in a camera's picture of the ground."""

    camera = models.ForeignKey(DeskCamera, on_delete=models.CASCADE, related_name="clicks")
    point = models.ForeignKey(MeasuredPoint, on_delete=models.CASCADE, related_name="clicks")
    x = models.FloatField(help_text="pixels")
    y = models.FloatField(help_text="pixels")

    class Meta:
        ordering = ["camera", "point__number"]
        constraints = [models.UniqueConstraint(fields=["camera", "point"], name="click_once")]

    def __str__(self) -> str:
        return f"{self.point} in {self.camera}"


class KeptPoint(models.Model):
    """A thing that several cameras see at one instant, clicked by hand; where it is nobody measured."""

    class Use(models.TextChoices):
        CORRESPONDENCE = "correspondence", "adjusted with"
        TEST = "test", "only tested with"

    desk = models.ForeignKey(Desk, on_delete=models.CASCADE, related_name="kept_points")
    name = models.CharField(max_length=80)
    use = models.CharField(
        max_length=14, choices=Use.choices, help_text="a point to test with takes part in no solve, ever"
    )

    class Meta:
        ordering = ["desk", "pk"]
        constraints = [models.UniqueConstraint(fields=["desk", "name"], name="kept_point_name_once")]

    def __str__(self) -> str:
        return self.name


class KeptClick(models.Model):
    """Where a kept point is seen by a camera, in its picture as taken."""

    point = models.ForeignKey(KeptPoint, on_delete=models.CASCADE, related_name="clicks")
    camera = models.ForeignKey(DeskCamera, on_delete=models.CASCADE, related_name="kept_clicks")
    x = models.FloatField(help_text="pixels")
    y = models.FloatField(help_text="pixels")

    class Meta:
        ordering = ["point", "camera__index"]
        constraints = [models.UniqueConstraint(fields=["point", "camera"], name="kept_click_once")]

    def __str__(self) -> str:
        return f"{self.point} in {self.camera}"


class ClickFile(models.Model):
    """Clicks out of a file, of things that several cameras see: feet and heads, or a problem's points.

    The row stays when its use is undone, for it may be done again.
    """

    desk = models.ForeignKey(Desk, on_delete=models.CASCADE, related_name="click_files")
    digest = models.CharField(max_length=64, help_text="SHA-256 of what was read")
    name = models.CharField(max_length=200)
    used = models.BooleanField(default=False, help_text="whether it is adjusted with")
    points = models.JSONField(help_text="of each: name, frame, part (feet, head or none), clicks by camera")

    class Meta:
        ordering = ["desk", "pk"]
        constraints = [models.UniqueConstraint(fields=["desk", "digest"], name="click_file_once")]

    def __str__(self) -> str:
        return self.name


class ClickDecision(models.Model):
    """What somebody said of a click that an adjustment found far off. It is void once the click is moved."""

    class Decision(models.TextChoices):
        KEEP = "keep", "it is right"
        DROP = "drop", "not adjusted with"

    desk = models.ForeignKey(Desk, on_delete=models.CASCADE, related_name="click_decisions")
    source = models.CharField(max_length=64, help_text="ground, kept, or the digest of a file of clicks")
    point = models.CharField(max_length=200)
    camera = models.CharField(max_length=80)
    decision = models.CharField(max_length=4, choices=Decision.choices)
    x = models.FloatField(help_text="pixels, where the click was then")
    y = models.FloatField(help_text="pixels")

    class Meta:
        ordering = ["desk", "pk"]
        constraints = [
            models.UniqueConstraint(fields=["desk", "source", "point", "camera"], name="click_decision_once")
        ]

    def __str__(self) -> str:
        return f"{self.point} in {self.camera}: {self.get_decision_display()}"


class DeskAdjustment(models.Model):
    """All cameras and points adjusted at once: as far as it has come, then what came out.

    There is one for the same input, however often it is asked for, stopped and gone on with.
    """

    desk = models.ForeignKey(Desk, on_delete=models.CASCADE, related_name="adjustments")
    number = models.PositiveIntegerField(help_text="from 1")
    of = models.CharField(max_length=64, help_text="SHA-256 of all that it depends on")
    choices = models.JSONField(help_text="variant, weights, and what was held")
    inputs = models.JSONField(help_text="clicks, measured points and cameras that it began with")
    state = models.JSONField(null=True, blank=True, help_text="where it has come to")
    report = models.JSONField(null=True, blank=True, help_text="null: not finished")
    cameras = models.JSONField(null=True, blank=True, help_text="lens and pose of each camera by name")
    created_by = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["desk", "-number"]
        constraints = [
            models.UniqueConstraint(fields=["desk", "number"], name="desk_adjustment_number_once"),
            models.UniqueConstraint(fields=["desk", "of"], name="desk_adjustment_of_once"),
        ]

    def __str__(self) -> str:
        return f"{self.desk}: adjustment {self.number}"


class DeskEdit(models.Model):
    """One step of the hand at a desk. Steps are only added; undoing one marks it.

    `changes` is a list of [kind, key, before, after]. What was undone can be done again until something else
    is done in its place: `follows` tells.
    """

    desk = models.ForeignKey(Desk, on_delete=models.CASCADE, related_name="edits")
    number = models.PositiveIntegerField(help_text="from 1")
    follows = models.PositiveIntegerField(help_text="number of the page's step before it; 0: none")
    page = models.CharField(max_length=100, help_text="where it was done: undo goes page by page")
    what = models.CharField(max_length=200, help_text="in words")
    changes = models.JSONField()
    undone = models.BooleanField(default=False)
    author = models.ForeignKey(
        settings.AUTH_USER_MODEL, null=True, blank=True, on_delete=models.SET_NULL, related_name="+"
    )
    at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["desk", "number"]
        constraints = [
            models.UniqueConstraint(fields=["desk", "number"], name="desk_edit_number_once"),
            models.CheckConstraint(condition=Q(number__gte=1), name="desk_edit_number_from_one"),
        ]

    def __str__(self) -> str:
        return f"{self.desk} {self.number}: {self.what}"
