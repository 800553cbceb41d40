"""A small dataset with two cameras, and the people who work on it."""

from __future__ import annotations

import hashlib
import uuid
from datetime import timedelta
from typing import Any

from gtm_hit.models import Assignment, Camera, Dataset, Frame, Image, Layer, Worker
from gtm_hit.ops.frames import saving
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.work import assignments

MATRIX = [[1000.0, 0.0, 960.0], [0.0, 1000.0, 540.0], [0.0, 0.0, 1.0]]


def make_dataset(slug: str = "square", frames: int = 20, images: bool = False) -> Dataset:
    """400 × 400 positions of 2.5 cm, seen by two cameras from 8 m; frame numbers 0, 5, 10 …"""
    dataset = Dataset.objects.create(
        slug=slug, name=slug.title(), columns=400, rows=400, step=0.025, origin_x=-5, origin_y=-5
    )
    for index, rvec in enumerate(([1.9, 0.0, 0.0], [0.0, -2.0, 2.0])):
        Camera.objects.create(
            dataset=dataset,
            index=index,
            name=f"C{index + 1}",
            width=1920,
            height=1080,
            matrix=MATRIX,
            rvec=rvec,
            tvec=[0.0, 1.0, 12.0],
        )
    add_frames(dataset, frames, images)
    return dataset


def add_frames(dataset: Dataset, count: int, images: bool = False) -> list[Frame]:
    start = dataset.frames.count()
    frames = Frame.objects.bulk_create(
        Frame(dataset=dataset, number=5 * index) for index in range(start, start + count)
    )
    if images:
        Image.objects.bulk_create(
            Image(
                frame=frame,
                camera=camera,
                source_digest="0" * 64,
                light_digest=digest(f"light {frame.pk} {camera.pk}".encode()),
                full_digest=digest(f"full {frame.pk} {camera.pk}".encode()),
                light_bytes=1,
                full_bytes=1,
            )
            for frame in frames
            for camera in dataset.cameras.all()
        )
    return frames


def digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def make_worker(external_id: str = "worker-one", platform: str = "link") -> Worker:
    return Worker.objects.create(platform=platform, external_id=external_id)


def make_layer(dataset: Dataset, name: str = "own", kind: str = Layer.Kind.STAFF, **values: Any) -> Layer:
    return Layer.objects.create(dataset=dataset, name=name, kind=kind, **values)


def row(person: int = 1, position: int = 1000, **values: Any) -> dict[str, Any]:
    """An annotation in canonical form."""
    return {
        "person": person,
        "position": position,
        "state": "validated",
        "origin": "clicked",
        "height": None,
        "radius": None,
        **values,
    }


def as_sent(rows: list[Row]) -> list[dict[str, Any]]:
    return [one.as_dict() for one in rows]


def save(layer: Layer, frame: Frame, rows: list[dict[str, Any]], revision: int = 0, **values: Any) -> Any:
    """Save with a fresh id, by nobody unless `author` is given."""
    author = values.pop("author", None)
    save_id = values.pop("save_id", None) or uuid.uuid4()
    return saving.save_frame(layer, frame, author, save_id, revision, rows, **values)


def minutes_pass(assignment: Assignment, minutes: float = 10) -> None:
    """Since the lease, so that seconds of a save are believed."""
    began = assignment.leased_at - timedelta(minutes=minutes)
    Assignment.objects.filter(pk=assignment.pk).update(leased_at=began)


def do_frames(assignment: Assignment) -> None:
    """Every frame of the batch done, nobody in those that were never saved."""
    for frame in assignment.batch.frames.all():
        state = saving.read_frame(assignment.layer, frame)
        if not state.done:
            people = as_sent(state.annotations)
            save(
                assignment.layer,
                frame,
                people,
                state.revision,
                author=assignment.worker,
                done=True,
                nobody=not people,
            )


def finish(assignment: Assignment) -> Assignment:
    do_frames(assignment)
    return assignments.submit(assignment)
