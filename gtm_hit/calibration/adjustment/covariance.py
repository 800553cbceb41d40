"""How far each number of a result may be off, as far as the clicks themselves tell."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.normal import reduced
from gtm_hit.calibration.adjustment.residuals import derivatives, huber
from gtm_hit.calibration.adjustment.system import System

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """One standard deviation each; 0 for numbers that were held."""

    numbers: Floats  # (C, K) radians, metres, pixels or none
    centres: Floats  # (C, 3) metres
    covariance: Floats  # (C, K, K) of each camera's numbers


def uncertainty(system: System, rows: Floats, points: Floats) -> Uncertainty:
    """S⁻¹ · G · S⁻¹, S being the system left for the cameras when all points have been eliminated.

    Were every click as good as its weight says, G would be S. Weights are chosen, though, and some clicks are
    far worse than others; so G is made of what each point really pulls at the cameras, misses and all.
    """
    left = reduced(system.normal(rows, points, curved=True), 0.0).matrix
    free = np.flatnonzero(system.free.ravel())
    scale = 1 / np.sqrt(np.diag(left))
    try:
        inverse = np.linalg.inv(left * scale * scale[:, None]) * scale * scale[:, None]
    except np.linalg.LinAlgError as error:
        raise AdjustmentError(
            "The clicks do not determine all that may move: hold more of it, or click more."
        ) from error
    views, width = rows.shape
    covariance = np.zeros((views * width, views * width))
    covariance[np.ix_(free, free)] = inverse @ _pulls(system, rows, points)[np.ix_(free, free)] @ inverse
    blocks = np.array([covariance[k : k + width, k : k + width] for k in range(0, views * width, width)])
    numbers = np.sqrt(np.maximum(np.diagonal(blocks, axis1=1, axis2=2), 0.0))
    return Uncertainty(numbers, _centre_sigmas(rows, blocks), blocks)


def _pulls(system: System, rows: Floats, points: Floats) -> Floats:
    """(C · K, C · K) sum over the points of the squares of what they pull at the cameras."""
    seen = system.seen
    missed, by_camera, _ = derivatives(rows, points, seen)
    pulls = missed * (seen.weights * huber(missed, system.turn)[1])[:, None]
    by_point = np.zeros((len(points), *rows.shape))
    # A camera sees a point once: nothing is overwritten.
    by_point[seen.points, seen.cameras] = (by_camera * pulls[..., None]).sum(axis=1)
    flat = by_point.reshape(len(points), -1)
    told = 2 * len(seen.pixels) - 3 * int(system.movable.sum())
    spare = max(told - int(system.free.sum()), 1)
    return flat.T @ flat * max(told, 1) / spare + np.diag(system.cameras_known.information.ravel())


def _centre_sigmas(rows: Floats, blocks: Floats) -> Floats:
    sigmas = np.empty((len(rows), 3))
    for place, (row, block) in enumerate(zip(rows, blocks, strict=True)):
        rotation, by_turn = cv2.Rodrigues(row[:3])
        turned = -np.einsum("kji,j->ik", by_turn.reshape(3, 3, 3), row[3:6])  # of -Rᵀt, by each of rvec
        change = np.hstack((turned, -rotation.T))
        sigmas[place] = np.sqrt(np.maximum(np.diag(change @ block[:6, :6] @ change.T), 0.0))
    return sigmas
