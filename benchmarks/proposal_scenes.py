"""Pictures with the truth about them, for the benchmarks and the gate in the tests.

MultiviewX and WILDTRACK's one real frame as in the published samples, and the demo scene, which the project
renders itself.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np

from gtm_hit.demo.render import render_scene, truth
from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.formats.calibration.wildtrack_xml import read_extrinsic, read_intrinsic
from gtm_hit.geometry.camera import Camera, undistort_maps
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.background import Pictures
from gtm_hit.vision.boxes import Picture
from gtm_hit.vision.proposing import Scene

ROOT = Path(__file__).resolve().parent.parent
CAMERAS = ROOT / "fixtures" / "wildtrack_cameras.json"
FRAMES = 10
# People beyond this line are in MultiviewX's pictures but not in its annotations.
MULTIVIEWX_ANNOTATED = 15.0  # metres along Y


@dataclass(frozen=True, eq=False)
class Known:
    """Everybody annotated in one frame."""

    xy: np.ndarray  # (N, 2) metres
    persons: np.ndarray  # (N,)


@dataclass(frozen=True)
class Example:
    """Frames with the truth about some of them."""

    name: str
    scene: Scene
    frames: Sequence[Pictures]
    known: Mapping[int, Known]  # by frame
    ends: float = float("inf")  # metres along Y to which people are annotated

    @property
    def truth(self) -> dict[int, np.ndarray]:
        """Places (N, 2) by frame."""
        return {frame: known.xy for frame, known in self.known.items()}


class Folder(Sequence[Pictures]):
    """Pictures of frames, read when asked for and changed on the way."""

    def __init__(self, paths: Sequence[Mapping[str, Path]], change: Callable[[Picture], Picture]) -> None:
        self.paths, self.change = paths, change

    def __len__(self) -> int:
        return len(self.paths)

    def __getitem__(self, place):
        if isinstance(place, slice):
            return Folder(self.paths[place], self.change)
        return {name: self.change(cv2.imread(str(path))) for name, path in self.paths[place].items()}


def unchanged(picture: Picture) -> Picture:
    return picture


def noisy(picture: Picture) -> Picture:
    """Sensor noise of 6 levels, a gain of 3 %, strong compression."""
    rng = np.random.default_rng(int(picture[::50, ::50].sum()))
    spoilt = picture * rng.normal(1.0, 0.03) + rng.normal(0.0, 6.0, picture.shape)
    data = cv2.imencode(".jpg", np.clip(spoilt, 0, 255).astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, 70])[1]
    return cv2.imdecode(data, cv2.IMREAD_COLOR)


def halved(picture: Picture) -> Picture:
    return cv2.resize(picture, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)


def multiviewx(folder: Path, change: Callable[[Picture], Picture] = unchanged) -> Example:
    cameras = {}
    for index in range(6):
        lens = read_intrinsic(folder / f"calibrations/intrinsic/intr_Camera{index + 1}.xml")
        pose = read_extrinsic(folder / f"calibrations/extrinsic/extr_Camera{index + 1}.xml")
        name = f"C{index + 1}"
        cameras[name] = Camera(index, name, 1920, 1080, lens.matrix, pose.rvec, pose.tvec, lens.distortion)
    numbers = sorted(int(path.stem) for path in (folder / "Image_subsets/C1").glob("*.jpg"))[:FRAMES]
    paths = [{name: folder / f"Image_subsets/{name}/{n:04d}.jpg" for name in cameras} for n in numbers]
    grid = Grid(1000, 640, 0.025, 0.0, 0.0)
    known = {}
    for place, number in enumerate(numbers):  # annotation 00001 belongs to picture 0000
        file = folder / f"annotations_positions/{number + 1:05d}.json"
        if file.exists():
            rows = json.loads(file.read_text())
            xy = grid.metres([row["positionID"] for row in rows])
            known[place] = Known(xy, np.array([row["personID"] for row in rows]))
    scene = Scene(cameras, grid, rule=FootRule.CENTRE)
    return Example("MultiviewX", scene, Folder(paths, change), known, MULTIVIEWX_ANNOTATED)


def demo(folder: Path, frames: int = FRAMES) -> Example:
    """The demo scene's first frames, rendered into the folder unless they are there."""
    scene = replace(read_scene(), frame_count=frames)
    cameras = {camera.name: camera for camera in load_cameras(CAMERAS)}
    if not (folder / "Image_subsets").exists():
        render_scene(scene, list(cameras.values()), folder)
    paths = [
        {name: folder / f"Image_subsets/C{camera.index + 1}/{n:08d}.jpg" for name, camera in cameras.items()}
        for n in scene.frame_numbers
    ]
    known, everybody = {}, truth(scene)
    for place, number in enumerate(scene.frame_numbers):
        rows = [row for row in everybody if row.number == number]
        known[place] = Known(
            np.array([(row.x, row.y) for row in rows]), np.array([row.person for row in rows])
        )
    return Example("demo scene", Scene(cameras, scene.grid), Folder(paths, unchanged), known)


def wildtrack(folder: Path) -> Example:
    """The one real frame, its lenses taken out."""
    cameras = {camera.name: camera for camera in load_cameras(CAMERAS)}
    pictures = {}
    for taken in load_cameras(CAMERAS, original=True):
        picture = cv2.imread(str(folder / f"original_frames/C{taken.index + 1}/00000000.jpg"))
        maps = undistort_maps(taken, cameras[taken.name].matrix)
        pictures[taken.name] = cv2.remap(picture, *maps, cv2.INTER_LINEAR)
    return Example("WILDTRACK", Scene(cameras, Grid(480, 1440, 0.025, -3.0, -9.0)), [pictures], {})
