"""Imports in which nobody is left: the frames are there, and nobody is in them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from gtm_hit.models import Dataset, LayerFrame
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.layers.importing import LayerReport
from tests.ops.square_layer import make_square, take_in

pytestmark = pytest.mark.django_db

IMAGES = [{"id": 1, "file_name": "C1/0000.png", "width": 320, "height": 240}]


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def dataset() -> Dataset:
    return make_square()


def done_frames(report: LayerReport) -> list[tuple[int, bool]]:
    assert (report.people, report.annotations) == (0, 0)
    heads = LayerFrame.objects.filter(layer=report.layer, done=True)
    return list(heads.values_list("frame__number", "nobody"))


def test_files_without_people_make_empty_frames(dataset: Dataset, tmp_path: Path) -> None:
    for number in (0, 5):
        (tmp_path / f"{number:08d}.json").write_text("[]")
    assert done_frames(take_in(dataset, tmp_path, "wildtrack")) == [(0, True), (5, True)]


def test_images_without_boxes_make_empty_frames(dataset: Dataset, tmp_path: Path) -> None:
    content = {"images": IMAGES, "annotations": [], "categories": [{"id": 1, "name": "person"}]}
    (tmp_path / "people.json").write_text(json.dumps(content))
    assert done_frames(take_in(dataset, tmp_path / "people.json", "coco")) == [(0, True)]


def test_boxes_of_other_things_alone_make_empty_frames(dataset: Dataset, tmp_path: Path) -> None:
    box = {"id": 1, "image_id": 1, "category_id": 2, "bbox": [1, 2, 3, 4]}
    categories = [{"id": 1, "name": "person"}, {"id": 2, "name": "car"}]
    (tmp_path / "people.json").write_text(
        json.dumps({"images": IMAGES, "annotations": [box], "categories": categories})
    )
    assert done_frames(take_in(dataset, tmp_path / "people.json", "coco")) == [(0, True)]


@pytest.mark.parametrize(
    ("kind", "name", "text"),
    [
        ("csv", "people.csv", "frame,person,x,y\n"),
        ("mot", "people.txt", "\n"),
        ("coco", "people.json", '{"images": [], "annotations": []}'),
    ],
)
def test_a_file_that_tells_of_no_frame_is_refused(
    dataset: Dataset, tmp_path: Path, kind: str, name: str, text: str
) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ImportFailed):
        take_in(dataset, tmp_path / name, kind)


def test_views_without_lines_have_nobody(dataset: Dataset, tmp_path: Path) -> None:
    for name in ("C1", "C2"):
        (tmp_path / f"{name}.txt").write_text("\n")
    with pytest.raises(ImportFailed, match="holds no annotation of this dataset"):
        take_in(dataset, tmp_path, "mot")
