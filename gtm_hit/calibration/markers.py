"""A ChArUco board's corners: between markers whose own corners must not be mistaken for them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.boards import Board, charuco
from gtm_hit.calibration.views import Floats, Grey

PAPER = 90  # percentile of the grey values of a marker and its rim: white paper


@dataclass(frozen=True, eq=False)
class Seen:
    corners: Floats  # (N, 2) pixels, roughly
    ids: NDArray[np.int64]  # (N,)
    markers: tuple[Floats, ...]  # each (4, 2) pixels


def detect(grey: Grey, board: Board) -> Seen:
    """What of a ChArUco board is seen."""
    corners, ids, markers, _ = cv2.aruco.CharucoDetector(charuco(board)).detectBoard(grey)
    none = ids is None or corners is None
    return Seen(
        np.zeros((0, 2)) if none else np.asarray(corners, dtype=np.float64).reshape(-1, 2),
        np.zeros(0, dtype=np.int64) if none else np.asarray(ids, dtype=np.int64).ravel(),
        tuple(np.asarray(marker, dtype=np.float64).reshape(4, 2) for marker in markers or ()),
    )


def without_markers(grey: Grey, markers: Sequence[Floats], board: Board) -> Grey:
    """The picture with every marker painted over by its paper, up to the middle of its white rim.

    What is left is a chessboard, whose corners can be refined in as large a window: half the error.
    """
    clean = grey.copy()
    wider = 1 + (1 - board.marker) / (2 * board.marker)
    for marker in markers:
        middle = marker.mean(axis=0)
        _paint(clean, middle + (marker - middle) * wider)
    return clean


def _paint(picture: Grey, outline: Floats) -> None:
    low = np.maximum(np.floor(outline.min(axis=0)).astype(int) - 1, 0)
    high = np.ceil(outline.max(axis=0)).astype(int) + 2
    part = picture[low[1] : high[1], low[0] : high[0]]
    mask = np.zeros(part.shape, dtype=np.uint8)
    cv2.fillConvexPoly(mask, np.round((outline - low) * 16).astype(np.int32), 1, shift=4)
    within = mask > 0
    if within.any():
        part[within] = np.percentile(part[within], PAPER)
