"""Views of the demo scene's people from different instants on: 25, 29.97 and 59.94 pictures a second."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from gtm_hit.demo.film import Take, film, quick_painter, smaller, walks_for
from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras, save_cameras
from tests.conftest import REPOSITORY

STARTS, RATES, VIEWS = (2.0, 1.111, 2.468), (25.0, 30000 / 1001, 60000 / 1001), (0, 3, 6)
SECONDS = 14.0


def make_filmed(folder: Path, calibrations: Path) -> Path:
    """A video for each view in `folder`, named as its camera, and their cameras in `calibrations`."""
    scene = replace(read_scene(), seed=7)
    known = load_cameras(REPOSITORY / "fixtures" / "wildtrack_cameras.json")
    cameras = [smaller(known[view], 384) for view in VIEWS]
    walks = walks_for(scene, SECONDS + max(STARTS))
    calibrations.mkdir(parents=True, exist_ok=True)
    for camera, start, rate in zip(cameras, STARTS, RATES, strict=True):
        take = Take(camera, folder / f"{camera.name}.mp4", start, rate, SECONDS)
        film(take, walks, quick_painter(scene, camera))
    save_cameras(calibrations / "cameras.json", cameras)
    return folder
