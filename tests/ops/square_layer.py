"""The square of `tests.dataset_folder` as rows, without pictures, and people on it."""

from __future__ import annotations

import uuid
from pathlib import Path
from typing import Any

import numpy as np

from gtm_hit.models import Annotation, Dataset, Frame, Layer
from gtm_hit.ops.datasets.rows import add_cameras
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.frames import saving
from gtm_hit.ops.layers.findings import Kind
from gtm_hit.ops.layers.importing import AnnotationSource, LayerReport, import_annotations
from tests.dataset_folder import VALUES, cameras
from tests.work_scene import row

NUMBERS = (0, 5, 10, 15)


def make_square(**values: Any) -> Dataset:
    dataset = Dataset.objects.create(slug="square", name="Square", **{**VALUES, **values})
    add_cameras(dataset, cameras())
    Frame.objects.bulk_create(Frame(dataset=dataset, number=number) for number in NUMBERS)
    return dataset


def fill(layer: Layer, people: int = 12, **values: Any) -> None:
    """People somewhere in the middle of the square in every frame but the last."""
    rng = np.random.default_rng(5)
    grid = layer.dataset.grid
    for number in NUMBERS[:-1]:
        columns = rng.choice(np.arange(10, grid.columns - 10), people, replace=False)
        positions = rng.integers(8, grid.rows - 8, people) * grid.columns + columns
        rows = [row(person, int(position), **values) for person, position in enumerate(positions, start=3)]
        save(layer, number, rows)
    save(layer, NUMBERS[-1], [])


def save(layer: Layer, number: int, rows: list[dict[str, Any]]) -> None:
    frame = Frame.objects.get(dataset=layer.dataset, number=number)
    saving.save_frame(layer, frame, None, uuid.uuid4(), 0, rows, done=True, nobody=not rows)


def export(layer: Layer, folder: Path, *formats: str) -> Path:
    exporting.export_layer(layer, folder, folder.with_name("partial"), lambda *_: None, formats=formats)
    return folder


def take_in(dataset: Dataset, path: Path, kind: str, layer: str = "back", *drop: Kind) -> LayerReport:
    return import_annotations(dataset, AnnotationSource(path, kind, layer, drop=drop), lambda *_: None)


def content(layer: Layer, *columns: str) -> set[tuple[Any, ...]]:
    found = Annotation.objects.filter(layer=layer)
    return set(found.values_list("frame__number", "person", *(columns or ("position",))))
