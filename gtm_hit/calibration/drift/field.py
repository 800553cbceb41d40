"""One movement that explains where the marks went: a shift, a turn and a change of size."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from gtm_hit.calibration.drift.finding import FoundMark
from gtm_hit.geometry.camera import Floats

FEWEST = 8  # marks that have to agree
AGREEING = 1.0  # pixels between where a mark is and where the movement puts it
SHARE = 0.25  # of the marks that were remembered
REFINE, TRIES, SURE = 20, 4000, 0.999
FLOOR = 0.02  # pixels; no picture tells more than this


@dataclass(frozen=True, eq=False)
class Movement:
    """`matrix` (2, 3) takes a pixel of the calibrated picture to the later one."""

    matrix: Floats
    marks: tuple[FoundMark, ...]  # that agree
    px: float  # median over the marks
    most_px: float  # of any mark
    sigma_px: float  # of the shift, one standard deviation
    degrees: float
    scale: float

    def moved(self, pixels: Floats) -> Floats:
        return pixels @ self.matrix[:, :2].T + self.matrix[:, 2]


def movement(found: Sequence[FoundMark], remembered: int) -> Movement | None:
    """None where too few marks agree to tell."""
    if len(found) < FEWEST:
        return None
    at = np.array([(mark.x, mark.y) for mark in found], dtype=np.float64)
    to = at + np.array([(mark.dx, mark.dy) for mark in found])
    middle = at.mean(axis=0)
    cv2.setRNGSeed(1)  # the same pictures give the same digits
    matrix, kept = cv2.estimateAffinePartial2D(
        at - middle,
        to - middle,
        method=cv2.RANSAC,
        ransacReprojThreshold=AGREEING,
        maxIters=TRIES,
        confidence=SURE,
        refineIters=REFINE,
    )
    if matrix is None or kept.sum() < max(FEWEST, math.ceil(SHARE * remembered)):
        return None
    inliers = kept.ravel().astype(bool)
    matrix = np.asarray(matrix, dtype=np.float64)
    matrix[:, 2] += middle - matrix[:, :2] @ middle
    predicted = at @ matrix[:, :2].T + matrix[:, 2]
    lengths = np.hypot(*(predicted - at)[inliers].T)
    misses = (to - predicted)[inliers]
    sigma = math.hypot(math.sqrt(float((misses**2).sum()) / len(misses) / len(misses)), FLOOR)
    return Movement(
        matrix,
        tuple(mark for mark, keeps in zip(found, inliers, strict=True) if keeps),
        float(np.median(lengths)),
        float(lengths.max()),
        sigma,
        math.degrees(math.atan2(matrix[1, 0], matrix[0, 0])),
        math.hypot(matrix[0, 0], matrix[1, 0]),
    )
