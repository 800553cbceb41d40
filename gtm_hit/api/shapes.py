"""The shapes of what scripts read, and of the queries that narrow it down."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from drf_spectacular.utils import OpenApiExample, extend_schema_field, extend_schema_serializer
from rest_framework import serializers

from gtm_hit.api.scene import image_url
from gtm_hit.api.serializers import LARGEST, ImageRefSerializer
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.models import Annotation, Assignment, Batch, Camera, Dataset, Frame, Job, Layer, Release
from gtm_hit.ops import export_expiry, exporting
from gtm_hit.ops.export_expiry import Removed
from gtm_hit.ops.quality.comparing import LARGEST_RADIUS, Scope
from gtm_hit.ops.quality.statistics import EVERY

MOST_EVERY = 10_000
MOST_FRAMES = 500  # whose annotations come in one answer


class DatasetShape(serializers.ModelSerializer[Dataset]):
    class Meta:
        model = Dataset
        fields = [
            *("slug", "name", "columns", "rows", "step", "origin_x", "origin_y"),
            *("cylinder_radius", "cylinder_height", "foot_rule", "frame_rate", "frame_step"),
            *("annotation_offset", "annotation_digits", "undistorted", "instructions", "created_at"),
        ]


class CameraShape(serializers.ModelSerializer[Camera]):
    matrix = serializers.ListField(child=serializers.ListField(child=serializers.FloatField()))
    rvec = serializers.ListField(child=serializers.FloatField(), help_text="radians")
    tvec = serializers.ListField(child=serializers.FloatField(), help_text="metres")
    distortion = serializers.ListField(child=serializers.FloatField(), help_text="OpenCV's order")

    class Meta:
        model = Camera
        fields = ["index", "name", "width", "height", "matrix", "rvec", "tvec", "distortion", "model"]


class FrameShape(serializers.ModelSerializer[Frame]):
    images = serializers.SerializerMethodField()

    class Meta:
        model = Frame
        fields = ["number", "images"]

    @extend_schema_field(ImageRefSerializer(many=True))
    def get_images(self, frame: Frame) -> list[dict[str, Any]]:
        return [
            {
                "camera": image.camera.index,
                "light": image_url(image.light_digest),
                "full": image_url(image.full_digest),
            }
            for image in frame.images.all()
        ]


class LayerShape(serializers.ModelSerializer[Layer]):
    frames_saved = serializers.IntegerField()
    frames_done = serializers.IntegerField()
    annotations = serializers.IntegerField(source="annotation_count")
    people = serializers.IntegerField()
    changed_at = serializers.DateTimeField(allow_null=True)

    class Meta:
        model = Layer
        fields = [
            *("id", "name", "kind", "hidden", "frames_saved", "frames_done", "annotations", "people"),
            *("created_at", "changed_at"),
        ]


class PlacedSerializer(serializers.Serializer[Any]):
    """One person of one frame."""

    frame = serializers.IntegerField(help_text="frame number")
    person = serializers.IntegerField()
    position = serializers.IntegerField(help_text="row * columns + column")
    x = serializers.FloatField(help_text="metres")
    y = serializers.FloatField(help_text="metres")
    state = serializers.ChoiceField(choices=Annotation.State.choices)
    origin = serializers.ChoiceField(choices=Annotation.Origin.choices)
    height = serializers.FloatField(allow_null=True, help_text="metres; null: the dataset's cylinder")
    radius = serializers.FloatField(allow_null=True, help_text="metres; null: the dataset's cylinder")


@extend_schema_serializer(
    examples=[
        OpenApiExample(
            "two people of one frame",
            {
                "next": "https://marker.example/api/v1/datasets/square/layers/truth/annotations/?from=1",
                "results": [
                    {
                        "frame": 0,
                        "person": 12,
                        "position": 456826,
                        "x": 6.65,
                        "y": 14.775,
                        "state": "validated",
                        "origin": "clicked",
                        "height": None,
                        "radius": None,
                    }
                ],
            },
            response_only=True,
        )
    ]
)
class PlacedPageSerializer(serializers.Serializer[Any]):
    next = serializers.URLField(allow_null=True)
    results = PlacedSerializer(many=True)


class BatchShape(serializers.ModelSerializer[Batch]):
    frames = serializers.IntegerField(source="frame_count")
    first_number = serializers.IntegerField(help_text="frame number")
    last_number = serializers.IntegerField(help_text="frame number")

    class Meta:
        model = Batch
        fields = ["number", "copy", "frames", "first_number", "last_number", "created_at"]


class ProgressSerializer(serializers.Serializer[Any]):
    batches = serializers.IntegerField()
    free = serializers.IntegerField()
    leased = serializers.IntegerField()
    submitted = serializers.IntegerField()
    accepted = serializers.IntegerField()
    frames_without = serializers.IntegerField(help_text="frames in no batch")


class AssignmentShape(serializers.ModelSerializer[Assignment]):
    batch = serializers.IntegerField(source="batch.number")
    copy = serializers.IntegerField(source="batch.copy")
    worker = serializers.CharField(source="worker.pseudonym", help_text="pseudonym")
    layer = serializers.CharField(source="layer.name")
    frames = serializers.IntegerField(source="frame_count")
    frames_done = serializers.IntegerField()
    people = serializers.IntegerField()

    class Meta:
        model = Assignment
        fields = [
            *("id", "batch", "copy", "worker", "layer", "state", "frames", "frames_done", "people"),
            *("leased_at", "expires_at", "submitted_at"),
        ]


@extend_schema_serializer(
    examples=[
        OpenApiExample(
            "a finished release",
            {
                "id": 41,
                "dataset": "square",
                "kind": "make_release",
                "state": "done",
                "done": 100,
                "total": 100,
                "message": "",
                "result": {"release": 3, "counts": {"frames": 400, "people": 313}},
                "attempts": 1,
                "cancel_requested": False,
                "created_by": "ada",
                "created_at": "2026-11-02T10:00:00Z",
                "started_at": "2026-11-02T10:00:01Z",
                "finished_at": "2026-11-02T10:00:09Z",
                "download": None,
            },
            response_only=True,
        )
    ]
)
class JobShape(serializers.ModelSerializer[Job]):
    dataset = serializers.CharField(source="dataset.slug", default=None, allow_null=True)
    result = serializers.DictField()
    created_by = serializers.CharField(source="created_by.username", default=None, allow_null=True)
    download = serializers.SerializerMethodField()
    expires_at = serializers.SerializerMethodField()
    removed = serializers.SerializerMethodField()

    class Meta:
        model = Job
        fields = [
            *("id", "dataset", "kind", "state", "done", "total", "message", "result", "attempts"),
            *("cancel_requested", "created_by", "created_at", "started_at", "finished_at", "download"),
            *("expires_at", "removed"),
        ]

    @extend_schema_field(serializers.CharField(allow_null=True, help_text="address of an export's zip"))
    def get_download(self, job: Job) -> str | None:
        return f"/api/v1/jobs/{job.pk}/download/" if exporting.made_files(job) else None

    @extend_schema_field(
        serializers.DateTimeField(allow_null=True, help_text="when an export's files will be removed")
    )
    def get_expires_at(self, job: Job) -> datetime | None:
        return export_expiry.expires_at(job)

    @extend_schema_field(
        serializers.ChoiceField(
            choices=list(Removed), allow_null=True, help_text="why an export's files are gone"
        )
    )
    def get_removed(self, job: Job) -> str | None:
        return export_expiry.removed(job)


class ReleaseShape(serializers.ModelSerializer[Release]):
    layer = serializers.CharField(source="layer.name")
    counts = serializers.DictField(child=serializers.IntegerField())
    created_by = serializers.CharField(source="created_by.username", default=None, allow_null=True)

    class Meta:
        model = Release
        fields = ["number", "title", "layer", "counts", "manifest_digest", "created_by", "created_at"]


class SourceSerializer(serializers.Serializer[Any]):
    key = serializers.CharField(help_text="what imports are started with")
    archive = serializers.BooleanField(source="is_archive")


class SourcesSerializer(serializers.Serializer[Any]):
    results = SourceSerializer(many=True)


class NumbersQuery(serializers.Serializer[Any]):
    """`from` and `to`, both included."""

    def get_fields(self) -> dict[str, Any]:
        # `from` cannot be an attribute's name.
        bounds: dict[str, Any] = {"min_value": 0, "max_value": LARGEST}
        return {
            "from": serializers.IntegerField(**bounds, default=0, help_text="first frame number"),
            "to": serializers.IntegerField(**bounds, default=LARGEST, help_text="last frame number"),
            **super().get_fields(),
        }


class PlacedQuery(NumbersQuery):
    frames = serializers.IntegerField(
        min_value=1, max_value=MOST_FRAMES, default=100, help_text="frames in one answer"
    )


class LayersQuery(serializers.Serializer[Any]):
    kind = serializers.ChoiceField(choices=Layer.Kind.choices, required=False)


class BatchesQuery(serializers.Serializer[Any]):
    copy = serializers.IntegerField(min_value=1, max_value=LARGEST, required=False)


class AssignmentsQuery(serializers.Serializer[Any]):
    state = serializers.ChoiceField(choices=Assignment.State.choices, required=False)
    worker = serializers.CharField(max_length=20, required=False, help_text="pseudonym")
    batch = serializers.IntegerField(min_value=1, max_value=LARGEST, required=False)


class JobsQuery(serializers.Serializer[Any]):
    dataset = serializers.SlugField(max_length=80, required=False)
    kind = serializers.ChoiceField(choices=Job.Kind.choices, required=False)
    state = serializers.ChoiceField(choices=Job.State.choices, required=False)


class EvaluationQuery(serializers.Serializer[Any]):
    truth = serializers.CharField(max_length=120, help_text="name of a layer")
    found = serializers.CharField(max_length=120, help_text="name of a layer")
    radius = serializers.FloatField(
        min_value=0.001, max_value=LARGEST_RADIUS, default=RADIUS, help_text="metres"
    )
    scope = serializers.ChoiceField(choices=[each.value for each in Scope], default=Scope.BOTH.value)
    start = serializers.IntegerField(
        min_value=0, max_value=LARGEST, default=0, help_text="frame number from which on to compare"
    )


class CoverageQuery(serializers.Serializer[Any]):
    every = serializers.IntegerField(
        min_value=1, max_value=MOST_EVERY, default=EVERY, help_text="coverage: every n-th position"
    )


class AgreementQuery(serializers.Serializer[Any]):
    radius = serializers.FloatField(
        min_value=0.001, max_value=LARGEST_RADIUS, default=RADIUS, help_text="metres"
    )
