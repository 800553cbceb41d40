"""What goes into finding where a camera stands, and what comes out of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.errors import GeometryError

Floats = NDArray[np.float64]


class PoseError(GeometryError):
    """These pairs give no pose; says why in one sentence."""


@dataclass(frozen=True)
class Pair:
    """A measured point and where it was clicked."""

    name: str
    point: tuple[float, float, float]  # metres, world
    pixel: tuple[float, float]  # of the picture as taken


class Trouble(StrEnum):
    """What a finding is about."""

    FEW = "few"  # fewer pairs than a sound pose needs
    HULL = "hull"  # the clicks cover a small part of the picture
    OUTLIER = "outlier"  # a pair that contradicts the others, nobody knows how
    SWAPPED = "swapped"  # two clicks exchanged
    COORDINATE = "coordinate"  # one typed number is wrong
    LENS = "lens"  # the pairs agree too badly for the lens to be right
    CLICK = "click"  # the click lies on another measured point
    UNIT = "unit"  # lengths in another unit than was said
    FOLD = "fold"  # the lens has no answer where the click is
    TWO_POSES = "two poses"  # a second pose explains the pairs nearly as well


@dataclass(frozen=True)
class Finding:
    """Something about the pairs that a person should look at."""

    trouble: Trouble
    text: str  # a sentence
    names: tuple[str, ...] = ()  # of the pairs it is about


@dataclass(frozen=True)
class Residual:
    """How far a click is from where the pose expects the point."""

    name: str
    dx: float  # pixels, click minus expectation; NaN where nothing can be expected
    dy: float
    cm: float  # on the plane at the point's height; NaN where the click shows no ground
    used: bool  # False: an outlier, or beyond the lens's fold, which the pose was found without

    @property
    def px(self) -> float:
        return float(np.hypot(self.dx, self.dy))


@dataclass(frozen=True, eq=False)
class PoseSolution:
    """Where a camera stands, by the pairs that agree with each other."""

    rvec: Floats  # (3,) radians, world to camera
    tvec: Floats  # (3,) metres, world to camera
    covariance: Floats  # (6, 6) of rvec and tvec
    residuals: tuple[Residual, ...]  # in the order of the pairs
    findings: tuple[Finding, ...]
    lens: Lens

    @cached_property
    def camera(self) -> Camera:
        return self.lens.camera("", self.rvec, self.tvec)

    @property
    def centre(self) -> Floats:
        """(3,) metres."""
        return self.camera.centre

    @cached_property
    def centre_sigma(self) -> Floats:
        """(3,) metres, one standard deviation along X, Y and Z."""
        return np.sqrt(np.clip(np.diag(self._centre_covariance), 0.0, None))

    @property
    def centre_spread(self) -> float:
        """Metres: how far off the centre is likely to be in space."""
        return float(np.linalg.norm(self.centre_sigma))

    @property
    def inliers(self) -> tuple[str, ...]:
        return tuple(each.name for each in self.residuals if each.used)

    @property
    def outliers(self) -> tuple[str, ...]:
        return tuple(each.name for each in self.residuals if not each.used)

    @property
    def rms(self) -> float:
        """Pixels, over the pairs that were used."""
        return rms_of([each for each in self.residuals if each.used])

    @property
    def rms_all(self) -> float:
        """Pixels, over all pairs something is expected of."""
        return rms_of([each for each in self.residuals if np.isfinite(each.px)])

    @cached_property
    def _centre_covariance(self) -> Floats:
        by_pose = _centre_derivative(self.lens, self.rvec, self.tvec)
        return by_pose @ self.covariance @ by_pose.T


def rms_of(residuals: Sequence[Residual]) -> float:
    return float(np.sqrt(np.mean([each.px**2 for each in residuals]))) if residuals else float("nan")


def _centre_derivative(lens: Lens, rvec: Floats, tvec: Floats) -> Floats:
    """(3, 6): metres of the centre per radian and metre of the pose."""
    small, columns = 1e-6, []
    pose = np.concatenate((rvec, tvec))
    for step in np.eye(6) * small:
        ahead, behind = (lens.camera("", each[:3], each[3:]).centre for each in (pose + step, pose - step))
        columns.append((ahead - behind) / (2 * small))
    return np.column_stack(columns)
