"""How much of a picture is kept when its lens is taken out.

OpenCV's getOptimalNewCameraMatrix asks cv2.undistortPoints, which by default gives up after five steps: with
strong lenses its answer is off by tens of pixels. Here the lens is inverted until nothing changes.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import CalibrationError, Camera, Floats, fold, normalise, undistorted

SAMPLES = 101  # along each side of the picture
WIDEST = 4.0  # tangent of the angle off the axis; a fisheye sees farther than any plane picture shows
SHRINK = 0.995


def kept_matrix(camera: Camera, alpha: float) -> Floats:
    """The camera matrix (3, 3) for undistorted pictures of the same size.

    `alpha` 0: no pixel is without picture; 1: all that was seen is kept, the rest stays black; in between in
    proportion. Pixels stay as square as they were. Raises CalibrationError for another alpha.
    """
    if not 0 <= alpha <= 1:
        raise CalibrationError(f"alpha must be from 0 to 1, not {alpha}")
    seen = _seen(camera)
    whole = (seen.min(axis=0), seen.max(axis=0))
    full = _inner(camera, whole)
    tight, loose = _matrix(camera, full, max), _matrix(camera, whole, min)
    mixed: Floats = (1 - alpha) * tight + alpha * loose
    return mixed


def without_picture(camera: Camera, target_matrix: Floats) -> NDArray[np.bool_]:
    """(H, W): pixels of the undistorted picture that show nothing, the lens's fold being one reason."""
    ideal = undistorted(camera, target_matrix)
    rows, columns = np.mgrid[0 : camera.height, 0 : camera.width]
    directions = normalise(ideal, np.column_stack((columns.ravel(), rows.ravel())))
    return ~_shown(camera, directions).reshape(camera.height, camera.width)


def _seen(camera: Camera) -> Floats:
    """(N, 2) directions of all over the picture, but for where the lens has no answer."""
    columns, rows = (np.linspace(-0.5, size - 0.5, SAMPLES) for size in (camera.width, camera.height))
    grid = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    found = normalise(camera, grid)
    found = found[np.isfinite(found).all(axis=1) & (np.abs(found) < WIDEST).all(axis=1)]
    if len(found) < 4:
        raise CalibrationError(f"{camera.name}: the lens has no answer anywhere in the picture")
    return found


def _inner(camera: Camera, whole: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    """The largest rectangle of directions about the optical axis, shaped as the whole, all of it seen."""
    low, high = whole
    share = 1.0
    while share > 0.01:
        corner, opposite = share * low, share * high
        if _shown(camera, _rim(corner, opposite)).all():
            return corner, opposite
        share *= SHRINK
    raise CalibrationError(f"{camera.name}: no part of the picture can be shown without its lens")


def _rim(low: Floats, high: Floats) -> Floats:
    """(4 · SAMPLES, 2) directions along the sides of a rectangle."""
    along = np.linspace(low, high, SAMPLES)
    x, y = along.T
    sides = [(x, np.full_like(x, end)) for end in (low[1], high[1])]
    sides += [(np.full_like(y, end), y) for end in (low[0], high[0])]
    return np.concatenate([np.column_stack(side) for side in sides])


def _shown(camera: Camera, directions: Floats) -> NDArray[np.bool_]:
    """Which directions the picture shows: within the lens's fold, and landing in the picture."""
    x, y = camera.distort(*directions.T)
    (fx, _, cx), (_, fy, cy), _ = camera.matrix.tolist()
    u, v = x * fx + cx, y * fy + cy
    with np.errstate(invalid="ignore"):
        inside = (u >= -0.5) & (u <= camera.width - 0.5) & (v >= -0.5) & (v <= camera.height - 0.5)
    return inside & (np.hypot(*directions.T) < fold(camera))


def _matrix(camera: Camera, shown: tuple[Floats, Floats], pick: Callable[[list[float]], float]) -> Floats:
    """It puts the rectangle's middle into the middle of the picture, and its sides on the rim or outside."""
    low, high = shown
    fx, fy = camera.matrix[0, 0], camera.matrix[1, 1]
    size = np.array([camera.width, camera.height], dtype=np.float64)
    zoom = pick((size / ((high - low) * (fx, fy))).tolist())
    focal = zoom * np.array([fx, fy])
    centre = (size - 1) / 2 - focal * (low + high) / 2
    return np.array([[focal[0], 0.0, centre[0]], [0.0, focal[1], centre[1]], [0.0, 0.0, 1.0]])
