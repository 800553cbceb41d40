"""A scene: its grid and cylinder, its calibrated cameras, its frames and their images."""

from __future__ import annotations

import numpy as np
from django.core.validators import MaxValueValidator, MinValueValidator, RegexValidator
from django.db import models
from django.db.models import Q

from gtm_hit.geometry.camera import Camera as CalibratedCamera
from gtm_hit.geometry.camera import CameraModel
from gtm_hit.geometry.cylinder import Cylinder, FootRule
from gtm_hit.geometry.grid import Grid

name_validator = RegexValidator(
    r"^[A-Za-z0-9][A-Za-z0-9._-]*\Z", "Use letters, digits, dots, dashes and underscores only."
)


# Generous; what lies beyond is a slip that divisions by it would turn into infinity.
STEP = [MinValueValidator(0.001), MaxValueValidator(100)]
ORIGIN = [MinValueValidator(-1e6), MaxValueValidator(1e6)]
SIZE = [MinValueValidator(0.01), MaxValueValidator(10)]
RATE = [MinValueValidator(0.001), MaxValueValidator(1000)]


class Dataset(models.Model):
    slug = models.SlugField(max_length=80, unique=True)
    name = models.CharField(max_length=200)
    columns = models.PositiveIntegerField(default=480, validators=[MinValueValidator(1)])
    rows = models.PositiveIntegerField(default=1440, validators=[MinValueValidator(1)])
    step = models.FloatField(
        default=0.025, validators=STEP, help_text="metres between neighbouring positions"
    )
    origin_x = models.FloatField(default=-3.0, validators=ORIGIN, help_text="metres")
    origin_y = models.FloatField(default=-9.0, validators=ORIGIN, help_text="metres")
    cylinder_radius = models.FloatField(default=0.16, validators=SIZE, help_text="metres")
    cylinder_height = models.FloatField(default=1.80, validators=SIZE, help_text="metres")
    foot_rule = models.CharField(
        max_length=10, choices=[(rule.value, rule.value) for rule in FootRule], default=FootRule.CORNERS.value
    )
    frame_rate = models.FloatField(default=10.0, validators=RATE, help_text="frame numbers per second")
    frame_step = models.PositiveIntegerField(default=5, help_text="annotate every n-th frame number")
    annotation_offset = models.IntegerField(
        default=0, help_text="annotation file number minus frame number (MultiviewX: 1)"
    )
    annotation_digits = models.PositiveSmallIntegerField(
        default=8, help_text="digits in annotation file names"
    )
    undistorted = models.BooleanField(
        default=False, editable=False, help_text="lens distortion was taken out of the images on import"
    )
    instructions = models.TextField(blank=True, help_text="shown to workers before they start")
    calibration = models.ForeignKey(
        "gtm_hit.Calibration",
        null=True,
        editable=False,
        on_delete=models.RESTRICT,
        related_name="+",
        help_text="the version in place",
    )
    created_at = models.DateTimeField(auto_now_add=True)

    class Meta:
        ordering = ["slug"]
        constraints = [
            models.CheckConstraint(condition=Q(columns__gte=1, rows__gte=1), name="dataset_grid_not_empty"),
            models.CheckConstraint(condition=Q(step__gt=0), name="dataset_step_positive"),
            models.CheckConstraint(
                condition=Q(cylinder_radius__gt=0, cylinder_height__gt=0), name="dataset_cylinder_positive"
            ),
            models.CheckConstraint(
                condition=Q(frame_rate__gt=0, frame_step__gte=1), name="dataset_frames_positive"
            ),
        ]

    def __str__(self) -> str:
        return self.slug

    @property
    def grid(self) -> Grid:
        return Grid(self.columns, self.rows, self.step, self.origin_x, self.origin_y)

    @property
    def cylinder(self) -> Cylinder:
        return Cylinder(self.cylinder_radius, self.cylinder_height)

    @property
    def rule(self) -> FootRule:
        return FootRule(self.foot_rule)

    def calibrated_cameras(self) -> list[CalibratedCamera]:
        return [camera.calibrated for camera in self.cameras.all()]

    def annotation_name(self, frame_number: int) -> str:
        return f"{frame_number + self.annotation_offset:0{self.annotation_digits}d}.json"

    @property
    def seconds_per_frame(self) -> float:
        """Time between two consecutive annotated frames."""
        return self.frame_step / self.frame_rate


class Camera(models.Model):
    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="cameras")
    index = models.PositiveSmallIntegerField(help_text="viewNum in files")
    name = models.CharField(max_length=80, validators=[name_validator])
    width = models.PositiveIntegerField()
    height = models.PositiveIntegerField()
    matrix = models.JSONField(help_text="3×3, pixels")
    rvec = models.JSONField(help_text="3 numbers, radians")
    tvec = models.JSONField(help_text="3 numbers, metres")
    distortion = models.JSONField(default=list, help_text="OpenCV order; zeros for undistorted images")
    model = models.CharField(
        max_length=20,
        choices=[(model.value, model.value) for model in CameraModel],
        default=CameraModel.PINHOLE.value,
        help_text="what the numbers of distortion mean",
    )

    class Meta:
        ordering = ["dataset", "index"]
        constraints = [
            models.UniqueConstraint(fields=["dataset", "index"], name="camera_index_once"),
            models.UniqueConstraint(fields=["dataset", "name"], name="camera_name_once"),
            models.CheckConstraint(condition=Q(width__gte=1, height__gte=1), name="camera_size_positive"),
        ]

    def __str__(self) -> str:
        return self.name

    @property
    def calibrated(self) -> CalibratedCamera:
        return CalibratedCamera(
            index=self.index,
            name=self.name,
            width=self.width,
            height=self.height,
            matrix=np.array(self.matrix, dtype=np.float64),
            rvec=np.array(self.rvec, dtype=np.float64),
            tvec=np.array(self.tvec, dtype=np.float64),
            distortion=np.array(self.distortion or [0.0] * 5, dtype=np.float64),
            model=CameraModel(self.model),
        )


class Frame(models.Model):
    dataset = models.ForeignKey(Dataset, on_delete=models.CASCADE, related_name="frames")
    number = models.PositiveIntegerField(help_text="the file stem")

    class Meta:
        ordering = ["dataset", "number"]
        constraints = [models.UniqueConstraint(fields=["dataset", "number"], name="frame_number_once")]

    def __str__(self) -> str:
        return f"{self.number:08d}"


class Image(models.Model):
    """What one camera saw at one frame: two derivatives, addressed by their content.

    A digest names a stored file `images/<two digits>/<digest>.jpg`; equal pictures share one file.
    """

    frame = models.ForeignKey(Frame, on_delete=models.CASCADE, related_name="images")
    camera = models.ForeignKey(Camera, on_delete=models.CASCADE, related_name="images")
    source_digest = models.CharField(max_length=64, help_text="SHA-256 of the imported file")
    light_digest = models.CharField(max_length=64, db_index=True, help_text="fills a pane")
    full_digest = models.CharField(max_length=64, db_index=True, help_text="every pixel, for zooming")
    light_bytes = models.PositiveIntegerField()
    full_bytes = models.PositiveIntegerField()

    class Meta:
        ordering = ["frame", "camera"]
        constraints = [models.UniqueConstraint(fields=["frame", "camera"], name="image_once")]

    def __str__(self) -> str:
        return f"{self.camera} {self.frame}"
