"""What the workbench needs to know before it can draw: one answer, a fixed number of queries."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

from django.urls import get_script_prefix
from rest_framework import serializers

from gtm_hit.geometry.cylinder import HEIGHTS, RADII
from gtm_hit.models import Assignment, Camera, Dataset, Frame, Image, LayerFrame
from gtm_hit.ops.frames.neighbours import Neighbours, neighbours
from gtm_hit.ops.ground import grid_files


class ImageRefSerializer(serializers.Serializer[Any]):
    camera = serializers.IntegerField()
    light = serializers.CharField(help_text="fills a pane")
    full = serializers.CharField(help_text="every pixel")


class SceneFrameSerializer(serializers.Serializer[Any]):
    number = serializers.IntegerField()
    images = ImageRefSerializer(many=True)
    revision = serializers.IntegerField()
    done = serializers.BooleanField()
    nobody = serializers.BooleanField()


class CameraShape(serializers.ModelSerializer[Camera]):
    matrix = serializers.ListField(child=serializers.ListField(child=serializers.FloatField()))
    rvec = serializers.ListField(child=serializers.FloatField(), help_text="radians")
    tvec = serializers.ListField(child=serializers.FloatField(), help_text="metres")
    distortion = serializers.ListField(child=serializers.FloatField(), help_text="OpenCV's order")

    class Meta:
        model = Camera
        fields = ["index", "name", "width", "height", "matrix", "rvec", "tvec", "distortion", "model"]


class SceneCameraSerializer(CameraShape):
    rotation = serializers.ListField(child=serializers.ListField(child=serializers.FloatField()))
    grid = serializers.CharField(help_text="address of its rectangles of the usual person, at all positions")

    class Meta(CameraShape.Meta):
        fields = [*CameraShape.Meta.fields, "rotation", "grid"]


class SceneSerializer(serializers.Serializer[Any]):
    mode = serializers.CharField(help_text="assignment, layer or tutorial")
    dataset = serializers.DictField()
    grid = serializers.DictField()
    cylinder = serializers.DictField()
    sizes = serializers.DictField(help_text="height, radius: the least and the most metres a person may have")
    foot_rule = serializers.CharField()
    cameras = SceneCameraSerializer(many=True)
    frames = SceneFrameSerializer(many=True)
    layer = serializers.DictField(
        help_text="id, name, key (no other layer has it, on no server), created_at, first (number, of a part)"
    )
    editable = serializers.BooleanField()
    read_only_reason = serializers.CharField()
    assignment = serializers.DictField(allow_null=True)
    next_person = serializers.IntegerField(help_text="no save of the layer has used it")
    proposed = serializers.BooleanField(required=False, help_text="whether programs propose people here")
    neighbours = serializers.DictField(
        required=False, help_text="before, after: frames of accepted work beside the batch, nearest first"
    )


def dataset_part(dataset: Dataset) -> dict[str, Any]:
    """Grid, cylinder and cameras, metres and pixels."""
    grid = dataset.grid
    return {
        "dataset": {
            "slug": dataset.slug,
            "name": dataset.name,
            "seconds_per_frame": dataset.seconds_per_frame,
            "frame_step": dataset.frame_step,
        },
        "grid": {
            "columns": grid.columns,
            "rows": grid.rows,
            "step": grid.step,
            "origin": [grid.origin_x, grid.origin_y],
        },
        "cylinder": {"radius": dataset.cylinder_radius, "height": dataset.cylinder_height},
        "sizes": {"height": HEIGHTS, "radius": RADII},
        "foot_rule": dataset.foot_rule,
        "cameras": [
            {**camera.as_json(), "grid": grid_url(grid_files.digest_of(dataset, camera))}
            for camera in dataset.calibrated_cameras()
        ],
    }


def frames_part(frames: Iterable[Frame], heads: Mapping[int, LayerFrame]) -> list[dict[str, Any]]:
    """The frames with their images and where they stand; `heads` by frame id."""
    frames = list(frames)
    images: dict[int, list[dict[str, Any]]] = {frame.pk: [] for frame in frames}
    rows = Image.objects.filter(frame__in=list(images)).order_by("camera__index")
    fields = ("frame_id", "camera__index", "light_digest", "full_digest")
    for frame_id, camera, light, full in rows.values_list(*fields):
        images[frame_id].append({"camera": camera, "light": image_url(light), "full": image_url(full)})
    untouched = LayerFrame()
    return [
        {"number": frame.number, "images": images[frame.pk], **head_part(heads.get(frame.pk, untouched))}
        for frame in frames
    ]


def head_part(head: LayerFrame) -> dict[str, Any]:
    return {"revision": head.revision, "done": head.done, "nobody": head.nobody}


def image_url(digest: str) -> str:
    return f"{get_script_prefix()}api/v1/images/{digest}.jpg"


def grid_url(digest: str) -> str:
    return f"{get_script_prefix()}api/v1/grids/{digest}.gz"


def assignment_part(assignment: Assignment | None) -> dict[str, Any] | None:
    if assignment is None:
        return None
    return {
        "state": assignment.state,
        "expires_at": assignment.expires_at,
        "batch": str(assignment.batch),
    }


def neighbours_part(assignment: Assignment | None) -> dict[str, Any]:
    """People of accepted work beside the batch, nearest frames first."""
    return asdict(neighbours(assignment.batch) if assignment else Neighbours())
