from __future__ import annotations

from pathlib import Path

from gtm_hit.api.workbench.scene import dataset_part
from gtm_hit.formats.calibration.cameras_json import load_cameras, save_cameras
from gtm_hit.models import Dataset


def test_scene_and_file_hold_a_cameras_numbers_alike(dataset: Dataset, tmp_path: Path) -> None:
    cameras = dataset.calibrated_cameras()
    save_cameras(tmp_path / "cameras.json", cameras)
    read = [camera.as_json() for camera in load_cameras(tmp_path / "cameras.json")]
    scene = [
        {name: each[name] for name in each if name != "grid"} for each in dataset_part(dataset)["cameras"]
    ]
    assert scene == read == [camera.as_json() for camera in cameras]
