"""Steps of Levenberg and Marquardt, one at a time, so that anybody may stop between two and go on later."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.normal import Normal, camera_steps, point_steps, reduced
from gtm_hit.calibration.adjustment.system import System

Floats = NDArray[np.float64]

FIRST_DAMPING = 1e-3
LEAST_DAMPING = 1e-9
MOST_DAMPING = 1e10  # steps this short change nothing: the cost has no way down from here


@dataclass(frozen=True, eq=False)
class Place:
    rows: Floats  # (C, K) the cameras' numbers
    points: Floats  # (P, 3)
    cost: float
    damping: float  # of the next step


def step_down(system: System, here: Place) -> Place:
    """One step; the same place where there is no way down."""
    normal, damping = system.normal(here.rows, here.points), here.damping
    while damping < MOST_DAMPING:
        found = _tried(system, normal, here, damping)
        if found is not None:
            return found
        damping *= 4
    return here


def _tried(system: System, normal: Normal, here: Place, damping: float) -> Place | None:
    """Where a step with this damping leads; None if that is no way down."""
    with np.errstate(all="ignore"):
        try:
            left = reduced(normal, damping)
            by_cameras = camera_steps(normal, left)
        except np.linalg.LinAlgError:
            return None
        rows = here.rows + by_cameras
        points = here.points + point_steps(normal, left, by_cameras)
        if not (np.isfinite(rows).all() and np.isfinite(points).all()) or (rows[:, 6:8] <= 0).any():
            return None
        cost = system.cost(rows, points).total
    return Place(rows, points, cost, max(damping / 5, LEAST_DAMPING)) if cost < here.cost else None
