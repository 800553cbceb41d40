"""OpenCV's lens model on normalised coordinates (x/z, y/z): radial, tangential, thin prism, tilt."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Radii (tangents of the angle off the optical axis) searched for the place where a lens folds back.
SEARCHED_RADII = np.arange(1, 10_001) * 0.001
NEWTON_STEPS = 50
TOLERANCE = 1e-12  # normalised units; about 1e-9 pixels


def padded(distortion: Floats) -> Floats:
    """All 14 coefficients k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y."""
    full = np.zeros(14)
    full[: distortion.size] = distortion
    return full


def tilt_matrix(distortion: Floats) -> Floats | None:
    """Homography of a tilted sensor, (3, 3); None for an upright one."""
    tau_x, tau_y = padded(distortion)[12:]
    if tau_x == 0 and tau_y == 0:
        return None
    (sin_x, sin_y), (cos_x, cos_y) = np.sin((tau_x, tau_y)), np.cos((tau_x, tau_y))
    about_x = np.array([[1, 0, 0], [0, cos_x, sin_x], [0, -sin_x, cos_x]])
    about_y = np.array([[cos_y, 0, -sin_y], [0, 1, 0], [sin_y, 0, cos_y]])
    tilted = about_y @ about_x
    onto_sensor = np.array(
        [[tilted[2, 2], 0, -tilted[0, 2]], [0, tilted[2, 2], -tilted[1, 2]], [0, 0, 1]],
    )
    return onto_sensor @ tilted


def distort(x: Floats, y: Floats, distortion: Floats, tilt: Floats | None = None) -> tuple[Floats, Floats]:
    """Where the lens moves normalised points to; x and y of any one shape.

    The order of operations is repeated in static/geometry/camera.js: results agree to the last bit.
    """
    k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4 = padded(distortion)[:12].tolist()
    r2 = x * x + y * y
    r4 = r2 * r2
    r6 = r4 * r2
    radial = (1 + k1 * r2 + k2 * r4 + k3 * r6) * (1 / (1 + k4 * r2 + k5 * r4 + k6 * r6))
    cross = 2 * x * y
    out_x = x * radial + p1 * cross + p2 * (r2 + 2 * x * x) + s1 * r2 + s2 * r4
    out_y = y * radial + p1 * (r2 + 2 * y * y) + p2 * cross + s3 * r2 + s4 * r4
    return (out_x, out_y) if tilt is None else _homography(tilt, out_x, out_y)


def undistort(x: Floats, y: Floats, distortion: Floats, tilt: Floats | None = None) -> tuple[Floats, Floats]:
    """Inverse of `distort`; NaN where no point inside the lens's limit lands there."""
    flat = distortion[:12]
    goal_x, goal_y = (x, y) if tilt is None else _homography(np.linalg.inv(tilt).astype(np.float64), x, y)
    out_x, out_y = goal_x.copy(), goal_y.copy()
    with np.errstate(all="ignore"):
        for _ in range(NEWTON_STEPS):
            step_x, step_y = _newton_step(out_x, out_y, goal_x, goal_y, flat)
            out_x -= step_x
            out_y -= step_y
            if not np.any(np.abs(step_x) + np.abs(step_y) > TOLERANCE):
                break
        landed_x, landed_y = distort(out_x, out_y, flat)
        error = np.hypot(landed_x - goal_x, landed_y - goal_y)
        valid = (error < 1e-9) & (np.hypot(out_x, out_y) < limit(distortion))
    return np.where(valid, out_x, np.nan), np.where(valid, out_y, np.nan)


def limit(distortion: Floats) -> float:
    """Radius in normalised units beyond which the radial model folds back; infinite for a sane lens."""
    return _limit(tuple(distortion.tolist()))


@lru_cache(maxsize=1024)  # a solver asks for many lenses
def _limit(coefficients: tuple[float, ...]) -> float:
    k1, k2, _, _, k3, k4, k5, k6 = padded(np.array(coefficients))[:8].tolist()
    r2 = SEARCHED_RADII**2
    with np.errstate(all="ignore"):
        radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    landed = SEARCHED_RADII * radial
    folds = ~(np.diff(landed, prepend=0.0) > 0)
    return float(SEARCHED_RADII[np.argmax(folds)]) if folds.any() else np.inf


def _homography(matrix: Floats, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = matrix.tolist()
    scale = 1 / (m20 * x + m21 * y + m22)
    return (m00 * x + m01 * y + m02) * scale, (m10 * x + m11 * y + m12) * scale


def _newton_step(
    x: Floats, y: Floats, goal_x: Floats, goal_y: Floats, distortion: Floats
) -> tuple[Floats, Floats]:
    small = 1e-6
    here_x, here_y = distort(x, y, distortion)
    right_x, right_y = distort(x + small, y, distortion)
    left_x, left_y = distort(x - small, y, distortion)
    down_x, down_y = distort(x, y + small, distortion)
    up_x, up_y = distort(x, y - small, distortion)
    xx, yx = (right_x - left_x) / (2 * small), (right_y - left_y) / (2 * small)
    xy, yy = (down_x - up_x) / (2 * small), (down_y - up_y) / (2 * small)
    determinant = xx * yy - xy * yx
    miss_x, miss_y = here_x - goal_x, here_y - goal_y
    return (yy * miss_x - xy * miss_y) / determinant, (xx * miss_y - yx * miss_x) / determinant
