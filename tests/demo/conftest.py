from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gtm_hit.demo.people import Cast
from gtm_hit.demo.scene import Scene, read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.camera import Camera

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"


@pytest.fixture(scope="session")
def scene() -> Scene:
    return read_scene()


@pytest.fixture(scope="session")
def cast(scene: Scene) -> Cast:
    return Cast.of(scene)


@pytest.fixture(scope="session")
def cameras() -> list[Camera]:
    return load_cameras(FIXTURES / "wildtrack_cameras.json")


@pytest.fixture(scope="session")
def small_cameras(cameras: list[Camera]) -> list[Camera]:
    """The same views in a sixth of the size: everything but the number of pixels is real."""
    smaller = np.diag([1 / 6, 1 / 6, 1.0])
    return [replace(camera, width=320, height=180, matrix=smaller @ camera.matrix) for camera in cameras]
