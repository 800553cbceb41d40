"""A small layer, and its export."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from gtm_hit.models import Annotation, Frame, Job, Layer, LayerFrame
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.jobs import queue

MIDDLE = 200 * 400 + 200  # the position at (0, 0) metres, seen by both cameras


def save(layer: Layer, number: int, people: list[tuple[int, int, dict[str, Any]]], revision: int = 1) -> None:
    frame = Frame.objects.get(dataset=layer.dataset, number=number)
    LayerFrame.objects.create(layer=layer, frame=frame, revision=revision)
    for person, position, values in people:
        Annotation.objects.create(layer=layer, frame=frame, person=person, position=position, **values)


def export(layer: Layer, folder: Path, report: exporting.Report = lambda *_: None) -> Path:
    exporting.export_layer(layer, folder, folder.with_name("partial"), report)
    return folder


def people(folder: Path, number: int) -> list[dict[str, Any]]:
    return json.loads((folder / "annotations_positions" / f"{number:08d}.json").read_bytes())


def run_job(layer: Layer) -> Job:
    job = exporting.start(layer)
    queue.run(job.pk, {Job.Kind.EXPORT_LAYER: exporting.run})
    job.refresh_from_db()
    return job
