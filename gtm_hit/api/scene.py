"""What the workbench needs to know before it can draw: one answer, a fixed number of queries."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from gtm_hit.models import Assignment, Dataset, Frame, Image, LayerFrame
from gtm_hit.ops import grid_files
from gtm_hit.ops.neighbours import Neighbours, neighbours


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
        "foot_rule": dataset.foot_rule,
        "cameras": [
            {**camera.as_json(), "grid": grid_url(grid_files.digest_of(dataset, camera))}
            for camera in dataset.calibrated_cameras()
        ],
    }


def frames_part(frames: Iterable[Frame], heads: dict[int, dict[str, Any]]) -> list[dict[str, Any]]:
    """The frames with their images; `heads` holds revision, done and nobody by frame id."""
    frames = list(frames)
    images: dict[int, list[dict[str, Any]]] = {frame.pk: [] for frame in frames}
    rows = Image.objects.filter(frame__in=list(images)).order_by("camera__index")
    fields = ("frame_id", "camera__index", "light_digest", "full_digest")
    for frame_id, camera, light, full in rows.values_list(*fields):
        images[frame_id].append({"camera": camera, "light": image_url(light), "full": image_url(full)})
    untouched = head_part(LayerFrame())
    return [
        {"number": frame.number, "images": images[frame.pk], **heads.get(frame.pk, untouched)}
        for frame in frames
    ]


def head_part(head: LayerFrame) -> dict[str, Any]:
    return {"revision": head.revision, "done": head.done, "nobody": head.nobody}


def image_url(digest: str) -> str:
    return f"/api/v1/images/{digest}.jpg"


def grid_url(digest: str) -> str:
    return f"/api/v1/grids/{digest}.gz"


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
