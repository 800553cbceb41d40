"""Clicks on one thing in several views: where it is, how sure that is, and where other views must show it.

`static/geometry/spatial.js` and `static/geometry/epipolar.js` do the same in the browser; both are held
against `fixtures/check_cases.json`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry import lens
from gtm_hit.geometry.camera import Camera, CameraModel, normalise, project

Floats = NDArray[np.float64]

CLICK_SIGMA = 2.0  # pixels: of a careful click, with what calibrations are usually off
DOUBT = 3.0  # σ beyond which a click is marked
STEPS = 30
SMALL = 1e-4  # metres
CONVERGED = 1e-9  # metres
PARALLEL = 1e-9  # of the determinant of what the rays tell together: below it they do not meet
NEAREST = 0.05  # metres before a camera from which on it can see anything
FARTHEST = 1000.0  # metres that a ray into the sky is followed
PIECES = 64  # of an epipolar line


@dataclass(frozen=True, eq=False)
class Click:
    camera: Camera
    u: float  # pixels of the picture as taken
    v: float


@dataclass(frozen=True, eq=False)
class Spot:
    """Where clicks in two or more views meet.

    point : (3,) metres; the ground position is its first two, the height its third
    covariance : (3, 3) metres²
    misses : (N, 2) projection minus click, pixels
    doubtful : (N,) beyond 3 σ: the click that spoils the others' agreement, or both where there are two
    angle : degrees at which the two rays cross that cross best; where it is small, ± is large
    """

    point: Floats
    covariance: Floats
    misses: Floats
    doubtful: NDArray[np.bool_]
    angle: float

    @property
    def sigmas(self) -> Floats:
        """(3,) ± metres along X, Y and Z."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def ground_sigma(self) -> float:
        """± metres on the ground, X and Y together."""
        return float(np.sqrt(self.covariance[0, 0] + self.covariance[1, 1]))

    @property
    def residuals(self) -> Floats:
        """(N,) pixels."""
        return np.hypot(self.misses[:, 0], self.misses[:, 1])


def spot(clicks: Sequence[Click], sigma: float = CLICK_SIGMA) -> Spot | None:
    """The point with the least squares of the misses in pixels, σ being that of one click.

    None for fewer than two clicks, for parallel rays, and where the rays meet behind a camera.
    """
    point = _meeting(clicks)
    if point is None:
        return None
    misses = _misses(clicks, point)
    doubtful = np.zeros(len(clicks), dtype=bool)
    doubtful[_doubtful(clicks, misses, sigma)] = True
    slopes = _slopes(clicks, point, misses)
    spare = max(2 * len(clicks) - 3, 1)
    # Clicks that disagree by more than σ say themselves that it is larger.
    variance = max(sigma**2, float((misses**2).sum()) / spare)
    covariance: Floats = (variance * np.linalg.inv(slopes.T @ slopes)).astype(np.float64)
    return Spot(point, covariance, misses, doubtful, _angle(clicks))


def shown(camera: Camera, point: Floats) -> Floats:
    """(2,) pixel of a world point; NaN behind the camera and beyond the fold of its lens."""
    return _all_shown(camera, point[None])[0]


def _all_shown(camera: Camera, points: Floats) -> Floats:
    """(N, 2) pixels of world points."""
    right, down, depth = (points @ camera.rotation.T + camera.tvec).T
    with np.errstate(all="ignore"):
        seen = (depth * camera.facing > 0) & (np.hypot(right, down) / np.abs(depth) < fold(camera))
    return np.where(seen[:, None], project(camera, points), np.nan)


def fold(camera: Camera) -> float:
    """Radius in normalised units beyond which a lens shows nothing."""
    return lens.limit(camera.distortion) if camera.model is CameraModel.PINHOLE else np.inf


def epipolar_line(click: Click, other: Camera) -> Floats:
    """(N, 2) pixels of `other` on which lies what was clicked, wherever along the ray it is; N may be 0.

    From the clicking camera outwards until the ray meets the ground, or very far; only what `other` sees.
    """
    ray = _ray(click)
    if ray is None:
        return np.zeros((0, 2))
    segment = _in_front(other, click.camera.centre, ray * _reach(click.camera, ray))
    if segment is None:
        return np.zeros((0, 2))
    start, end = segment
    # In the normalised plane the line is straight; the lens bends it afterwards.
    first, last = start[:2] / start[2], end[:2] / end[2]
    part = _within(first, last, _seen_radius(other))
    if part is None:
        return np.zeros((0, 2))
    along = np.linspace(*part, PIECES + 1)[:, None]
    x, y = (first + along * (last - first)).T
    x, y = other.distort(x, y) if other.has_lens else (x, y)
    (fx, _, cx), (_, fy, cy), _ = other.matrix.tolist()
    return np.column_stack((x * fx + cx, y * fy + cy))


