"""The last steps to the best lens: Levenberg-Marquardt over the lens and all poses, poses eliminated.

OpenCV's calibration stops short of the optimum, rounds points to 32 bits and, with several threads, adds up
in another order each time. From its result these steps lead to the same numbers always.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from gtm_hit.calibration.lens_models import NAMES, LensModel
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.views import BoardView, Floats

STEPS = 100
ENOUGH = 1e-10  # relative drop of the cost
STIFFEST = 1e10
COLUMNS = len(NAMES)


@dataclass(frozen=True, eq=False)
class Refined:
    lens: Lens
    poses: Floats  # (views, 6): rvec, tvec
    cost: float  # sum of squares, pixels²
    sigma: dict[str, float]


@dataclass(frozen=True, eq=False)
class _System:
    """Normal equations: of the lens, of each view's pose, and between them."""

    shared: Floats  # (p, p)
    own: Floats  # (views, 6, 6)
    between: Floats  # (views, p, 6)
    shared_right: Floats  # (p,)
    own_right: Floats  # (views, 6)
    cost: float


def refine(views: Sequence[BoardView], lens: Lens, poses: Floats, model: LensModel) -> Refined:
    """The optimum next to a start, and how sure its numbers are."""
    chooser = _chooser(model)
    system = _system(views, lens, poses, chooser)
    damping = 1e-4
    for _ in range(STEPS):
        step = _step(system, damping)
        moved = _moved(lens, poses, step, chooser) if step else None
        cost = _cost(views, *moved) if moved else np.inf
        if moved and cost < system.cost:
            drop = 1 - cost / system.cost
            lens, poses = moved
            system = _system(views, lens, poses, chooser)
            damping = max(damping / 8, 1e-12)
            if drop < ENOUGH:
                break
        else:
            damping *= 5
            if damping > STIFFEST:
                break
    return Refined(lens, poses, system.cost, _sigma(views, system, model))


def _chooser(model: LensModel) -> Floats:
    """(COLUMNS, p): how the parameters that are solved move the twelve of OpenCV."""
    names = [name for name in model.solved if not (model.fixed_aspect and name == "fy")]
    chooser = np.zeros((COLUMNS, len(names)))
    for column, name in enumerate(names):
        chooser[NAMES.index(name), column] = 1
    if model.fixed_aspect:
        chooser[NAMES.index("fy"), names.index("fx")] = 1
    return chooser


def _numbers(lens: Lens) -> Floats:
    numbers = np.zeros(COLUMNS)
    numbers[:4] = lens.matrix[[0, 1, 0, 1], [0, 1, 2, 2]]
    numbers[4 : 4 + lens.distortion.size] = lens.distortion
    return numbers


def _with(lens: Lens, numbers: Floats) -> Lens:
    fx, fy, cx, cy = numbers[:4]
    matrix = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])
    return Lens(lens.width, lens.height, matrix, numbers[4 : 4 + lens.distortion.size].copy())


def _system(views: Sequence[BoardView], lens: Lens, poses: Floats, chooser: Floats) -> _System:
    count = chooser.shape[1]
    shared, shared_right, cost = np.zeros((count, count)), np.zeros(count), 0.0
    own, own_right = np.zeros((len(views), 6, 6)), np.zeros((len(views), 6))
    between = np.zeros((len(views), count, 6))
    for index, (view, pose) in enumerate(zip(views, poses, strict=True)):
        computed, slopes = cv2.projectPoints(view.points, pose[:3], pose[3:], lens.matrix, lens.distortion)
        residuals = (view.pixels - computed.reshape(-1, 2)).ravel()
        of_pose, of_lens = slopes[:, :6], slopes[:, 6:] @ chooser[: slopes.shape[1] - 6]
        shared += of_lens.T @ of_lens
        shared_right += of_lens.T @ residuals
        own[index], own_right[index] = of_pose.T @ of_pose, of_pose.T @ residuals
        between[index] = of_lens.T @ of_pose
        cost += float(residuals @ residuals)
    return _System(shared, own, between, shared_right, own_right, cost)


def _reduced(system: _System, damping: float) -> tuple[Floats, Floats, Floats]:
    """The lens's equations with the poses eliminated, its right side, and the poses' inverses."""
    own = system.own + damping * np.einsum("vii->vi", system.own)[:, :, None] * np.eye(6)
    inverse = np.linalg.inv(own)
    shared = system.shared + damping * np.diag(np.diag(system.shared))
    carried = system.between @ inverse
    matrix = shared - np.einsum("vpi,vqi->pq", carried, system.between)
    right = system.shared_right - np.einsum("vpi,vi->p", carried, system.own_right)
    return matrix, right, inverse


def _step(system: _System, damping: float) -> tuple[Floats, Floats] | None:
    try:
        matrix, right, inverse = _reduced(system, damping)
        scale = 1 / np.sqrt(np.diag(matrix))
        lens_step = scale * np.linalg.solve(matrix * np.outer(scale, scale), scale * right)
    except (np.linalg.LinAlgError, FloatingPointError):
        return None
    rest = system.own_right - np.einsum("vpi,p->vi", system.between, lens_step)
    pose_steps = np.einsum("vij,vj->vi", inverse, rest)
    sound = np.isfinite(lens_step).all() and np.isfinite(pose_steps).all()
    return (lens_step, pose_steps) if sound else None


def _moved(
    lens: Lens, poses: Floats, step: tuple[Floats, Floats], chooser: Floats
) -> tuple[Lens, Floats] | None:
    numbers, moved = _numbers(lens) + chooser @ step[0], poses + step[1]
    sound = numbers[0] > 0 and numbers[1] > 0 and (moved[:, 5] > 0).all()
    return (_with(lens, numbers), moved) if sound else None


def _cost(views: Sequence[BoardView], lens: Lens, poses: Floats) -> float:
    total = 0.0
    for view, pose in zip(views, poses, strict=True):
        computed, _ = cv2.projectPoints(view.points, pose[:3], pose[3:], lens.matrix, lens.distortion)
        total += float(((view.pixels - computed.reshape(-1, 2)) ** 2).sum())
    return total if np.isfinite(total) else float(np.inf)


def _sigma(views: Sequence[BoardView], system: _System, model: LensModel) -> dict[str, float]:
    """Standard deviations, by the spread that the residuals have."""
    count = 2 * sum(len(view.pixels) for view in views)
    free = max(1, count - system.shared.shape[0] - 6 * len(views))
    matrix, _, _ = _reduced(system, 0.0)
    scale = 1 / np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    covariance = np.linalg.pinv(matrix * np.outer(scale, scale)) * np.outer(scale, scale)
    moved = _chooser(model) @ covariance @ _chooser(model).T
    spread = np.sqrt(np.maximum(np.diag(moved), 0) * system.cost / free)
    return {name: float(spread[NAMES.index(name)]) for name in model.solved}
