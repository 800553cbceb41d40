"""The scenes geometry is tested on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import cv2
import numpy as np

from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder
from gtm_hit.geometry.grid import Grid

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
WILDTRACK_GRID = Grid(columns=480, rows=1440, step=0.025, origin_x=-3.0, origin_y=-9.0)
MULTIVIEWX_GRID = Grid(columns=1000, rows=640, step=0.025, origin_x=0.0, origin_y=0.0)
PERSON = Cylinder(radius=0.16, height=1.80)


def wildtrack_cameras(original: bool = False) -> list[Camera]:
    return load_cameras(FIXTURES / "wildtrack_cameras.json", original)


def multiviewx_cameras(shared_data: Path) -> list[Camera]:
    folder = shared_data / "multiviewx" / "calibrations"
    cameras = []
    for number in range(1, 7):
        extrinsic = ElementTree.parse(folder / "extrinsic" / f"extr_Camera{number}.xml")
        intrinsic = ElementTree.parse(folder / "intrinsic" / f"intr_Camera{number}.xml")
        camera = Camera(
            index=number - 1,
            name=f"C{number}",
            width=1920,
            height=1080,
            matrix=_numbers(intrinsic, "camera_matrix").reshape(3, 3),
            rvec=_numbers(extrinsic, "rvec"),
            tvec=_numbers(extrinsic, "tvec"),
            distortion=_numbers(intrinsic, "distortion_coefficients"),
        )
        cameras.append(camera)
    return cameras


def _numbers(tree: ElementTree.ElementTree, name: str) -> np.ndarray:
    text = tree.findtext(f"{name}/data")
    assert text is not None
    return np.array(text.split(), dtype=np.float64)


def mirrored(camera: Camera) -> Camera:
    """The pose in the world with Y turned round, as left-handed tools write it: depths change sign."""
    rotation = -camera.rotation @ np.diag([1.0, -1.0, 1.0])
    return replace(camera, rvec=cv2.Rodrigues(rotation)[0], tvec=-camera.tvec)


def enlarged(camera: Camera, factor: int = 40) -> Camera:
    """The camera with so many pixels that their numbers do not fit into int16."""
    matrix = camera.matrix * factor
    matrix[2, 2] = 1
    return replace(camera, matrix=matrix, width=camera.width * factor, height=camera.height * factor)


def mirrored_grid(grid: Grid) -> Grid:
    return replace(grid, origin_y=-grid.origin_y - grid.extent[1])
