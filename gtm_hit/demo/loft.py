"""Smooth closed surfaces: rings of points strung along a line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gtm_hit.demo.arrays import Floats

SECTORS = 20


@dataclass(frozen=True)
class Part:
    """A surface and its colours.

    `points` is (R, S + 1, 3) metres: R rings of S sectors, the last column repeating the first, which is at
    the back; columns run back, right, front, left. `colours` (h, w, 3), linear light, is stretched over it.
    """

    points: Floats
    colours: Floats
    detail: bool = False  # too small to be seen from afar


def ring_angles(sectors: int = SECTORS) -> Floats:
    return np.linspace(-np.pi, np.pi, sectors + 1)


def loft(
    centres: Floats,
    left: Floats,
    front: Floats,
    width: ArrayLike,
    depth: ArrayLike,
    power: float = 2.0,
    sectors: int = SECTORS,
) -> Floats:
    """Rings (R, S + 1, 3) around centres (R, 3), half as wide as `width` and `depth` (R,) say.

    `left` and `front` are unit vectors, (3,) or (R, 3); power 2 makes ellipses, more makes them boxy.
    """
    angles = ring_angles(sectors)
    across, ahead = _rounded(np.sin(angles), power), _rounded(np.cos(angles), power)
    width, depth = (np.broadcast_to(np.asarray(size, float), len(centres)) for size in (width, depth))
    sideways = np.broadcast_to(left, centres.shape)[:, None] * (width[:, None] * across)[..., None]
    forwards = np.broadcast_to(front, centres.shape)[:, None] * (depth[:, None] * ahead)[..., None]
    return centres[:, None] + sideways + forwards


def limb(
    joints: Floats, forward: Floats, stations: ArrayLike, width: ArrayLike, depth: ArrayLike, bend: float
) -> Floats:
    """A tube along the polyline `joints` (3, 3), bent smoothly in the middle, closed at both ends.

    Stations (R,) run 0…2 along the two bones; `bend` is the share of a bone that is rounded off.
    """
    stations = np.asarray(stations, float)
    centres = bent_line(joints, stations, bend)
    tangents = bent_line(joints, stations + 0.02, bend) - bent_line(joints, stations - 0.02, bend)
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    front = forward - tangents * (tangents @ forward)[:, None]
    front /= np.linalg.norm(front, axis=1, keepdims=True)
    left = np.cross(front, tangents)
    return loft(centres, left, front, width, depth)


def bent_line(joints: Floats, stations: Floats, bend: float) -> Floats:
    """Points (R, 3) at stations 0…2 of a line through three joints whose corner is a quadratic curve."""
    first, middle, last = joints
    straight = np.where(
        (stations < 1)[:, None],
        first + (middle - first) * stations[:, None],
        middle + (last - middle) * (stations - 1)[:, None],
    )
    share = np.clip((stations - 1 + bend) / (2 * bend), 0, 1)[:, None]
    start, end = middle + (first - middle) * bend, middle + (last - middle) * bend
    curve = (1 - share) ** 2 * start + 2 * share * (1 - share) * middle + share**2 * end
    return np.where((np.abs(stations - 1) < bend)[:, None], curve, straight)


def ball(centre: Floats, left: Floats, front: Floats, up: Floats, size: ArrayLike, rings: int = 9) -> Floats:
    """An ellipsoid with half axes `size` (left, front, up)."""
    width, depth, height = np.asarray(size, float)
    tilt = np.linspace(-np.pi / 2, np.pi / 2, rings)
    centres = centre + np.sin(tilt)[:, None] * height * up
    return loft(centres, left, front, width * np.cos(tilt), depth * np.cos(tilt), sectors=14)


def box(
    centre: Floats, left: Floats, front: Floats, up: Floats, size: ArrayLike, power: float = 6.0
) -> Floats:
    """A box with rounded edges and half axes `size` (left, front, up)."""
    width, depth, height = np.asarray(size, float)
    level = np.array([-1, -0.995, -0.96, -0.85, 0.0, 0.85, 0.96, 0.995, 1.0])
    girth = np.array([0.0, 0.7, 0.9, 1.0, 1.0, 1.0, 0.9, 0.7, 0.0])
    centres = centre + (level * height)[:, None] * up
    return loft(centres, left, front, width * girth, depth * girth, power, sectors=24)


def normals(points: Floats) -> Floats:
    """Unit normals (R, S + 1, 3) pointing outwards."""
    down = np.gradient(points, axis=0)
    around = np.empty_like(points)
    around[:, 1:-1] = points[:, 2:] - points[:, :-2]
    around[:, 0] = around[:, -1] = points[:, 1] - points[:, -2]
    normal = np.cross(around, down)
    length = np.linalg.norm(normal, axis=2, keepdims=True)
    outward = points - points[:, :-1].mean(axis=1, keepdims=True)
    sign = np.sign(np.sum(normal * outward)) or 1.0
    normal = sign * normal / np.maximum(length, 1e-12)
    for end, inner in ((0, 1), (-1, -2)):
        if length[end].max() < 1e-5:  # a ring shrunk to a point has no direction of its own
            axis = points[end, :-1].mean(axis=0) - points[inner, :-1].mean(axis=0)
            normal[end] = axis / max(float(np.linalg.norm(axis)), 1e-12)
    return normal


def _rounded(values: Floats, power: float) -> Floats:
    return np.sign(values) * np.abs(values) ** (2 / power)
