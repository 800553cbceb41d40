"""What a bundle adjustment starts from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.formats.calibration.ba_problem import BaProblem
from gtm_hit.formats.calibration.ba_problem import Sightings as Sightings
from gtm_hit.geometry.camera import Camera

Floats = NDArray[np.float64]

POSE = ("rx", "ry", "rz", "tx", "ty", "tz")
LENS = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
PARAMETERS = (*POSE, *LENS)

NOBODY = Sightings(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros((0, 2)))
FEET_APART = 0.5  # metres on the ground between the feet and the head of one person
PEOPLE_HEIGHTS = (0.8, 2.3)  # metres between the two


@dataclass(frozen=True, eq=False)
class View:
    """One camera as it starts out.

    stays : names of `PARAMETERS` that must not move; `pose` and `lens` are all of theirs
    sigmas : how well the lens step knew a parameter, by name, pixels or none; what is missing is taken from
        the settings
    """

    name: str
    lens: Lens
    rvec: Floats  # (3,) radians, world to camera
    tvec: Floats  # (3,) metres, world to camera
    stays: frozenset[str] = frozenset()
    sigmas: Mapping[str, float] = field(default_factory=dict)

    def camera(self, index: int = 0) -> Camera:
        return self.lens.camera(self.name, self.rvec, self.tvec, index)


@dataclass(frozen=True, eq=False)
class Problem:
    """Views, what they saw, and what is known of it. Lengths are metres.

    points : (P, 3) where the free points start; NaN where that is to be found from the views
    point_sigmas : (P, 3) how well each coordinate is known beforehand; infinite where not; None: none is
    measured : (M, 3) measured points
    measured_sigma : how far they may be off; 0 keeps them exactly where they are
    weights : (N,) how much each observation of a free point counts; 0 leaves it out. None: all count 1
    feet : (P,) which free points are feet on the ground, for the report only; None: to be guessed
    labels : (P + M) what points are called, free ones first; empty: they go by their numbers
    """

    views: tuple[View, ...]
    points: Floats
    seen: Sightings
    measured: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    measured_seen: Sightings = NOBODY
    measured_sigma: float = 0.0
    point_sigmas: Floats | None = None
    weights: Floats | None = None
    feet: NDArray[np.bool_] | None = None
    labels: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(view.name for view in self.views)


def problem_of(file: BaProblem, size: tuple[int, int], names: tuple[str, ...] | None = None) -> Problem:
    """The problem in a `ba_problem.txt`, whose pictures have `size` (width, height), which no file tells."""
    names = names or tuple(f"C{number}" for number in range(1, len(file.cameras) + 1))
    views = tuple(_view(name, row, size) for name, row in zip(names, file.cameras, strict=True))
    return Problem(
        views,
        file.points,
        file.seen,
        file.fixed_points,
        file.fixed_seen,
    )


def file_of(problem: Problem, views: tuple[View, ...], points: Floats) -> BaProblem:
    """The file of a problem with the views and points that were found; points left out stay as they were.

    ValueError for lenses of more than five numbers.
    """
    rows = []
    for view in views:
        if view.lens.distortion.size != 5:
            raise ValueError(f"{view.name}: ba_problem.txt has room for the lens k1 k2 p1 p2 k3 only")
        matrix = view.lens.matrix
        middle = (matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2])
        rows.append([*view.rvec, *view.tvec, *middle, *view.lens.distortion])
    cameras = np.array(rows, dtype=np.float64)
    kept = np.nan_to_num(np.where(np.isnan(points), problem.points, points))
    return BaProblem(cameras, kept, problem.measured, problem.seen, problem.measured_seen)


def feet_of_pairs(points: Floats) -> NDArray[np.bool_]:
    """Which points are feet, as far as one can tell: a neighbour in the list is one person higher."""
    feet = np.zeros(len(points), dtype=bool)
    away = np.diff(points, axis=0)
    near = np.hypot(away[:, 0], away[:, 1]) < FEET_APART
    least, most = PEOPLE_HEIGHTS
    feet[:-1] |= near & (away[:, 2] > least) & (away[:, 2] < most)
    feet[1:] |= near & (-away[:, 2] > least) & (-away[:, 2] < most)
    return feet


def _view(name: str, row: Floats, size: tuple[int, int]) -> View:
    matrix = np.array([[row[6], 0.0, row[8]], [0.0, row[7], row[9]], [0.0, 0.0, 1.0]])
    return View(name, Lens(*size, matrix, row[10:15].copy()), row[:3].copy(), row[3:6].copy())
