"""Where a camera stands, from measured points clicked in its picture."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.pose_findings import findings_of, interchanged
from gtm_hit.calibration.pose_fit import Floats, Mask, Sights, covariance_of, poses, sights_of
from gtm_hit.calibration.pose_robust import Agreement, agreed_pose
from gtm_hit.calibration.pose_values import (
    Finding,
    Pair,
    PoseError,
    PoseSolution,
    Residual,
    Trouble,
)
from gtm_hit.geometry.camera import normalise

__all__ = [
    "LEAST_PAIRS",
    "Finding",
    "Pair",
    "PoseError",
    "PoseSolution",
    "Residual",
    "Trouble",
    "solve_pose",
]

LEAST_PAIRS = 4
THIN = 0.01  # breadth by length below which points count as one line
CLICK_SIGMA = 0.5  # pixels; nobody clicks better, however well few pairs fit
MOST_RMS = 0.1  # of the picture's width: more is no pose, whatever a solver says


def solve_pose(lens: Lens, pairs: Sequence[Pair]) -> PoseSolution:
    """The pose by the pairs that agree, and what is to be said about the others; PoseError without one."""
    points, pixels = _arrays(pairs)
    sights = sights_of(lens, points, pixels)
    known: Mask = np.isfinite(sights.directions[:, 0])
    _check(sights.of(known), len(pairs) - int(known.sum()))
    names = [pair.name for pair in pairs]
    found = agreed_pose(sights.of(known))
    if found is None or found.pose.rms > MOST_RMS * lens.width:
        raise PoseError(_why_none(sights.of(known)))
    used = known.copy()
    used[known] = found.agree
    findings = findings_of(sights, names, found, known)
    return PoseSolution(
        found.pose.rvec,
        found.pose.tvec,
        covariance_of(sights.of(used), found.pose, CLICK_SIGMA),
        _residuals(sights, names, found, used),
        findings,
        lens,
    )


def _arrays(pairs: Sequence[Pair]) -> tuple[Floats, Floats]:
    """(N, 3) and (N, 2); PoseError for what is no number, and for names or places given twice."""
    try:
        points = np.array([pair.point for pair in pairs], dtype=np.float64).reshape(-1, 3)
        pixels = np.array([pair.pixel for pair in pairs], dtype=np.float64).reshape(-1, 2)
    except (TypeError, ValueError) as error:
        raise PoseError("a pair has no three numbers for its point, or no two for its click") from error
    for pair, row in zip(pairs, np.column_stack((points, pixels)), strict=True):
        if not np.isfinite(row).all():
            raise PoseError(f"pair {pair.name} holds something that is no finite number")
    _refuse_twice(pairs)
    return points, pixels


def _refuse_twice(pairs: Sequence[Pair]) -> None:
    names: set[str] = set()
    places: dict[tuple[float, ...], str] = {}
    for pair in pairs:
        place = tuple(np.round(np.asarray(pair.point, dtype=np.float64), 6).tolist())
        if pair.name in names:
            raise PoseError(f"point {pair.name} was clicked twice: keep one of the two")
        if place in places:
            raise PoseError(f"points {places[place]} and {pair.name} have the same coordinates")
        names.add(pair.name)
        places[place] = pair.name


def _check(sights: Sights, folded: int) -> None:
    """PoseError where the pairs cannot give a pose, however well they were clicked."""
    count = len(sights.points)
    if count < LEAST_PAIRS:
        beyond = f" ({folded} more lie where the lens has no answer)" if folded else ""
        raise PoseError(f"a pose needs at least {LEAST_PAIRS} pairs; there are {count}{beyond}")
    if _is_thin(sights.points):
        raise PoseError("the points lie on one line; take some beside it")
    if _is_thin(sights.pixels):
        raise PoseError("the clicks lie on one line; choose points that spread over the picture")


def _is_thin(values: Floats) -> bool:
    extents = np.linalg.svd(values - values.mean(axis=0), compute_uv=False)
    return bool(extents[1] <= THIN * extents[0])


def _why_none(sights: Sights) -> str:
    below = [pose for pose in poses(sights, ground=False) if pose.rms <= MOST_RMS * sights.lens.width]
    if not below:
        return "no pose explains these pairs: check the names, and that the lens belongs to this camera"
    if axes := interchanged(sights):
        return f"the camera would stand under the ground; {axes}"
    return (
        "the camera would stand under the ground: are the points' names in order, "
        "and does Z point up with X, Y, Z right-handed?"
    )


def _residuals(sights: Sights, names: Sequence[str], found: Agreement, used: Mask) -> tuple[Residual, ...]:
    pose, lens = found.pose, sights.lens
    expected = cv2.projectPoints(sights.points, pose.rvec, pose.tvec, lens.matrix, lens.distortion)[0]
    missed = sights.pixels - expected.reshape(-1, 2)
    metres = np.linalg.norm(_shown(sights, found) - sights.points[:, :2], axis=1)
    rows = zip(names, missed.tolist(), metres.tolist(), used.tolist(), strict=True)
    return tuple(Residual(name, dx, dy, 100 * off, use) for name, (dx, dy), off, use in rows)


def _shown(sights: Sights, found: Agreement) -> Floats:
    """(N, 2) X and Y of what the clicks show at their points' heights; NaN where that is no ground."""
    camera = sights.lens.camera("", found.pose.rvec, found.pose.tvec)
    directions = normalise(camera, sights.pixels)
    rays = np.column_stack((directions, np.ones(len(directions)))) @ camera.rotation
    with np.errstate(all="ignore"):
        depth = (sights.points[:, 2] - camera.centre[2]) / rays[:, 2]
        shown = camera.centre[:2] + depth[:, None] * rays[:, :2]
    return np.where((depth > 0)[:, None], shown, np.nan)
