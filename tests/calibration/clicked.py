"""Pairs of a camera whose place is known: a grid on the ground, clicked where it is seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gtm_hit.calibration.ghosts import expected_pixels
from gtm_hit.calibration.ground_points import GroundPoint, regular_grid
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.pose import Pair, PoseSolution
from gtm_hit.geometry.camera import Camera

# Narrow enough for its fold to lie far outside the picture.
LENS = Lens(
    1920,
    1080,
    np.array([[1700.0, 0, 950], [0, 1695, 530], [0, 0, 1]]),
    np.array([-0.3, 0.1, 1e-3, -5e-4, 0.0]),
)
GRID = regular_grid(5, 5, (2.0, 2.0), (-4.0, 2.0))


def standing(lens: Lens = LENS, height: float = 4.0) -> Camera:
    """It looks along Y, twenty degrees down."""
    down = np.radians(20)
    rotation = np.array([[1, 0, 0], [0, -np.sin(down), -np.cos(down)], [0, np.cos(down), -np.sin(down)]])
    rvec = np.array([np.pi / 2 + down, 0.0, 0.0])
    centre = np.array([0.5, -6.0, height])
    return lens.camera("C1", rvec, -rotation @ centre)


def exact(camera: Camera, lens: Lens = LENS) -> PoseSolution:
    return PoseSolution(camera.rvec, camera.tvec, np.zeros((6, 6)), (), (), lens)


def clicks(
    camera: Camera, points: Sequence[GroundPoint] = GRID, lens: Lens = LENS, noise: float = 0.0, seed: int = 0
) -> list[Pair]:
    rng = np.random.default_rng(seed)
    ghosts = zip(points, expected_pixels(exact(camera, lens), points), strict=True)
    off = rng.normal(0, noise, (len(points), 2)).tolist()
    seen = [(point, ghost, miss) for (point, ghost), miss in zip(ghosts, off, strict=True) if ghost.visible]
    return [Pair(ghost.name, point.place, (ghost.x + dx, ghost.y + dy)) for point, ghost, (dx, dy) in seen]


def swapped(pairs: Sequence[Pair], first: int, second: int) -> list[Pair]:
    spoilt = list(pairs)
    spoilt[first] = replace(pairs[first], pixel=pairs[second].pixel)
    spoilt[second] = replace(pairs[second], pixel=pairs[first].pixel)
    return spoilt


def moved(pairs: Sequence[Pair], index: int, by: tuple[float, float, float]) -> list[Pair]:
    x, y, z = (old + more for old, more in zip(pairs[index].point, by, strict=True))
    return [*pairs[:index], replace(pairs[index], point=(x, y, z)), *pairs[index + 1 :]]
