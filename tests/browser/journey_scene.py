"""What a lab has before it calibrates seven cameras: videos of a board, pictures of marks, frames."""

from __future__ import annotations

import zipfile
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.boards import Board, BoardKind
from gtm_hit.calibration.lens_numbers import lens_of
from gtm_hit.demo.arrays import Bytes
from gtm_hit.demo.boards import board_picture, placements
from gtm_hit.demo.film import quick_painter, smaller, walks_for
from gtm_hit.demo.scene import read_scene
from gtm_hit.geometry.camera import Camera, fold, project
from tests.browser.street import cameras as street_cameras

WIDTH = 960  # pixels of a picture; a click is as coarse in them as it would be in larger ones
BOARD = Board(BoardKind.CHESSBOARD, 9, 6, 0.08)
VIEWS = 14
FRAMES = 2
DISTORTION = np.array([-0.22, 0.09, 0.0006, -0.0004, -0.015])
COLUMNS, ROWS, SPACING, ORIGIN = 5, 9, (2.4, 4.0), (-2.0, -7.0)  # of the measured marks, metres
MARK, LINE = 0.14, 0.025  # a painted cross: half its length and its width, metres
# Tops of sticks that stand on the plaza, metres; nobody measured them.
STICKS = ((-1, -3, 1.6), (2, 2, 2.2), (6, -1, 1.2), (0, 9, 2.4), (5, 6, 1.8), (7, 12, 2.0), (3, 16, 1.5))
RIM = 6  # pixels: nobody clicks nearer to the edge of a picture


@dataclass(frozen=True)
class Belongings:
    """Files as they are sent; folders of one site."""

    videos: dict[str, Path]  # of the board, by camera
    grounds: dict[str, Path]
    points: Path
    frames: Path  # a zip of everything but the calibration


@cache
def cameras() -> tuple[Camera, ...]:
    """WILDTRACK's seven poses and focal lengths, each behind a lens of its own; pictures as taken."""
    rng = np.random.default_rng(11)
    return tuple(
        replace(smaller(each, WIDTH), distortion=DISTORTION * rng.uniform(0.8, 1.1, 5))
        for each in street_cameras()
    )


def marks() -> dict[str, NDArray[np.float64]]:
    """What was measured: metres, by name."""
    return {
        f"{chr(ord('A') + column)}{row + 1}": np.array(
            [ORIGIN[0] + column * SPACING[0], ORIGIN[1] + row * SPACING[1], 0.0]
        )
        for row in range(ROWS)
        for column in range(COLUMNS)
    }


def tops() -> dict[str, NDArray[np.float64]]:
    """Where the sticks end: metres, by name."""
    return {f"stick{number}": np.array(top, dtype=float) for number, top in enumerate(STICKS, start=1)}


def seen(camera: Camera, there: dict[str, NDArray[np.float64]]) -> dict[str, tuple[float, float]]:
    """The pixels at which an eye finds them in the camera's picture."""
    pixels = _shown(camera, np.array(list(there.values())))
    low, high = np.array([RIM, RIM]), np.array([camera.width - RIM, camera.height - RIM])
    return {
        name: (float(x), float(y))
        for name, (x, y) in zip(there, pixels, strict=True)
        if np.isfinite((x, y)).all() and (low <= (x, y)).all() and ((x, y) <= high).all()
    }


def _shown(camera: Camera, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Pixels; NaN for what is behind the camera or farther off its axis than its lens shows."""
    x, y, z = (points @ camera.rotation.T + camera.tvec).T
    shown = (z > 0) & (np.hypot(x, y) < fold(camera) * z)
    return np.where(shown[:, None], project(camera, points), np.nan)


def make(folder: Path) -> Belongings:
    folder.mkdir(parents=True)
    scene = read_scene()
    walks = walks_for(scene, FRAMES)
    videos, grounds, frames = {}, {}, folder / "later.zip"
    with zipfile.ZipFile(frames, "w", zipfile.ZIP_STORED) as archive:
        for camera in cameras():
            paint = quick_painter(scene, camera)
            videos[camera.name] = _board_video(folder / f"board-{camera.name}.avi", camera)
            nobody = replace(walks, xy=np.full_like(walks.xy, 1e4))
            grounds[camera.name] = folder / f"ground-{camera.name}.png"
            empty = _with_sticks(_with_marks(paint(nobody, 0), camera), camera)
            cv2.imwrite(str(grounds[camera.name]), empty)
            for number in range(FRAMES):
                picture = cv2.imencode(".jpg", paint(walks, number))[1].tobytes()
                archive.writestr(f"Image_subsets/{camera.name}/{number:08d}.jpg", picture)
    return Belongings(videos, grounds, _points_file(folder / "marks.csv"), frames)


def _board_video(path: Path, camera: Camera) -> Path:
    """Somebody holds a board into the view, leaning it all ways; two pictures a second."""
    lens = lens_of(camera)
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*"MJPG"), 2, _size(camera))
    assert writer.isOpened(), path
    for number, placement in enumerate(placements(lens, BOARD, VIEWS, seed=camera.index)):
        grey = board_picture(lens, BOARD, placement, seed=VIEWS * camera.index + number)
        writer.write(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR))
    writer.release()
    return path


def _size(camera: Camera) -> tuple[int, int]:
    return camera.width, camera.height


def _with_marks(picture: Bytes, camera: Camera) -> Bytes:
    """Crosses in white paint, each arm bent by the lens as the ground is."""
    along = np.linspace(-MARK, MARK, 9)
    still = np.zeros_like(along)
    for place in marks().values():
        for arm in ((along, still, still), (still, along, still)):
            pixels = _shown(camera, place + np.column_stack(arm))
            if np.isfinite(pixels).all():
                depth = float((camera.rotation @ place + camera.tvec)[2])
                width = max(round(LINE * camera.matrix[0, 0] / depth), 1)
                points = np.round(pixels * 16).astype(np.int32)
                cv2.polylines(picture, [points], False, (245, 245, 245), width, cv2.LINE_AA, 4)
    return picture


def _with_sticks(picture: Bytes, camera: Camera) -> Bytes:
    for top in tops().values():
        along = np.linspace(0, 1, 17)[:, None] * (0, 0, top[2])
        pixels = _shown(camera, top * (1, 1, 0) + along)
        if np.isfinite(pixels).all():
            points = np.round(pixels * 16).astype(np.int32)
            cv2.polylines(picture, [points], False, (40, 40, 40), 2, cv2.LINE_AA, 4)
            cv2.circle(picture, points[-1].tolist(), 2 * 16, (60, 200, 255), -1, cv2.LINE_AA, 4)
    return picture


def _points_file(path: Path) -> Path:
    rows = [f"{name},{100 * x:.1f},{100 * y:.1f}" for name, (x, y, _) in marks().items()]
    path.write_text("\n".join(["# unit: cm", "name,x,y", *rows]) + "\n")
    return path
