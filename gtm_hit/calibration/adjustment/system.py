"""A problem as the solver sees it: rows of numbers, what may move, and what is known beforehand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.normal import Normal, normal_equations
from gtm_hit.calibration.adjustment.parameters import free_flags, packed
from gtm_hit.calibration.adjustment.problem import PARAMETERS, Problem
from gtm_hit.calibration.adjustment.residuals import Seen, derivatives, huber, misses
from gtm_hit.calibration.adjustment.settings import Settings

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Known:
    """What is known of some numbers beforehand: each near `wanted`, with `information` = 1 / σ²."""

    wanted: Floats
    information: Floats  # 0 where nothing is known

    def cost(self, values: Floats) -> float:
        return 0.5 * float((self.information * (values - self.wanted) ** 2).sum())

    def slopes(self, values: Floats) -> Floats:
        return self.information * (values - self.wanted)


@dataclass(frozen=True)
class Cost:
    clicks: float  # half the robust, weighted sum of squares, pixels²
    known: float  # half the sum of squares of what was known beforehand, in σ

    @property
    def total(self) -> float:
        return self.clicks + self.known


@dataclass(frozen=True, eq=False)
class System:
    seen: Seen
    free: Flags  # (C, K)
    movable: Flags  # (P,)
    turn: float
    cameras_known: Known
    points_known: Known

    def cost(self, rows: Floats, points: Floats) -> Cost:
        halves = huber(misses(rows, points, self.seen), self.turn)[0]
        known = self.cameras_known.cost(rows) + self.points_known.cost(points)
        return Cost(float(self.seen.weights @ halves), known)

    def normal(self, rows: Floats, points: Floats, curved: bool = False) -> Normal:
        """The equations of a step; `curved`: as much as the cost is really curved, which is less.

        The cost of a far click grows evenly along its miss and bends only across it: by half, on average.
        """
        moved = derivatives(rows, points, self.seen)
        counted = huber(moved[0], self.turn)[1]
        counted = self.seen.weights * (np.where(counted < 1, counted / 2, 1.0) if curved else counted)
        normal = normal_equations(self.seen, moved, counted, self.free, self.movable)
        width = np.arange(rows.shape[1])
        normal.cameras[:, width, width] += self.cameras_known.information
        normal.camera_slopes[:] += self.cameras_known.slopes(rows)
        axes = np.arange(3)
        normal.points[:, axes, axes] += self.points_known.information
        normal.point_slopes[:] += self.points_known.slopes(points)
        return normal


def observations(problem: Problem, settings: Settings) -> Seen:
    """All observations with their weights, sorted by camera and point; those that count nothing left out."""
    free, measured = problem.seen, problem.measured_seen
    weights = np.ones(len(free.pixels)) if problem.weights is None else problem.weights
    ground = settings.ground_weight
    if ground is None:
        ground = float((weights > 0).sum()) / max(len(measured.pixels), 1) or 1.0
    cameras = np.concatenate((free.cameras, measured.cameras))
    points = np.concatenate((free.points, measured.points + len(problem.points)))
    order = np.lexsort((points, cameras))
    seen = Seen(
        cameras[order],
        points[order],
        np.concatenate((free.pixels, measured.pixels))[order],
        np.concatenate((weights, np.full(len(measured.pixels), ground)))[order],
    )
    return seen.where(seen.weights > 0)


def system_of(
    problem: Problem, settings: Settings, seen: Seen, held: Flags, lenses: bool, soft: bool
) -> System:
    """The system of one pass: the gauge holds `held` (C, K); `soft` ties lenses to where they start."""
    rows = packed(problem.views)
    free = free_flags(problem.views, lenses, rows.shape[1]) & ~held
    information = lens_information(problem, settings, rows.shape[1]) if soft else np.zeros_like(rows)
    points_known = _points_known(problem)
    movable = np.zeros(len(points_known.wanted), dtype=bool)
    movable[np.unique(seen.points)] = True
    if problem.measured_sigma == 0:
        movable[len(problem.points) :] = False
    return System(seen, free, movable, settings.turn, Known(rows, information), points_known)


def lens_information(problem: Problem, settings: Settings, width: int) -> Floats:
    """(C, K) 1 / σ² of each lens as the lens step knew it; 0 for poses."""
    information = np.zeros((len(problem.views), width))
    for row, view in zip(information, problem.views, strict=True):
        usual = settings.lens_sigmas(view.lens.matrix[0, 0], view.lens.matrix[1, 1])
        for name, sigma in (usual | dict(view.sigmas)).items():
            place = PARAMETERS.index(name)
            if place < 10 + view.lens.distortion.size:
                row[place] = 1 / sigma**2
    return information


def all_points(problem: Problem) -> Floats:
    """(P + M, 3) free points, then measured ones."""
    return np.concatenate((problem.points, problem.measured))


def _points_known(problem: Problem) -> Known:
    wanted = all_points(problem)
    information = np.zeros_like(wanted)
    if problem.point_sigmas is not None:
        information[: len(problem.points)] = 1 / problem.point_sigmas**2
    if problem.measured_sigma > 0:
        information[len(problem.points) :] = 1 / problem.measured_sigma**2
    return Known(np.where(information > 0, wanted, 0.0), information)
