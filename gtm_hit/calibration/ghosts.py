"""Where points that were not clicked yet are to be expected, for a person to confirm."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from gtm_hit.calibration.ground_points import GroundPoint
from gtm_hit.calibration.pose_fit import projection
from gtm_hit.calibration.pose_values import PoseSolution
from gtm_hit.geometry.camera import normalise

FOLLOWED = 1e-6  # normalised units by which a point must come back through the lens


@dataclass(frozen=True)
class Ghost:
    """A measured point as the pose expects it in the picture."""

    name: str
    x: float  # pixels of the picture as taken
    y: float
    sigma: float  # pixels, one standard deviation, by what is not known about the pose
    visible: bool  # before the camera, in the picture and within the lens's fold


def expected_pixels(solution: PoseSolution, points: Iterable[GroundPoint]) -> list[Ghost]:
    """A ghost for each point, in their order; x, y and sigma mean nothing where it is not visible."""
    points = list(points)
    if not points:
        return []
    places = np.array([point.place for point in points], dtype=np.float64)
    pixels, by_pose = projection(solution.lens, solution.rvec, solution.tvec, places)
    spread = by_pose @ solution.covariance @ by_pose.transpose(0, 2, 1)
    sigma = np.sqrt(np.clip(np.trace(spread, axis1=1, axis2=2) / 2, 0.0, None))
    seen = _visible(solution, places, pixels)
    rows = zip(points, np.nan_to_num(pixels).tolist(), np.nan_to_num(sigma).tolist(), seen, strict=True)
    return [Ghost(point.name, x, y, off, bool(see)) for point, (x, y), off, see in rows]


def _visible(solution: PoseSolution, places: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    camera, lens = solution.camera, solution.lens
    placed = places @ camera.rotation.T + camera.tvec
    with np.errstate(all="ignore"):
        # Beyond its fold a lens throws points back into the picture: they do not come back the way they went.
        back = normalise(camera, pixels) - placed[:, :2] / placed[:, 2:]
        inside = (pixels > -0.5).all(axis=1) & (pixels < [lens.width - 0.5, lens.height - 0.5]).all(axis=1)
        return (placed[:, 2] > 0) & inside & (np.abs(back).max(axis=1) < FOLLOWED)
