"""Bundle adjustments whose answer is known: people on the ground before the seven published cameras."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gtm_hit.calibration.adjustment.problem import Problem, Sightings, View
from gtm_hit.calibration.lens_numbers import lens_of
from gtm_hit.geometry.camera import Camera, project
from tests.geometry.scenes import wildtrack_cameras

Array = np.ndarray


def true_cameras(count: int = 3) -> list[Camera]:
    return wildtrack_cameras(original=True)[:count]


def view_of(camera: Camera, **facts: object) -> View:
    return View(camera.name, lens_of(camera), camera.rvec, camera.tvec, **facts)


def sightings(cameras: list[Camera], points: Array, noise: float, rng: np.random.Generator) -> Sightings:
    rows = []
    for number, camera in enumerate(cameras):
        pixels = project(camera, points) + rng.normal(0, noise, (len(points), 2))
        inside = ((pixels > 0) & (pixels < (camera.width, camera.height))).all(axis=1)
        # Beyond the fold of a lens a projection comes back into the picture.
        depth = points @ camera.rotation[2] + camera.tvec[2]
        plane = (points @ camera.rotation[:2].T + camera.tvec[:2]) / depth[:, None]
        inside &= (depth > 0) & (np.hypot(*plane.T) < 0.6)
        rows += [(number, point, *pixels[point]) for point in np.flatnonzero(inside)]
    table = np.array(rows)
    return Sightings(table[:, 0].astype(np.int64), table[:, 1].astype(np.int64), table[:, 2:])


def people(count: int, rng: np.random.Generator) -> Array:
    """Feet and heads of `count` people on the plaza, (2 count, 3)."""
    feet = np.column_stack((rng.uniform((-2, -7), (8, 20), (count, 2)), np.zeros(count)))
    heads = feet + np.column_stack((np.zeros((count, 2)), rng.uniform(1.5, 1.9, count)))
    return np.stack((feet, heads), axis=1).reshape(-1, 3)


def ground_grid() -> Array:
    x, y = np.meshgrid(np.arange(-1.5, 8, 2.5), np.arange(-6, 18, 3.0))
    return np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))


def off(view: View, rng: np.random.Generator, lenses: bool) -> View:
    """The view somewhat beside where it is."""
    moved = replace(view, rvec=view.rvec + rng.normal(0, 0.005, 3), tvec=view.tvec + rng.normal(0, 0.1, 3))
    if not lenses:
        return moved
    matrix = view.lens.matrix.copy()
    matrix[:2, 2] += rng.normal(0, 8, 2)
    matrix[[0, 1], [0, 1]] *= 1 + rng.normal(0, 0.005, 2)
    return replace(moved, lens=replace(view.lens, matrix=matrix))


def scene(
    seed: int = 0, cameras: int = 3, crowd: int = 40, noise: float = 1.0, lenses: bool = False
) -> tuple[Problem, Array]:
    """A problem that starts beside the truth, and the true points."""
    rng = np.random.default_rng(seed)
    truth = true_cameras(cameras)
    points, grid = people(crowd, rng), ground_grid()
    views = tuple(off(view_of(camera), rng, lenses) for camera in truth)
    seen, measured_seen = sightings(truth, points, noise, rng), sightings(truth, grid, noise, rng)
    start = points + rng.normal(0, 0.3, points.shape)
    return Problem(views, start, seen, grid, measured_seen), points


def centres_off(views: tuple[View, ...]) -> Array:
    """(C,) metres from the true places of the cameras."""
    truth = true_cameras(len(views))
    return np.array(
        [
            np.linalg.norm(view.camera().centre - camera.centre)
            for view, camera in zip(views, truth, strict=True)
        ]
    )
