"""What is in the files of an export."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gtm_hit.formats.annotations.wildtrack_json import read_frame
from gtm_hit.formats.manifest import verify
from gtm_hit.geometry.cylinder import Cylinder, rectangles
from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.exports import frames
from gtm_hit.ops.ground.coverage import table
from tests.ops.exports.scene import MIDDLE, export, people, save
from tests.work_scene import make_layer

pytestmark = [pytest.mark.django_db, pytest.mark.usefixtures("exports")]


def test_only_frames_that_were_saved_become_files(layer: Layer, tmp_path: Path) -> None:
    save(layer, 5, [], revision=0)
    folder = export(layer, tmp_path / "out")
    names = sorted(path.name for path in (folder / "annotations_positions").iterdir())
    assert names == ["00000000.json", "00000010.json"]
    assert people(folder, 10) == []


def test_frames_with_nobody_are_empty_lists(dataset: Dataset, tmp_path: Path) -> None:
    layer = make_layer(dataset)
    save(layer, 0, [])
    save(layer, 5, [])
    folder = export(layer, tmp_path / "out")
    assert [people(folder, number) for number in (0, 5)] == [[], []]


def test_a_person_has_the_published_keys_first_and_the_tables_rectangles(
    layer: Layer, tmp_path: Path
) -> None:
    folder = export(layer, tmp_path / "out")
    carried, clicked = people(folder, 0)
    assert list(clicked) == ["personID", "positionID", "views", "x", "y", "origin"]
    assert (clicked["personID"], clicked["positionID"], clicked["x"], clicked["y"]) == (7, MIDDLE, 0.0, 0.0)
    assert (clicked["origin"], carried["origin"], carried["validated"]) == ("clicked", "carried", False)
    dataset = layer.dataset
    for view, camera in zip(clicked["views"], dataset.calibrated_cameras(), strict=True):
        boxes, visible = rectangles(camera, dataset.grid, dataset.cylinder, dataset.rule, np.array([MIDDLE]))
        expected = boxes[0].tolist() if visible[0] else [-1] * 4
        assert [view[key] for key in ("xmin", "ymin", "xmax", "ymax")] == expected
    assert any(view["xmin"] != -1 for view in clicked["views"])


def test_a_person_of_another_size_has_rectangles_of_that_size(layer: Layer, tmp_path: Path) -> None:
    save(layer, 5, [(1, MIDDLE, {"height": 1.2}), (2, MIDDLE, {"radius": 0.3}), (3, MIDDLE, {})])
    small, wide, usual = people(export(layer, tmp_path / "out"), 5)
    assert (small["height"], wide["radius"]) == (1.2, 0.3)
    assert "height" not in usual and "radius" not in usual
    dataset = layer.dataset
    for person, size in ((small, Cylinder(0.16, 1.2)), (wide, Cylinder(0.3, 1.8)), (usual, dataset.cylinder)):
        for view, camera in zip(person["views"], dataset.calibrated_cameras(), strict=True):
            boxes, visible = rectangles(camera, dataset.grid, size, dataset.rule, np.array([MIDDLE]))
            expected = boxes[0].tolist() if visible[0] else [-1] * 4
            assert [view[key] for key in ("xmin", "ymin", "xmax", "ymax")] == expected


def test_the_files_are_read_back_without_a_problem(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    frame = read_frame(folder / "annotations_positions" / "00000000.json", layer.dataset.grid, 2)
    assert [(each.person, each.position) for each in frame.people] == [(2, MIDDLE + 40), (7, MIDDLE)]


def test_names_follow_the_datasets_offset_and_digits(layer: Layer, tmp_path: Path) -> None:
    Dataset.objects.update(annotation_offset=1, annotation_digits=5)
    layer = Layer.objects.get(pk=layer.pk)
    folder = export(layer, tmp_path / "out")
    assert (folder / "annotations_positions" / "00011.json").is_file()


def test_the_manifest_names_every_file_and_counts(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    assert verify(folder) == []
    manifest = json.loads((folder / "manifest.json").read_bytes())
    assert manifest["counts"] == {
        "frames": 2,
        "cameras": 2,
        "people": 2,
        "annotations": 2,
        "not_validated": 1,
    }
    assert manifest["parameters"]["grid"]["columns"] == 400
    assert {"README.txt", "cameras.json", "annotations_positions/00000000.json"} <= set(manifest["files"])


def test_exporting_twice_gives_the_same_bytes(layer: Layer, tmp_path: Path) -> None:
    first, second = export(layer, tmp_path / "first"), export(layer, tmp_path / "second")
    files = [path.relative_to(first) for path in first.rglob("*") if path.is_file()]
    assert all((first / name).read_bytes() == (second / name).read_bytes() for name in files)
    assert (tmp_path / "first.zip").read_bytes() == (tmp_path / "second.zip").read_bytes()


def test_the_zip_holds_the_folder_under_the_layers_name(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    with zipfile.ZipFile(tmp_path / "out.zip") as archive:
        names = archive.namelist()
        assert archive.read("square-own/manifest.json") == (folder / "manifest.json").read_bytes()
    assert sorted(names) == sorted(
        f"square-own/{path.relative_to(folder).as_posix()}" for path in folder.rglob("*") if path.is_file()
    )


def test_a_long_layer_is_read_in_chunks_with_two_queries_each(
    dataset: Dataset, monkeypatch: pytest.MonkeyPatch, django_assert_num_queries: Callable[..., Any]
) -> None:
    monkeypatch.setattr(frames, "FRAMES_PER_CHUNK", 2)
    layer = make_layer(dataset)
    for number in (0, 5, 10):
        save(layer, number, [(1, MIDDLE + number, {})])
    reader = frames.FrameReader(layer, dataset, dataset.calibrated_cameras(), table(dataset))
    with django_assert_num_queries(5):
        chunks = list(reader)
    assert [chunk.numbers for chunk in chunks] == [[0, 5], [10]]
    assert [chunk.positions.tolist() for chunk in chunks] == [[MIDDLE, MIDDLE + 5], [MIDDLE + 10]]
