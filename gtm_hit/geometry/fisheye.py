"""OpenCV's fisheye model (cv2.fisheye) on normalised coordinates x/z, y/z: what `lens` is for the usual one.

A ray at the angle θ off the optical axis lands θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸) focal lengths from it.
The radius must grow with the angle for a pixel to mean one ray only, so the model holds up to the first angle
where it stops growing, and nowhere beyond a right angle: coordinates x/z, y/z know only what lies before the
camera plane, as OpenCV's do.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

COEFFICIENTS = 4
STEPS = 20_000  # of the right angle, in which the end of the range is looked for
NEWTON_STEPS = 20
TOLERANCE = 1e-14  # radians


def radius(angle: Floats, distortion: Floats) -> Floats:
    """Where a ray lands, in focal lengths from the optical axis."""
    k1, k2, k3, k4 = distortion.tolist()
    t2 = angle * angle
    return angle * (1 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4))))


def limit(distortion: Floats) -> float:
    """The angle, radians, where the model ends: where the radius stops growing, or a right angle."""
    return _limit(tuple(distortion.tolist()))


@lru_cache(maxsize=64)  # asked for again for every block of ground
def _limit(coefficients: tuple[float, ...]) -> float:
    distortion = np.array(coefficients)
    angles = np.linspace(0, np.pi / 2, STEPS + 1)[1:]
    falls = ~(_growth(angles, distortion) > 0)
    return float(angles[np.argmax(falls)]) if falls.any() else np.pi / 2


def distort(x: Floats, y: Floats, distortion: Floats) -> tuple[Floats, Floats]:
    """Where the lens moves normalised points to, as cv2.fisheye.projectPoints; NaN beyond the limit."""
    off_axis = np.hypot(x, y)
    angle = np.arctan(off_axis)
    with np.errstate(all="ignore"):
        scale = np.where(off_axis > 0, radius(angle, distortion) / off_axis, 1.0)
    scale = np.where(angle < limit(distortion), scale, np.nan)
    return x * scale, y * scale


def undistort(x: Floats, y: Floats, distortion: Floats) -> tuple[Floats, Floats]:
    """Inverse of `distort`; NaN where no ray within the limit lands."""
    landed = np.hypot(x, y)
    angle = _angle(landed, distortion)
    with np.errstate(all="ignore"):
        scale = np.where(landed > 0, np.tan(angle) / landed, 1.0)
    return x * scale, y * scale


def _angle(landed: Floats, distortion: Floats) -> Floats:
    """Inverse of `radius`: read off a table, then Newton's method, for which the radius grows."""
    end = limit(distortion)
    angles = np.linspace(0, end, STEPS + 1)
    radii = radius(angles, distortion)
    inside = landed < radii[-1]
    goal = np.where(inside, landed, 0.0)
    angle = np.interp(goal, radii, angles)
    with np.errstate(all="ignore"):
        for _ in range(NEWTON_STEPS):
            step = (radius(angle, distortion) - goal) / _growth(angle, distortion)
            angle = np.clip(angle - np.nan_to_num(step), 0.0, end)
            if not np.any(np.abs(step) > TOLERANCE):
                break
    return np.where(inside, angle, np.nan)


def _growth(angle: Floats, distortion: Floats) -> Floats:
    """Derivative of `radius`."""
    k1, k2, k3, k4 = distortion.tolist()
    t2 = angle * angle
    return 1 + t2 * (3 * k1 + t2 * (5 * k2 + t2 * (7 * k3 + t2 * 9 * k4)))
