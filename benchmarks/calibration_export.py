"""Calibrations written by `calibrate export` and read back, and lenses taken out and put in again.

python -m benchmarks.calibration_export
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.calibration_rows import Row, table
from gtm_hit.formats.calibration.cameras_json import load_cameras, save_cameras
from gtm_hit.geometry.camera import Camera, fold, normalise, project
from gtm_hit.geometry.undistorting import kept_matrix, without_picture
from gtm_hit.management.calibrating import export
from gtm_hit.management.calibrating.reading import USUAL_SIZE, read_cameras

PATH = Path(__file__).resolve().parent.parent / "fixtures" / "wildtrack_cameras.json"
WRITTEN = (  # what, format, unit, bar of every number in metres, radians and pixels
    ("cameras.json", "cameras-json", "m", 1e-9),
    ("WILDTRACK's folder, cm", "wildtrack", "cm", 1e-6),
    ("WILDTRACK's folder, m", "wildtrack", "m", 1e-6),
    ("ba_problem.txt, cm", "ba-problem", "cm", 1e-9),
)
STEP = 20  # pixels from one that the lens is taken out of to the next
LENS_BAR = 0.01  # pixels


def rows(data: Path | None) -> list[Row]:
    """`data` is not needed: the published cameras are a fixture."""
    cameras = load_cameras(PATH, original=True)
    return [*_written(cameras), *_lenses(cameras)]


def _written(cameras: Sequence[Camera]) -> list[Row]:
    found = []
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as name:
        source = Path(name) / "source.json"
        save_cameras(source, cameras)
        for number, (what, form, unit, bar) in enumerate(WRITTEN):
            out = Path(name) / f"out{number}{'.txt' if form == 'ba-problem' else '.json'}"
            here = {"calibration": source, "from_unit": None, "image_size": USUAL_SIZE}
            export.run(here | {"out": out, "format": form, "unit": unit}, lambda _text: None)
            worst = _apart(cameras, read_cameras(here | {"calibration": out}))
            found.append(
                Row(f"export: {what}, read back", f"{worst:.1g} at worst", f"≤ {bar:.0e}", worst <= bar)
            )
    return found


def _apart(before: Sequence[Camera], after: Sequence[Camera]) -> float:
    return max(
        float(np.abs(getattr(here, name) - getattr(there, name)).max())
        for here, there in zip(before, after, strict=True)
        for name in ("matrix", "rvec", "tvec", "distortion")
    )


def _lenses(cameras: Sequence[Camera]) -> list[Row]:
    ours, theirs, black = [], [], []
    for camera in cameras:
        pixels = _pixels(camera)
        rays = normalise(camera, pixels)
        there = np.isfinite(rays).all(axis=1) & (np.hypot(*rays.T) < fold(camera))
        opencv = cv2.undistortPoints(pixels[there, None], camera.matrix, camera.distortion)[:, 0].astype(
            np.float64
        )
        ours.append(_miss(camera, rays[there], pixels[there]))
        theirs.append(_miss(camera, opencv, pixels[there]))
        black.append(float(without_picture(camera, kept_matrix(camera, 1.0)).mean()))
    worst, other = max(ours), max(theirs)
    said = f"{worst:.1g} px (cv2.undistortPoints as it comes: {other:.0f} px)"
    shares = f"{100 * min(black):.0f} to {100 * max(black):.0f} %"
    return [
        Row("undistort: taken out and put in again, 7 lenses", said, f"≤ {LENS_BAR} px", worst <= LENS_BAR),
        Row("undistort: alpha 1, pixels that show nothing and are black", shares, "", None),
    ]


def _pixels(camera: Camera) -> NDArray[np.float64]:
    columns, rows_of = np.meshgrid(np.arange(0, camera.width, STEP), np.arange(0, camera.height, STEP))
    return np.column_stack((columns.ravel(), rows_of.ravel())).astype(np.float64)


def _miss(camera: Camera, rays: NDArray[np.float64], pixels: NDArray[np.float64]) -> float:
    """The most pixels by which rays, seen through the lens again, miss where they came from."""
    world = np.column_stack((rays, np.ones(len(rays))))
    return float(np.hypot(*(project(_at_origin(camera), world) - pixels).T).max())


def _at_origin(camera: Camera) -> Camera:
    return replace(camera, rvec=np.zeros(3), tvec=np.zeros(3))


if __name__ == "__main__":
    print(table(rows(None)))
