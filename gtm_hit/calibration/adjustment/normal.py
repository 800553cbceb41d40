"""Normal equations of a bundle adjustment, with the points eliminated (Schur's complement).

A point depends on few numbers, its own three and those of the cameras that see it; so all points are
eliminated first, and what remains is one small dense system in the numbers of the cameras.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.residuals import Seen

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

BLOCK_BYTES = 16_000_000  # of points eliminated together
TINY = 1e-12  # of a point's information: what no ray tells at all stays where it is


@dataclass(frozen=True, eq=False)
class Normal:
    """Second derivatives of the cost, in blocks, and its slopes."""

    cameras: Floats  # (C, K, K)
    camera_slopes: Floats  # (C, K)
    points: Floats  # (P, 3, 3)
    point_slopes: Floats  # (P, 3)
    mixed: Floats  # (N, K, 3) of each observation's camera and point
    seen: Seen
    free: Flags  # (C, K) the numbers that may move
    movable: Flags  # (P,) which points may move


@dataclass(frozen=True, eq=False)
class Reduced:
    """The system that is left for the cameras' free numbers, and what leads back to the points."""

    matrix: Floats  # (F, F)
    slopes: Floats  # (F,)
    inverse_points: Floats  # (P, 3, 3); 0 for points that stay


def normal_equations(
    seen: Seen, moved: tuple[Floats, Floats, Floats], counted: Floats, free: Flags, movable: Flags
) -> Normal:
    """Of misses with their derivatives, as `derivatives` returns them, each counting `counted` (N,)."""
    missed, by_camera, by_point = moved
    views, width = free.shape
    weighted = by_camera * counted[:, None, None]
    cameras, slopes = np.zeros((views, width, width)), np.zeros((views, width))
    for view in range(views):
        part = seen.of(view)
        flat = weighted[part].reshape(-1, width)
        cameras[view] = flat.T @ by_camera[part].reshape(-1, width)
        slopes[view] = flat.T @ missed[part].ravel()
    points, point_slopes = point_equations(seen, missed, by_point, counted, len(movable))
    mixed = np.swapaxes(weighted, 1, 2) @ by_point
    return Normal(cameras, slopes, points, point_slopes, mixed, seen, free, movable)


def point_equations(
    seen: Seen, missed: Floats, by_point: Floats, counted: Floats, count: int
) -> tuple[Floats, Floats]:
    """The points' own blocks (P, 3, 3) and slopes (P, 3)."""
    weighted = by_point * counted[:, None, None]
    points, slopes = np.zeros((count, 3, 3)), np.zeros((count, 3))
    np.add.at(points, seen.points, np.swapaxes(weighted, 1, 2) @ by_point)
    np.add.at(slopes, seen.points, (weighted * missed[..., None]).sum(axis=1))
    return points, slopes


def reduced(normal: Normal, damping: float) -> Reduced:
    """The cameras' system with each diagonal raised by `damping` times itself, as Marquardt does.

    numpy.linalg.LinAlgError where numbers have left all bounds.
    """
    views, width = normal.camera_slopes.shape
    matrix = np.zeros((views * width, views * width))
    for view, block in enumerate(normal.cameras):
        part = slice(view * width, (view + 1) * width)
        matrix[part, part] = block
    places = np.flatnonzero(normal.free.ravel())
    matrix = matrix[np.ix_(places, places)]
    matrix[np.diag_indices_from(matrix)] *= 1 + damping
    slopes = normal.camera_slopes.ravel()[places].copy()
    inverse = _inverse_points(normal, damping)
    for across, onto in _eliminated(normal, inverse):
        matrix -= across @ across.T
        slopes -= across @ onto
    return Reduced(matrix, slopes, inverse)


def camera_steps(normal: Normal, system: Reduced) -> Floats:
    """(C, K) how the cameras' numbers should move."""
    # Radians, metres, pixels and coefficients together: equal diagonals keep the digits.
    scale = 1 / np.sqrt(np.diag(system.matrix))
    scaled = system.matrix * scale * scale[:, None]
    steps = np.zeros_like(normal.camera_slopes)
    steps[normal.free] = -np.linalg.solve(scaled, system.slopes * scale) * scale
    return steps


def point_steps(normal: Normal, system: Reduced, steps: Floats) -> Floats:
    """(P, 3) how the points follow when the cameras' numbers (C, K) move by `steps`."""
    pulled = normal.point_slopes.copy()
    moved = (normal.mixed * steps[normal.seen.cameras][..., None]).sum(axis=1)
    np.add.at(pulled, normal.seen.points, moved)
    return -(system.inverse_points @ pulled[..., None])[..., 0]


def _inverse_points(normal: Normal, damping: float) -> Floats:
    inverse = np.zeros_like(normal.points)
    inverse[normal.movable] = np.linalg.inv(raised(normal.points[normal.movable], damping))
    return inverse


def raised(points: Floats, damping: float | Floats) -> Floats:
    """Blocks (P, 3, 3) that can be inverted, their diagonals raised by `damping` (or (P, 1) of them)."""
    blocks, diagonal = points.copy(), np.arange(3)
    total = np.trace(blocks, axis1=1, axis2=2)[:, None]
    blocks[:, diagonal, diagonal] += damping * blocks[:, diagonal, diagonal] + TINY * total
    return blocks


def _eliminated(normal: Normal, inverse: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Some points at a time, with V⁻¹ = H · Hᵀ: W · H as (F, 3 B), and Hᵀ times their slopes, (3 B,)."""
    seen, movable = normal.seen, np.flatnonzero(normal.movable)
    columns = np.flatnonzero(normal.free.any(axis=0))
    free = np.flatnonzero(normal.free[:, columns].ravel())
    halves = np.zeros_like(inverse)
    halves[movable] = np.linalg.cholesky(inverse[movable])
    mixed = normal.mixed[:, columns] @ halves[seen.points]
    towards = (np.swapaxes(halves, 1, 2) @ normal.point_slopes[..., None])[..., 0]
    views, width = len(normal.free), len(columns)
    together = max(1, BLOCK_BYTES // max(1, views * width * 3 * 8))
    place = np.cumsum(normal.movable) - 1
    moves = normal.movable[seen.points]
    for start in range(0, movable.size, together):
        block = movable[start : start + together]
        rows = np.flatnonzero(moves & (place[seen.points] >= start) & (place[seen.points] < start + together))
        across = np.zeros((views, width, block.size, 3))
        # Advanced places around a slice: numpy puts them first, as `mixed` has them.
        across[seen.cameras[rows], :, place[seen.points[rows]] - start] = mixed[rows]
        yield across.reshape(views * width, 3 * block.size)[free], towards[block].ravel()
