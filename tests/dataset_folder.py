"""A small dataset as files: three cameras around a square of ground, two frames, two people."""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from gtm_hit.formats.annotations.wildtrack_json import (
    FrameAnnotations,
    PersonPosition,
    write_frame,
)
from gtm_hit.formats.calibration.wildtrack_xml import (
    Extrinsic,
    Intrinsic,
    Style,
    extrinsic_xml,
    intrinsic_xml,
)
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid
from gtm_hit.ops.datasets.options import ImportOptions, SceneValues

WIDTH, HEIGHT = 320, 240
GRID = Grid(80, 60, 0.1, -4.0, -3.0)
CYLINDER = Cylinder(0.16, 1.8)
VALUES = SceneValues(
    columns=80, rows=60, step=0.1, origin_x=-4.0, origin_y=-3.0, frame_rate=10.0, frame_step=5
)
MATRIX = np.array([[300.0, 0.0, 160.0], [0.0, 300.0, 120.0], [0.0, 0.0, 1.0]])
CENTRES = [(0.0, -9.0, 4.5), (9.5, -4.5, 3.2), (1.5, 9.0, 3.5)]  # metres
NAMES = ("C1", "C2", "C3")
PEOPLE = {0: {7: 1220, 3: 2440}, 5: {7: 1221, 3: 2440, 9: 3000}}


def pose(centre: tuple[float, float, float]) -> Extrinsic:
    """Of an upright camera that looks at the middle of the square, metres."""
    forward = np.array([0.0, 0.0, 0.8]) - centre
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(forward, right), forward])
    return Extrinsic(cv2.Rodrigues(rotation)[0].ravel(), -rotation @ centre)


POSES = [pose(centre) for centre in CENTRES]


def cameras() -> list[Camera]:
    return [
        Camera(index, NAMES[index], WIDTH, HEIGHT, MATRIX, each.rvec, each.tvec, np.zeros(5))
        for index, each in enumerate(POSES)
    ]


def picture(seed: int, width: int = WIDTH, height: int = HEIGHT, kind: str = "PNG") -> bytes:
    """Coarse noise: different for every seed, with something for a codec to lose."""
    noise = np.random.default_rng(seed).integers(0, 256, (12, 16, 3), dtype=np.uint8)
    stream = io.BytesIO()
    Image.fromarray(noise).resize((width, height), Image.Resampling.BILINEAR).save(stream, kind)
    return stream.getvalue()


def add_images(root: Path, frames: Iterable[int], names: Iterable[str] = NAMES) -> None:
    for index, name in enumerate(names):
        for frame in frames:
            path = root / "Image_subsets" / name / f"{frame:08d}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(picture(1000 * index + frame))


def add_calibrations(root: Path, tvec_unit: str = "m") -> None:
    for part in ("extrinsic", "intrinsic_zero"):
        (root / "calibrations" / part).mkdir(parents=True, exist_ok=True)
    for name, each in zip(NAMES, POSES, strict=True):
        extrinsic = extrinsic_xml(each.in_unit(tvec_unit), Style.MATRIX)
        (root / "calibrations" / "extrinsic" / f"extr_{name}.xml").write_bytes(extrinsic)
        lens = intrinsic_xml(Intrinsic(MATRIX, np.zeros(5)))
        (root / "calibrations" / "intrinsic_zero" / f"intr_{name}.xml").write_bytes(lens)


def add_annotations(root: Path, people: dict[int, dict[int, int]]) -> None:
    for number, positions in people.items():
        found = [PersonPosition(person, position, boxes(position)) for person, position in positions.items()]
        write_frame(root / "annotations_positions", FrameAnnotations(number, found), len(NAMES))


def boxes(position: int) -> np.ndarray:
    """(cameras, 4), -1 where not visible."""
    rows = []
    for camera in cameras():
        box, visible = rectangles(camera, GRID, CYLINDER, FootRule.CORNERS, [position])
        rows.append(box[0] if visible[0] else np.full(4, -1))
    return np.array(rows)


def make_folder(root: Path, frames: Iterable[int] = (0, 5)) -> Path:
    frames = list(frames)
    add_images(root, frames)
    add_calibrations(root)
    add_annotations(root, {number: PEOPLE[number] for number in frames if number in PEOPLE})
    return root


def options(root: Path, **changes: object) -> ImportOptions:
    return ImportOptions(**{"slug": "square", "folder": root, "values": VALUES, **changes})  # type: ignore[arg-type]
