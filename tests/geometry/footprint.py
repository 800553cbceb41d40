"""The part of the ground a camera sees: what `footprint` of the pages is compared with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, normalise
from gtm_hit.geometry.grid import Grid

Floats = NDArray[np.float64]

BORDER_SAMPLES = 48  # per side of a picture whose border the lens bends
HORIZON_MARGIN = 1e-4  # slope of the flattest ray counted as meeting the ground: 10,000 camera heights away


def footprint(camera: Camera, grid: Grid) -> Floats:
    """Corners, (M, 2) metres, of the ground inside the picture, clipped to the grid's extent.

    M is 0 when the camera sees nothing of the grid.
    """
    border = _border(camera)
    rays = np.column_stack((border, np.ones(len(border)))) @ camera.rotation * camera.facing
    # On the way to the ground a ray loses the camera's height: the ray's z has the other sign.
    towards = rays * (-np.sign(camera.centre[2]) or 1.0)
    below_horizon = clip(rays, towards[:, 2] - HORIZON_MARGIN)
    if not len(below_horizon):
        return np.empty((0, 2))
    reach = -camera.centre[2] / below_horizon[:, 2]
    ground = camera.centre[:2] + reach[:, None] * below_horizon[:, :2]
    return _clip_to_grid(ground, grid)


def clip(polygon: Floats, inside: Floats) -> Floats:
    """The part of a polygon (M, k) where `inside` (M,), a linear function of the corners, is not negative."""
    if not len(polygon):
        return polygon
    following, inside_following = np.roll(polygon, -1, axis=0), np.roll(inside, -1)
    kept = []
    for corner, other, here, there in zip(polygon, following, inside, inside_following, strict=True):
        if here >= 0:
            kept.append(corner)
        if (here >= 0) != (there >= 0):
            kept.append(corner + (other - corner) * (here / (here - there)))
    return np.array(kept).reshape(-1, polygon.shape[1])


def _border(camera: Camera) -> Floats:
    """The picture's border as directions x/z, y/z without the lens, (M, 2)."""
    left, top, right, bottom = -0.5, -0.5, camera.width - 0.5, camera.height - 0.5
    corners = np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
    samples = BORDER_SAMPLES if camera.has_lens else 1
    along = np.arange(samples)[None, :, None] / samples
    sides = corners[:, None] + (np.roll(corners, -1, axis=0) - corners)[:, None] * along
    directions = normalise(camera, sides.reshape(-1, 2))
    return directions[~np.isnan(directions).any(axis=1)]


def _clip_to_grid(polygon: Floats, grid: Grid) -> Floats:
    lows = (grid.origin_x, grid.origin_y)
    for axis, (low, size) in enumerate(zip(lows, grid.extent, strict=True)):
        polygon = clip(polygon, polygon[:, axis] - low)
        polygon = clip(polygon, low + size - polygon[:, axis])
    return polygon
