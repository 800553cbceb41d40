"""Where each point lies best while the cameras stand still."""

from __future__ import annotations

from itertools import combinations

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.normal import point_equations, raised
from gtm_hit.calibration.adjustment.residuals import Seen, derivatives, huber, misses
from gtm_hit.geometry import lens

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

STEPS = 10
PARALLEL = 1e-9  # below this determinant of their sum, rays do not meet
NARROW = 1.0  # degrees: rays that differ by less tell hardly how far a point is away
FARTHEST = 1e6  # metres from the origin that rays may meet


def settled(rows: Floats, points: Floats, seen: Seen, movable: Flags, turn: float) -> Floats:
    """The points (P, 3), those that move being where they cost least.

    A bad click may leave a point in a hollow beside the deepest one, from which no small step leads out. So
    each also tries where all its rays meet, and where each two of them do.
    """
    here = np.where(np.isnan(points), 0.0, points)
    best, least = here.copy(), _costs(rows, here, seen, turn)
    least[np.isnan(points).any(axis=1)] = np.inf
    unknown = ~np.isfinite(least)
    directions, centres = rays(rows, seen)
    for chosen in _choices(seen, len(rows)):
        told = seen.where(chosen)
        tried, met = meeting(directions[chosen], centres[told.cameras], told, len(points))
        met &= movable
        part = seen.where(met[seen.points])
        costs = _costs(rows, np.where(met[:, None], tried, best), part, turn)
        cheaper = met & (costs < least)
        best[cheaper], least[cheaper] = tried[cheaper], costs[cheaper]
    moved, costs = _downhill(rows, best, seen, movable, turn)
    stayed, as_before = _downhill(rows, np.where(unknown[:, None], best, here), seen, movable, turn)
    return np.where((costs < as_before).reshape(-1, 1), moved, stayed)


def rays(rows: Floats, seen: Seen) -> tuple[Floats, Floats]:
    """World directions (N, 3), length 1, of all observations, NaN beyond a lens' fold; centres (C, 3)."""
    directions, centres = np.empty((len(seen.pixels), 3)), np.empty((len(rows), 3))
    for number, row in enumerate(rows):
        part = seen.of(number)
        rotation = cv2.Rodrigues(row[:3])[0]
        plane = (seen.pixels[part] - row[8:10]) / row[6:8]
        x, y = lens.undistort(plane[:, 0], plane[:, 1], row[10:])
        away = np.column_stack((x, y, np.ones(len(x)))) @ rotation
        directions[part] = away / np.linalg.norm(away, axis=1, keepdims=True)
        centres[number] = -rotation.T @ row[3:6]
    return directions, centres


def meeting(directions: Floats, centres: Floats, seen: Seen, count: int) -> tuple[Floats, Flags]:
    """Points (P, 3) nearest to the rays (N, 3) from centres (N, 3) that see them, and which there are."""
    across = np.eye(3) - directions[:, :, None] * directions[:, None, :]
    across[~np.isfinite(directions).all(axis=1)] = 0.0
    total, towards = np.zeros((count, 3, 3)), np.zeros((count, 3))
    np.add.at(total, seen.points, across)
    np.add.at(towards, seen.points, (across @ centres[..., None])[..., 0])
    met = np.linalg.det(total) > PARALLEL
    found = np.zeros((count, 3))
    found[met] = np.linalg.solve(total[met], towards[met][..., None])[..., 0]
    met &= (np.abs(found) < FARTHEST).all(axis=1)
    return found, met


def widest_angles(rows: Floats, seen: Seen, count: int) -> Floats:
    """(P,) degrees between the two rays of each point that differ most; 0 where it has fewer than two."""
    directions, _ = rays(rows, seen)
    by_view = np.full((len(rows), count, 3), np.nan)
    by_view[seen.cameras, seen.points] = directions
    least = np.ones(count)
    for number in range(1, len(rows)):
        cosines = (by_view[number] * by_view[:number]).sum(axis=2)
        least = np.fmin(least, np.fmin.reduce(cosines, axis=0))
    return np.degrees(np.arccos(np.clip(least, -1, 1)))


def _choices(seen: Seen, views: int) -> list[Flags]:
    """All observations; then, pair by pair, those of two cameras of the points both saw."""
    chosen = [np.ones(len(seen.pixels), dtype=bool)]
    for pair in combinations(range(views), 2):
        of_pair = np.isin(seen.cameras, pair)
        points, counts = np.unique(seen.points[of_pair], return_counts=True)
        if (counts == 2).any():
            chosen.append(of_pair & np.isin(seen.points, points[counts == 2]))
    return chosen


def _costs(rows: Floats, points: Floats, seen: Seen, turn: float) -> Floats:
    halves = huber(misses(rows, points, seen), turn)[0]
    return np.bincount(seen.points, halves * seen.weights, len(points)).astype(np.float64)


def _downhill(rows: Floats, points: Floats, seen: Seen, movable: Flags, turn: float) -> tuple[Floats, Floats]:
    """Points and their costs after some steps of Levenberg and Marquardt, each point with its own damping."""
    points, costs = points.copy(), _costs(rows, points, seen, turn)
    damping = np.full((len(points), 1), 1e-3)
    for _ in range(STEPS):
        missed, _, by_point = derivatives(rows, points, seen)
        counted = seen.weights * huber(missed, turn)[1]
        blocks, slopes = point_equations(seen, missed, by_point, counted, len(points))
        steps = np.zeros_like(points)
        known = movable & (np.trace(blocks, axis1=1, axis2=2) > 0)
        inner = raised(blocks[known], damping[known])
        steps[known] = -np.linalg.solve(inner, slopes[known][..., None])[..., 0]
        tried = points + steps
        after = _costs(rows, tried, seen, turn)
        better = after < costs
        points[better], costs[better] = tried[better], after[better]
        damping = np.where(better[:, None], damping / 5, damping * 4)
    return points, costs
