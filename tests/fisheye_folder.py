"""Two frames of the demo scene, small, taken by a fisheye and by an ordinary camera."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import cv2
import numpy as np

from gtm_hit.demo.backdrop import Place
from gtm_hit.demo.people import Cast, moment
from gtm_hit.demo.render import Truth, truth
from gtm_hit.demo.scene import Scene, read_scene
from gtm_hit.demo.view import View, photograph
from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.geometry.camera import Camera, CameraModel, normalise
from gtm_hit.ops.datasets.options import ImportOptions, SceneValues
from tests.geometry.scenes import wildtrack_cameras

SIZE = (960, 540)
LENS = np.array([0.06, -0.015, 0.003, -0.0004])
FRAMES = 2


def matrix(focal: float, width: float, height: float) -> np.ndarray:
    return np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]])


def cameras() -> list[Camera]:
    """106° wide where C1 stands, and C2 at half its size."""
    first, second = wildtrack_cameras()[:2]
    half = second.matrix / 2
    half[2, 2] = 1
    size = {"width": SIZE[0], "height": SIZE[1]}
    wide = {"matrix": matrix(520, *SIZE), "distortion": LENS, "model": CameraModel.FISHEYE}
    return [replace(first, **size, **wide), replace(second, **size, matrix=half)]  # type: ignore[arg-type]


@cache
def scene() -> Scene:
    return replace(read_scene(), frame_count=FRAMES)


@cache
def people() -> list[Truth]:
    return truth(scene())


def write(folder: Path) -> Path:
    """The dataset's folder, with `cameras.json`."""
    place, cast = Place(scene()), Cast.of(scene())
    for camera in cameras():
        seen = _flat(camera) if camera.model is CameraModel.FISHEYE else camera
        view = View.of(scene(), seen, place.backdrop(seen))
        for frame, number in enumerate(scene().frame_numbers):
            now = moment(cast, frame, (place.sun_map, place.shade))
            picture = photograph(scene(), seen, view, cast, now, frame)
            shown = picture if seen is camera else _bent(picture, seen, camera)
            path = folder / "Image_subsets" / camera.name / f"{number:08d}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(path), shown[..., ::-1])
    save_cameras(folder / "calibrations" / "cameras.json", cameras())
    return folder


def options(folder: Path) -> ImportOptions:
    grid = scene().grid
    values = SceneValues(
        columns=grid.columns,
        rows=grid.rows,
        step=grid.step,
        origin_x=grid.origin_x,
        origin_y=grid.origin_y,
        frame_rate=scene().numbers_per_second,
        frame_step=scene().number_step,
    )
    return ImportOptions(slug="fisheye", folder=folder, values=values)


def _flat(camera: Camera) -> Camera:
    """What sees all that the fisheye does, without a lens: the renderer knows no other."""
    bare = {"distortion": np.zeros(5), "model": CameraModel.PINHOLE}
    return replace(camera, width=1280, height=800, matrix=matrix(330, 1280, 800), **bare)  # type: ignore[arg-type]


def _bent(picture: np.ndarray, flat: Camera, camera: Camera) -> np.ndarray:
    v, u = np.mgrid[: camera.height, : camera.width]
    rays = normalise(camera, np.column_stack((u.ravel(), v.ravel())))
    pixels = rays * flat.matrix[0, 0] + flat.matrix[:2, 2]
    across, down = pixels.astype(np.float32).reshape(*u.shape, 2).transpose(2, 0, 1)
    return cv2.remap(picture, across, down, cv2.INTER_LINEAR)
