"""The project's own calibration file in the place of OpenCV's."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from gtm_hit.formats.calibration.cameras_json import load_taken, save_cameras
from gtm_hit.geometry.undistorting import kept_matrix
from gtm_hit.models import Dataset
from gtm_hit.ops.datasets.importing import ImportFailed, import_dataset
from tests.conftest import REPOSITORY
from tests.dataset_folder import MATRIX, NAMES, add_calibrations, cameras, make_folder, options

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_storage(settings: object, tmp_path: Path) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"  # type: ignore[attr-defined]
    settings.TABLES_ROOT = tmp_path / "tables"  # type: ignore[attr-defined]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    root = make_folder(tmp_path / "square")
    shutil.rmtree(root / "calibrations")
    save_cameras(root / "calibrations" / "cameras.json", cameras())
    return root


def test_the_example_of_the_documentation_is_read(tmp_path: Path) -> None:
    text = (REPOSITORY / "docs" / "calibration.md").read_text(encoding="utf-8")
    path = tmp_path / "cameras.json"
    path.write_text(text.split("```json")[1].split("```")[0])
    (camera,) = load_taken(path)
    assert (camera.name, camera.width, camera.distortion[0]) == ("C1", 1920, -0.432)


def edit(path: Path, camera: int, **facts: object) -> None:
    content = json.loads(path.read_text())
    content["cameras"][camera].update(facts)
    path.write_text(json.dumps(content))


def failure(folder: Path, **changes: object) -> list[str]:
    with pytest.raises(ImportFailed) as caught:
        import_dataset(options(folder, **changes))
    assert not Dataset.objects.exists()
    return [str(problem) for problem in caught.value.problems]


def test_cameras_are_those_of_the_file(folder: Path) -> None:
    dataset = import_dataset(options(folder)).dataset
    for found, camera in zip(dataset.calibrated_cameras(), cameras(), strict=True):
        assert (found.name, found.tvec.tolist()) == (camera.name, camera.tvec.tolist())


def test_the_file_may_be_named_alone(folder: Path, tmp_path: Path) -> None:
    path = (folder / "calibrations" / "cameras.json").rename(tmp_path / "elsewhere.json")
    assert import_dataset(options(folder, calibrations=path)).dataset.cameras.count() == 3


def test_metres_stay_metres_whatever_unit_was_told(folder: Path) -> None:
    dataset = import_dataset(options(folder, tvec_unit="cm")).dataset
    assert dataset.calibrated_cameras()[0].tvec.tolist() == cameras()[0].tvec.tolist()


def test_two_calibrations_are_one_too_many(folder: Path) -> None:
    add_calibrations(folder)
    problems = failure(folder)
    assert "calibrations/extrinsic: lies beside cameras.json: keep one of the two calibrations" in problems


def test_another_size_than_the_images_is_refused(folder: Path) -> None:
    edit(folder / "calibrations" / "cameras.json", 1, width=640)
    (problem,) = failure(folder)
    assert problem.endswith("cameras.json: camera C2: 640×240 pixels, but the images have 320×240")


def test_cameras_must_be_those_of_the_images(folder: Path) -> None:
    edit(folder / "calibrations" / "cameras.json", 1, name="Roof")
    problems = "\n".join(failure(folder))
    assert "camera Roof: belongs to no camera that has images" in problems
    assert "cameras: none is camera C2" in problems


def test_images_are_undistorted_from_the_original_to_the_ideal_lens(folder: Path) -> None:
    lens = {"matrix": [[280.0, 0, 161], [0, 280.0, 119], [0, 0, 1]], "distortion": [-0.2, 0, 0, 0, 0]}
    for index in range(3):
        edit(folder / "calibrations" / "cameras.json", index, original=lens)
    dataset = import_dataset(options(folder, undistort=True)).dataset
    assert dataset.undistorted
    for camera in dataset.calibrated_cameras():
        assert camera.matrix.tolist() == MATRIX.tolist() and not camera.distortion.any()


def test_the_taken_lens_is_the_only_one_where_no_other_is_told(folder: Path) -> None:
    path = folder / "calibrations" / "cameras.json"
    edit(path, 0, original={"matrix": [[280.0, 0, 161], [0, 280.0, 119], [0, 0, 1]]})
    assert [camera.matrix[0, 0] for camera in load_taken(path)] == [280.0, 300.0, 300.0]
    assert [camera.name for camera in load_taken(path)] == list(NAMES)


def test_alpha_chooses_how_much_is_kept_without_the_lens(folder: Path) -> None:
    lens = {"matrix": [[280.0, 0, 161], [0, 280.0, 119], [0, 0, 1]], "distortion": [-0.2, 0, 0, 0, 0]}
    for index in range(3):
        edit(folder / "calibrations" / "cameras.json", index, original=lens)
    taken = load_taken(folder / "calibrations" / "cameras.json")
    dataset = import_dataset(options(folder, undistort=True, alpha=0.25)).dataset
    for camera, there in zip(dataset.calibrated_cameras(), taken, strict=True):
        assert camera.matrix == pytest.approx(kept_matrix(there, 0.25))
        assert camera.matrix[0, 0] != MATRIX[0, 0]


@pytest.mark.parametrize("changes", [{"alpha": 0.5}, {"alpha": 1.5, "undistort": True}])
def test_an_alpha_without_sense_is_refused(folder: Path, changes: dict[str, object]) -> None:
    assert failure(folder, **changes) == [
        "options: alpha is from 0 to 1, and only where the lens is taken out"
    ]
