"""A fisheye's calibration on its way through imports, replacements and exports."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.formats.calibration.wildtrack_xml import Intrinsic, intrinsic_xml, read_intrinsic
from gtm_hit.geometry.camera import Camera, CameraModel
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.models import Dataset, Job
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration.reading import read_replacement
from gtm_hit.ops.datasets.importing import ImportFailed, import_dataset
from gtm_hit.ops.exports.calibrations import calibration_files
from gtm_hit.ops.ground import grid_files
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.jobs import queue
from tests.dataset_folder import MATRIX, NAMES, cameras, make_folder, options

pytestmark = pytest.mark.django_db

LENS = np.array([0.05, -0.01, 0.002, -0.0003])


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """As published, the first camera's lens a fisheye."""
    root = make_folder(tmp_path / "square")
    write_lens(root / "calibrations" / "intrinsic_zero")
    return root


def write_lens(folder: Path) -> None:
    folder.mkdir(exist_ok=True)
    data = intrinsic_xml(Intrinsic(MATRIX, LENS, CameraModel.FISHEYE))
    (folder / "intr_C1.xml").write_bytes(data)


def fisheyes() -> list[Camera]:
    first, *others = cameras()
    return [replace(first, distortion=LENS, model=CameraModel.FISHEYE), *others]


def models(dataset: Dataset) -> list[str]:
    return [camera.model.value for camera in dataset.calibrated_cameras()]


def test_opencvs_files_and_the_own_one_give_the_same_cameras(folder: Path) -> None:
    dataset = import_dataset(options(folder)).dataset
    assert models(dataset) == ["fisheye", "pinhole", "pinhole"]
    digest = table(dataset).digest
    shutil.rmtree(folder / "calibrations")
    save_cameras(folder / "calibrations" / "cameras.json", fisheyes())
    other = import_dataset(options(folder, slug="other")).dataset
    assert (models(other), table(other).digest) == (models(dataset), digest)


def test_an_import_leaves_the_files_the_browser_will_ask_for(folder: Path) -> None:
    dataset = import_dataset(options(folder)).dataset
    for camera in dataset.calibrated_cameras():
        assert grid_files.path_of(grid_files.digest_of(dataset, camera)).exists()


def test_a_fisheyes_images_can_be_undistorted(folder: Path) -> None:
    originals = folder / "calibrations" / "intrinsic_original"
    write_lens(originals)
    for name in NAMES[1:]:
        (originals / f"intr_{name}.xml").write_bytes(intrinsic_xml(Intrinsic(MATRIX, np.zeros(5))))
    dataset = import_dataset(options(folder, undistort=True)).dataset
    assert models(dataset) == ["pinhole"] * 3
    assert not any(camera.has_lens for camera in dataset.calibrated_cameras())


def test_frames_added_later_must_be_of_the_same_model(folder: Path) -> None:
    import_dataset(options(folder))
    usual = intrinsic_xml(Intrinsic(MATRIX, LENS))
    (folder / "calibrations" / "intrinsic_zero" / "intr_C1.xml").write_bytes(usual)
    with pytest.raises(ImportFailed) as caught:
        import_dataset(options(folder))
    assert "another calibration (model differ)" in str(caught.value.problems[0])


def test_a_replaced_calibration_brings_its_model(folder: Path, tmp_path: Path) -> None:
    usual = make_folder(tmp_path / "usual")
    dataset = import_dataset(options(usual)).dataset
    save_cameras(tmp_path / "cameras.json", fisheyes())
    job = calibration_job.start(dataset, read_replacement(dataset, tmp_path / "cameras.json"))
    queue.run(job.pk, {Job.Kind.REPLACE_CALIBRATION: calibration_job.run})
    job.refresh_from_db()
    calibration_job.confirm(job)
    assert models(dataset) == ["fisheye", "pinhole", "pinhole"]


def test_an_exported_calibration_is_read_back(tmp_path: Path) -> None:
    files = dict(calibration_files(fisheyes(), FootRule.CORNERS))
    path = tmp_path / "intr.xml"
    path.write_bytes(files["calibrations/intrinsic/intr_C1.xml"])
    lens = read_intrinsic(path)
    assert (lens.model, lens.distortion.tolist()) == (CameraModel.FISHEYE, LENS.tolist())
