"""A pose out of points and pixels: candidates by closed forms, the best of them refined. See `pose` for more.

OpenCV's word that it succeeded is not taken: every pose is projected again here and compared.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.geometry.camera import normalise

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

FLAT = 1e-4  # thickness by extent below which points count as one plane
LM_STEPS = 30
LM_STOP = 1e-9  # relative drop of the cost
NO_LENS = np.zeros(5)
UPRIGHT = np.eye(3)


@dataclass(frozen=True, eq=False)
class Sights:
    """Pairs as arrays, with the lens taken out of the pixels once and for all."""

    lens: Lens
    points: Floats  # (N, 3) metres
    pixels: Floats  # (N, 2)
    directions: Floats  # (N, 2) x/z and y/z; NaN beyond the lens's fold

    def of(self, which: Mask | NDArray[np.int64]) -> Sights:
        return Sights(self.lens, self.points[which], self.pixels[which], self.directions[which])


@dataclass(frozen=True, eq=False)
class Pose:
    rvec: Floats  # (3,)
    tvec: Floats  # (3,)
    errors: Floats  # (N,) pixels, of the sights it was fitted to

    @property
    def cost(self) -> float:
        return float(self.errors @ self.errors)

    @property
    def rms(self) -> float:
        return float(np.sqrt(np.mean(self.errors**2)))

    @property
    def centre(self) -> Floats:
        centre: Floats = -cv2.Rodrigues(self.rvec)[0].T @ self.tvec
        return centre


def sights_of(lens: Lens, points: Floats, pixels: Floats) -> Sights:
    nowhere = lens.camera("", np.zeros(3), np.zeros(3))
    return Sights(lens, points, pixels, normalise(nowhere, pixels))


def best_pose(sights: Sights) -> Pose | None:
    """The pose above the ground that explains all sights best; None where no closed form gives one."""
    return next(iter(poses(sights)), None)


def poses(sights: Sights, ground: bool = True) -> list[Pose]:
    """Every distinct refined pose with the points before the camera, best first."""
    found: list[Pose] = []
    for rvec, tvec in candidates(sights, is_flat(sights.points)):
        pose = refined(sights, rvec, tvec)
        if pose is not None and _sane(sights, pose, ground) and not _known(found, pose):
            found.append(pose)
    return sorted(found, key=lambda pose: pose.cost)


def candidates(sights: Sights, flat: bool) -> Iterator[tuple[Floats, Floats]]:
    """Poses of the closed forms, unrefined, on pixels without lens; `flat`: all points are in one plane."""
    methods = [cv2.SOLVEPNP_SQPNP]
    if flat:
        methods.append(cv2.SOLVEPNP_IPPE)  # gives both poses from which a plane looks alike
    elif len(sights.points) > 5:
        methods += [cv2.SOLVEPNP_EPNP]
    for method in methods:
        yield from _closed_form(sights, method)


def is_flat(points: Floats) -> bool:
    extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return bool(extents[2] <= FLAT * extents[0])


def refined(sights: Sights, rvec: Floats, tvec: Floats) -> Pose | None:
    """Levenberg-Marquardt on the pixels as clicked; None when it ends nowhere."""
    pose: Floats = np.concatenate((rvec, tvec))
    damping = 1e-3
    misses, jacobian = _misses(sights, pose)
    cost = float(misses @ misses)
    for _ in range(LM_STEPS):
        if not np.isfinite(cost) or cost > 1e30:
            return None
        ahead = np.add(pose, _step(jacobian, misses, damping), dtype=np.float64)
        tried, tried_jacobian = _misses(sights, ahead)
        new = float(tried @ tried)
        if not new < cost:
            damping *= 10
            if damping > 1e8:
                break
            continue
        drop = (cost - new) / cost
        pose, misses, jacobian, cost, damping = ahead, tried, tried_jacobian, new, damping / 10
        if drop < LM_STOP or cost < 1e-16:
            break
    return Pose(pose[:3], pose[3:], np.hypot(*misses.reshape(-1, 2).T))


def errors_of(sights: Sights, pose: Pose) -> Floats:
    """(N,) pixels between clicks and expectations; infinite for points not before the camera."""
    misses, _ = _misses(sights, np.concatenate((pose.rvec, pose.tvec)))
    errors = np.hypot(*misses.reshape(-1, 2).T)
    return np.where(np.isfinite(errors) & (_depths(sights.points, pose) > 0), errors, np.inf)


def covariance_of(sights: Sights, pose: Pose, least_sigma: float) -> Floats:
    """(6, 6) of rvec and tvec, each click being off by what the misses tell, at least by `least_sigma` px."""
    misses, jacobian = _misses(sights, np.concatenate((pose.rvec, pose.tvec)))
    spare = max(len(misses) - 6, 1)
    variance = max(float(misses @ misses) / spare, least_sigma**2)
    return np.asarray(variance * np.linalg.pinv(jacobian.T @ jacobian), dtype=np.float64)


def projection(lens: Lens, rvec: Floats, tvec: Floats, points: Floats) -> tuple[Floats, Floats]:
    """Pixels (N, 2), and (N, 2, 6) how they change with rvec and tvec."""
    pixels, jacobian = cv2.projectPoints(points, rvec, tvec, lens.matrix, lens.distortion)
    by_pose = np.asarray(jacobian, dtype=np.float64)[:, :6].reshape(-1, 2, 6)
    return np.asarray(pixels, dtype=np.float64).reshape(-1, 2), by_pose


def _misses(sights: Sights, pose: Floats) -> tuple[Floats, Floats]:
    with np.errstate(all="ignore"):
        pixels, jacobian = projection(sights.lens, pose[:3], pose[3:], sights.points)
        return (pixels - sights.pixels).ravel(), jacobian.reshape(-1, 6)


def _step(jacobian: Floats, misses: Floats, damping: float) -> Floats:
    square = jacobian.T @ jacobian
    damped = square + damping * np.diag(np.maximum(np.diag(square), 1e-12))
    try:
        return np.asarray(np.linalg.solve(damped, -jacobian.T @ misses), dtype=np.float64)
    except np.linalg.LinAlgError:
        return np.zeros(6)


def _closed_form(sights: Sights, method: int) -> list[tuple[Floats, Floats]]:
    try:
        _count, rvecs, tvecs, _errors = cv2.solvePnPGeneric(
            sights.points, sights.directions, UPRIGHT, NO_LENS, flags=method
        )
    except cv2.error:  # a form that does not fit these points; another one may
        return []
    found = [(_vector(rvec), _vector(tvec)) for rvec, tvec in zip(rvecs, tvecs, strict=True)]
    return [each for each in found if all(np.isfinite(part).all() for part in each)]


def _vector(values: ArrayLike) -> Floats:
    return np.asarray(values, dtype=np.float64).ravel()


def _depths(points: Floats, pose: Pose) -> Floats:
    depths: Floats = points @ cv2.Rodrigues(pose.rvec)[0][2] + pose.tvec[2]
    return depths


def _sane(sights: Sights, pose: Pose, ground: bool) -> bool:
    if not (np.isfinite(pose.rvec).all() and np.isfinite(pose.tvec).all()):
        return False
    return bool((_depths(sights.points, pose) > 0).all()) and (not ground or pose.centre[2] > 0)


def _known(found: list[Pose], pose: Pose) -> bool:
    size = 1e-4 * (1.0 + float(np.linalg.norm(pose.tvec)))
    return any(np.linalg.norm(other.centre - pose.centre) < size for other in found)


def subsets(count: int, size: int, most: int, seed: int) -> list[NDArray[np.int64]]:
    """Index sets to try: all there are, else `most` drawn ones; always the same."""
    rng = np.random.default_rng(seed)
    everything = list(itertools.islice(itertools.combinations(range(count), size), most + 1))
    if len(everything) <= most:
        return [np.array(each) for each in everything]
    return [rng.choice(count, size, replace=False) for _ in range(most)]
