"""Whether cameras that moved are found: the demo scene rendered by cameras moved by known amounts.

Marks come from five pictures; two later ones, with people elsewhere, are compared with them, and each once
more darkened and once with much noise.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from pathlib import Path

import cv2
import numpy as np

from benchmarks.calibration_rows import Row
from gtm_hit.calibration.drift.checking import MOVED, STILL, Drift, check
from gtm_hit.calibration.drift.marks import Grey, choose
from gtm_hit.demo.backdrop import Place
from gtm_hit.demo.film import smaller
from gtm_hit.demo.people import Cast, moment
from gtm_hit.demo.scene import Scene, read_scene
from gtm_hit.demo.view import View, photograph
from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.camera import Camera

CAMERAS = Path(__file__).resolve().parent.parent / "fixtures" / "wildtrack_cameras.json"
VIEWS = ((7, (0, 2, 5)), (11, (1, 3, 6)))  # seed of the people, cameras
SHIFTS = (0.0, 0.5, 1.0, 2.0, 3.0, 5.0)  # pixels
TURNS = (0.1, 0.3)  # degrees about the axis
WIDTH = 960
BEFORE, AFTER = (0, 3, 6, 9, 12), (16, 19)  # frames
NOISE, GAIN, OFFSET = 6.0, 0.7, 20.0
ERROR = 0.3  # pixels


@dataclass(frozen=True)
class Try:
    shift: float
    turn: float
    found: Drift


def rows(data: Path | None) -> list[Row]:
    """`data` is not needed: everything is rendered here."""
    jobs = [(seed, view) for seed, views in VIEWS for view in views]
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        tries = [each for found in pool.map(_tries, *zip(*jobs, strict=True)) for each in found]
    return _rows(tries, len(jobs))


def _rows(tries: list[Try], cameras: int) -> list[Row]:
    shifted = [each for each in tries if not each.turn]
    turned = [each for each in tries if each.turn]
    still = [each for each in shifted if each.shift == 0]
    small = [each for each in shifted if each.shift <= 1]
    large = [each for each in shifted if each.shift >= 3]
    errors = [abs(each.found.px - each.shift) if each.found.px is not None else 1e3 for each in shifted]
    off = [abs(each.found.degrees - each.turn) if each.found.degrees is not None else 1e3 for each in turned]
    worst, degrees = max(errors), max(off)
    steady = sum(each.found.state == STILL for each in still)
    alarms = sum(each.found.state == MOVED for each in small)
    found = sum(each.found.state == MOVED for each in large)
    where = f"drift: {cameras} cameras"
    return [
        Row(f"{where}, shifts 0 to 5 px: worst error", f"{worst:.2f} px", f"≤ {ERROR} px", worst <= ERROR),
        Row("… 3 and 5 px warned of", f"{found} of {len(large)}", "all", found == len(large)),
        Row("… 0, 0.5 and 1 px warned of", f"{alarms} of {len(small)}", "none", alarms == 0),
        Row(
            "… 0 px with people, noise, other light: steady",
            f"{steady} of {len(still)}",
            "all",
            steady == len(still),
        ),
        Row("… turns of 0.1° and 0.3°: worst error", f"{degrees:.3f}°", "", None),
    ]


def _tries(seed: int, view: int) -> list[Try]:
    cv2.setNumThreads(1)
    scene = replace(read_scene(), seed=seed)
    camera = smaller(load_cameras(CAMERAS)[view], WIDTH)
    place, cast = Place(scene), Cast.of(scene)
    marks = choose(_shots(scene, camera, place, cast, BEFORE))
    rng = np.random.default_rng((seed, view))
    tries = []
    for shift, turn in [*((shift, 0.0) for shift in SHIFTS), *((0.0, turn) for turn in TURNS)]:
        there = _moved(camera, shift, float(rng.uniform(0, 2 * np.pi)), turn)
        for shot in _shots(scene, there, place, cast, AFTER):
            noisy = np.clip(shot + rng.normal(0, NOISE, shot.shape), 0, 255).astype(np.uint8)
            dark = np.asarray(cv2.convertScaleAbs(shot, alpha=GAIN, beta=OFFSET), np.uint8)
            tries += [
                Try(shift, turn, check(camera.name, marks, each, camera)) for each in (shot, noisy, dark)
            ]
    return tries


def _moved(camera: Camera, shift: float, direction: float, turn: float) -> Camera:
    """The principal point shifted, and the camera turned about its axis."""
    matrix = camera.matrix.copy()
    matrix[:2, 2] += (shift * np.cos(direction), shift * np.sin(direction))
    about = cv2.Rodrigues(np.array([0.0, 0.0, np.deg2rad(turn)]))[0]
    rvec = cv2.Rodrigues(about @ camera.rotation)[0].ravel()
    return replace(camera, matrix=matrix, rvec=rvec, tvec=about @ camera.tvec)


def _shots(scene: Scene, camera: Camera, place: Place, cast: Cast, frames: tuple[int, ...]) -> list[Grey]:
    view = View.of(scene, camera, place.backdrop(camera))
    found = []
    for frame in frames:
        now = moment(cast, frame, (place.sun_map, place.shade))
        picture = photograph(scene, camera, view, cast, now, frame)
        found.append(np.asarray(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY), np.uint8))
    return found
