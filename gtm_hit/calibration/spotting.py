"""OpenCV's detectors, each asked one question.

Some draw by chance, from a generator that goes on between calls: it starts anew before each of them, so that
the same picture gives the same answer every time.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np

from gtm_hit.calibration.views import Floats, Grey

SEED = 0
SMALLEST_CIRCLE = 12.0  # pixels² in a picture
LARGEST_CIRCLE = 0.02  # share of the picture


def shrunk(grey: Grey, longest: int) -> tuple[Grey, float]:
    """The picture with its longer side at most `longest` pixels, and the factor."""
    scale = min(1.0, longest / max(grey.shape))
    if scale == 1.0:
        return grey, 1.0
    small = cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return small.astype(np.uint8, copy=False), scale


def grid_spacing(pixels: Floats, size: tuple[int, int]) -> float:
    """Pixels between the two neighbours of a full grid that are closest."""
    grid = pixels.reshape(size[1], size[0], 2)
    steps = [np.linalg.norm(np.diff(grid, axis=axis), axis=2).min() for axis in (0, 1)]
    return float(min(steps))


def chessboard_corners(grey: Grey, size: tuple[int, int]) -> Floats | None:
    """Roughly where a chessboard's inner corners are, (rows, columns, 2) pixels."""
    found, corners = cv2.findChessboardCorners(grey, size)
    return np.asarray(corners, dtype=np.float64).reshape(size[1], size[0], 2) if found else None


def largest_chessboard(grey: Grey) -> Floats | None:
    """The largest whole grid of a chessboard's corners that is seen, (rows, columns, 2) pixels."""
    cv2.setRNGSeed(SEED)
    try:
        found, corners, meta = cv2.findChessboardCornersSBWithMeta(grey, (3, 3), cv2.CALIB_CB_LARGER)
    except cv2.error:
        return None
    if not found or corners is None or corners.size != meta.size * 2:
        return None
    return corners.reshape(*meta.shape[:2], 2).astype(np.float64)


def circle_centres(grey: Grey, size: tuple[int, int], shifted: bool) -> Floats | None:
    """Centres of a grid of dark circles, (columns · rows, 2) pixels, row after row."""
    flags = cv2.CALIB_CB_ASYMMETRIC_GRID if shifted else cv2.CALIB_CB_SYMMETRIC_GRID
    detector = _blobs(grey)
    for extra in (0, cv2.CALIB_CB_CLUSTERING):
        cv2.setRNGSeed(SEED)
        try:
            found, centres = cv2.findCirclesGrid(grey, size, flags=flags + extra, blobDetector=detector)
        except cv2.error:
            continue
        if found:
            return centres.reshape(-1, 2).astype(np.float64)
    return None


def circle_count(grey: Grey) -> int:
    return len(_blobs(grey).detect(grey))


def _blobs(grey: Grey) -> Any:  # OpenCV's own type annotations do not know it
    wanted = cv2.SimpleBlobDetector.Params()
    wanted.minArea = SMALLEST_CIRCLE
    wanted.maxArea = max(5000.0, LARGEST_CIRCLE * grey.size)
    wanted.minDistBetweenBlobs = 5.0
    return cv2.SimpleBlobDetector.create(wanted)
