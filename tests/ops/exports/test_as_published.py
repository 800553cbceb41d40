"""Exports look as the datasets they follow were published."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from gtm_hit.formats.annotations.wildtrack_json import read_frame
from gtm_hit.formats.calibration.wildtrack_xml import read_extrinsic, read_intrinsic
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.exports.calibrations import published_names
from tests.ops.exports.scene import export, save
from tests.work_scene import make_layer

pytestmark = [pytest.mark.django_db, pytest.mark.usefixtures("exports")]


def test_multiviewx_comes_out_as_it_was_published(shared_data: Path, tmp_path: Path) -> None:
    published = shared_data / "multiviewx"
    dataset = Dataset.objects.create(
        slug="multiviewx",
        name="MultiviewX",
        columns=1000,
        rows=640,
        origin_x=0,
        origin_y=0,
        foot_rule=FootRule.CENTRE.value,
        annotation_offset=1,
        annotation_digits=5,
    )
    for index in range(6):
        lens = read_intrinsic(published / "calibrations" / "intrinsic" / f"intr_Camera{index + 1}.xml")
        pose = read_extrinsic(published / "calibrations" / "extrinsic" / f"extr_Camera{index + 1}.xml")
        dataset.cameras.create(
            index=index,
            name=f"C{index + 1}",
            width=1920,
            height=1080,
            matrix=lens.matrix.tolist(),
            distortion=lens.distortion.tolist(),
            rvec=pose.rvec.tolist(),
            tvec=pose.tvec.tolist(),
        )
    layer = make_layer(dataset)
    sources = sorted((published / "annotations_positions").iterdir())
    for number, source in enumerate(sources):
        dataset.frames.create(number=number)
        people_there = read_frame(source, dataset.grid, 6).people
        save(layer, number, [(each.person, each.position, {}) for each in people_there])

    folder = export(layer, tmp_path / "out") / "annotations_positions"

    assert [path.name for path in sorted(folder.iterdir())] == [path.name for path in sources]
    for source in sources:
        expected = {each["personID"]: each for each in json.loads(source.read_bytes())}
        found = {each["personID"]: each for each in json.loads((folder / source.name).read_bytes())}
        assert found.keys() == expected.keys()
        for person, each in expected.items():
            assert {key: found[person][key] for key in each} == each


def test_wildtracks_calibration_is_bare_text_in_centimetres(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out") / "calibrations"
    camera = layer.dataset.calibrated_cameras()[0]
    text = (folder / "extrinsic" / "extr_C1.xml").read_text()
    assert "opencv-matrix" not in text
    pose = read_extrinsic(folder / "extrinsic" / "extr_C1.xml").in_metres("cm")
    np.testing.assert_allclose(pose.tvec, camera.tvec, rtol=0, atol=1e-12)
    lens = read_intrinsic(folder / "intrinsic_zero" / "intr_C1.xml")
    np.testing.assert_array_equal(lens.matrix, camera.matrix)


def test_multiviewx_calibration_is_read_by_opencv_in_metres(layer: Layer, tmp_path: Path) -> None:
    Dataset.objects.update(foot_rule=FootRule.CENTRE.value)
    layer.dataset.cameras.update(distortion=[0.01, 0, 0, 0, 0])
    layer = Layer.objects.get(pk=layer.pk)
    folder = export(layer, tmp_path / "out") / "calibrations"
    storage = cv2.FileStorage(str(folder / "extrinsic" / "extr_Camera1.xml"), cv2.FILE_STORAGE_READ)
    assert storage.getNode("tvec").mat().ravel().tolist() == [0.0, 1.0, 12.0]
    storage = cv2.FileStorage(str(folder / "intrinsic" / "intr_Camera1.xml"), cv2.FILE_STORAGE_READ)
    assert storage.getNode("distortion_coefficients").mat().ravel().tolist() == [0.01, 0, 0, 0, 0]


def test_seven_cameras_named_by_folder_get_the_names_readers_look_for(dataset: Dataset) -> None:
    camera = dataset.calibrated_cameras()[0]

    def named(*names: str) -> list[Any]:
        return [type(camera)(**{**vars(camera), "name": name}) for name in names]

    seven = named(*(f"C{number}" for number in range(1, 8)))
    assert published_names(seven, FootRule.CORNERS)[::6] == ["CVLab1", "IDIAP3"]
    assert published_names(seven[:2], FootRule.CORNERS) == ["C1", "C2"]
    assert published_names(named("lobby", "stairs"), FootRule.CENTRE) == ["lobby", "stairs"]