def _meeting(clicks: Sequence[Click]) -> Floats | None:
    """Damped Gauss and Newton from where the rays come closest; None where that is in no view."""
    here = _closest(clicks)
    if here is None or len(clicks) < 2:
        return None
    misses = _misses(clicks, here)
    if not np.isfinite(misses).all():
        return None
    damping = 1e-3
    for _ in range(STEPS):
        slopes = _slopes(clicks, here, misses)
        if not np.isfinite(slopes).all():
            break
        squares = slopes.T @ slopes
        move = -np.linalg.solve(squares + damping * np.diag(np.diag(squares)), slopes.T @ misses.ravel())
        after = _misses(clicks, here + move)
        if (after**2).sum() <= (misses**2).sum():  # NaN is not
            here, misses, damping = here + move, after, damping / 10
        else:
            damping *= 10
        if np.abs(move).max() < CONVERGED:
            break
    return here


def _closest(clicks: Sequence[Click]) -> Floats | None:
    total, towards = np.zeros((3, 3)), np.zeros(3)
    for click in clicks:
        ray = _ray(click)
        if ray is None:
            return None
        across = np.eye(3) - np.outer(ray, ray)
        total += across
        towards += across @ click.camera.centre
    return np.linalg.solve(total, towards).astype(np.float64) if np.linalg.det(total) > PARALLEL else None


def _ray(click: Click) -> Floats | None:
    """(3,) of length 1, into the world; None where the lens shows nothing."""
    camera = click.camera
    direction = normalise(camera, [[click.u, click.v]])[0]
    if not np.isfinite(direction).all():
        return None
    ray = camera.facing * np.append(direction, 1.0) @ camera.rotation
    return ray / np.linalg.norm(ray)


def _misses(clicks: Sequence[Click], point: Floats) -> Floats:
    return np.array([shown(click.camera, point) - (click.u, click.v) for click in clicks])


def _slopes(clicks: Sequence[Click], point: Floats, misses: Floats) -> Floats:
    """(2 N, 3) how the misses change with the point."""
    moved = point + SMALL * np.eye(3)
    here = misses + [(click.u, click.v) for click in clicks]
    steps = [_all_shown(click.camera, moved) - pixel for click, pixel in zip(clicks, here, strict=True)]
    return np.concatenate([each.T / SMALL for each in steps])


def _doubtful(clicks: Sequence[Click], misses: Floats, sigma: float) -> list[int]:
    """Places of the clicks that are off by more than 3 σ once those are left out that spoil the rest."""
    if not (np.hypot(misses[:, 0], misses[:, 1]) > DOUBT * sigma).any():
        return []
    if len(clicks) == 2:
        return [0, 1]
    costs = [_cost_without(clicks, place) for place in range(len(clicks))]
    worst = int(np.argmin(costs))
    others = [place for place in range(len(clicks)) if place != worst]
    left = [clicks[place] for place in others]
    point = _meeting(left)
    if point is None:
        return [worst]
    return [worst, *(others[place] for place in _doubtful(left, _misses(left, point), sigma))]


def _cost_without(clicks: Sequence[Click], left_out: int) -> float:
    others = [click for place, click in enumerate(clicks) if place != left_out]
    point = _meeting(others)
    return float("inf") if point is None else float((_misses(others, point) ** 2).sum())


def _angle(clicks: Sequence[Click]) -> float:
    rays = [ray for click in clicks if (ray := _ray(click)) is not None]
    sines = [
        float(np.linalg.norm(np.cross(one, other)))
        for place, one in enumerate(rays)
        for other in rays[:place]
    ]
    return float(np.degrees(np.arcsin(min(1.0, max(sines)))))


def _reach(camera: Camera, ray: Floats) -> float:
    """Metres along a ray to the ground; very far where it does not come down."""
    down = -camera.centre[2] / ray[2] if ray[2] else np.inf
    return float(down) if 0 < down < FARTHEST else FARTHEST


def _in_front(camera: Camera, start: Floats, along: Floats) -> tuple[Floats, Floats] | None:
    """Ends of a segment in the camera's axes, cut off where it goes behind it; None if all of it is."""
    first = camera.rotation @ start + camera.tvec
    last = camera.rotation @ (start + along) + camera.tvec
    near, far = first[2] * camera.facing, last[2] * camera.facing
    if near < NEAREST and far < NEAREST:
        return None
    if near < NEAREST:
        return first + (NEAREST - near) / (far - near) * (last - first), last
    if far < NEAREST:
        return first, last + (NEAREST - far) / (near - far) * (first - last)
    return first, last


def _seen_radius(camera: Camera) -> float:
    """Normalised radius of the farthest corner that shows anything, or the lens' fold."""
    corners = [(x, y) for x in (0.0, camera.width - 1.0) for y in (0.0, camera.height - 1.0)]
    radii = np.hypot(*normalise(camera, corners).T)
    return float(radii.max()) if np.isfinite(radii).all() else fold(camera)


def _within(first: Floats, last: Floats, radius: float) -> tuple[float, float] | None:
    """From where to where, as shares of it, a segment of the plane runs within a circle."""
    if not np.isfinite(radius):
        return 0.0, 1.0
    away = last - first
    a, b, c = float(away @ away), float(first @ away), float(first @ first) - radius * radius
    inside = b * b - a * c
    if not (inside > 0 and a > 0):
        return None
    enters, leaves = max(0.0, (-b - inside**0.5) / a), min(1.0, (-b + inside**0.5) / a)
    return (enters, leaves) if enters < leaves else None
