"""A bundle adjustment of the real one's kind and size, of which the truth is known.

Seven published cameras, people walking where two of them see them, 40 measured points on the ground. Clicks
are off by 1 px (one standard deviation) along each axis; one in twenty was made on something else.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from gtm_hit.calibration.adjustment.problem import Problem, Sightings, View
from gtm_hit.calibration.lens_numbers import Lens, lens_of
from gtm_hit.formats.calibration.cameras_json import load_taken
from gtm_hit.geometry.camera import Camera, normalise, project

FIXTURE = Path(__file__).resolve().parent.parent / "fixtures" / "wildtrack_cameras.json"
PEOPLE = 720
SEED = 20170509
CLICK, GROSS = 1.0, 30.0  # pixels
GROSS_SHARE = 0.05
SEEN_SHARE = 0.62  # of people are not hidden by others
SAFE_RADIUS = 0.6  # in focal lengths: within all seven folds


def true_cameras() -> list[Camera]:
    return load_taken(FIXTURE)


def synthesised() -> tuple[Problem, list[Camera]]:
    """The problem, which starts as far off as the real one does, and its true cameras."""
    rng = np.random.default_rng(SEED)
    cameras = true_cameras()
    feet = np.column_stack((rng.uniform((-3, -9), (9, 26), (PEOPLE, 2)), np.zeros(PEOPLE)))
    heads = feet + np.column_stack((np.zeros((PEOPLE, 2)), rng.normal(1.72, 0.09, PEOPLE)))
    points = np.stack((feet, heads), axis=1).reshape(-1, 3)
    x, y = np.meshgrid(np.arange(-2, 9, 2.2), np.arange(-8, 21, 4.0))
    grid = np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))
    seen = _clicked(cameras, points, SEEN_SHARE, GROSS_SHARE, rng)
    views = tuple(_beside(camera, rng) for camera in cameras)
    start = points + rng.normal(0, 0.5, points.shape)
    return Problem(views, start, seen, grid, _clicked(cameras, grid, 0.9, 0.0, rng)), cameras


def _clicked(
    cameras: list[Camera], points: np.ndarray, share: float, gross: float, rng: np.random.Generator
) -> Sightings:
    rows = []
    for number, camera in enumerate(cameras):
        clean = project(camera, points)
        depth = points @ camera.rotation[2] + camera.tvec[2]
        plane = (points @ camera.rotation[:2].T + camera.tvec[:2]) / depth[:, None]
        seen = (depth > 0) & (np.hypot(*plane.T) < SAFE_RADIUS) & (rng.random(len(points)) < share)
        seen &= ((clean > 0) & (clean < (camera.width, camera.height))).all(axis=1)
        off = rng.normal(0, CLICK, clean.shape)
        far = rng.random(len(points)) < gross
        off[far] += rng.normal(0, GROSS, (int(far.sum()), 2))
        rows += [(number, point, *(clean + off)[point]) for point in np.flatnonzero(seen)]
    table = np.array(rows)
    return Sightings(table[:, 0].astype(np.int64), table[:, 1].astype(np.int64), table[:, 2:])


def view_of(camera: Camera) -> View:
    return View(camera.name, lens_of(camera), camera.rvec, camera.tvec)


def _beside(camera: Camera, rng: np.random.Generator) -> View:
    """Lens and pose as a board and a few measured points give them: somewhat off."""
    lens = lens_of(camera)
    matrix, distortion = lens.matrix.copy(), lens.distortion.copy()
    matrix[[0, 1], [0, 1]] *= 1 + rng.normal(0, 0.005, 2)
    matrix[:2, 2] += rng.normal(0, 10, 2)
    distortion += rng.normal(0, 1, 5) * (0.01, 0.03, 0.001, 0.001, 0.04)
    moved = camera.centre + rng.normal(0, 0.12, 3)
    turned = replace(camera, rvec=camera.rvec + rng.normal(0, 0.004, 3))
    off = Lens(camera.width, camera.height, matrix, distortion)
    return View(camera.name, off, turned.rvec, -turned.rotation @ moved)


def pixels_off(view: View, camera: Camera) -> float:
    """Median of the pixels by which a view shows things 15 m away beside where the true camera does."""
    across, down = np.meshgrid(np.linspace(60, 1860, 13), np.linspace(60, 1020, 9))
    pixels = np.column_stack((across.ravel(), down.ravel()))
    plane = normalise(camera, pixels)
    shown = ~np.isnan(plane[:, 0])
    rays = np.column_stack((plane, np.ones(len(plane))))[shown] * 15.0
    points = (rays - camera.tvec) @ camera.rotation
    return float(np.median(np.hypot(*(project(view.camera(), points) - pixels[shown]).T)))
