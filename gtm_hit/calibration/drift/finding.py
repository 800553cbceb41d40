"""Finding marks again in a later picture, to parts of a pixel and whatever the light."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from gtm_hit.calibration.drift.marks import HALF, SIDE, Grey, Mark, Marks

REACH = (24, 160)  # pixels around its place in which a mark is looked for; farther where too few are near
ALIKE = 0.8  # correlation from which on it is the same thing; less is somebody in front of it
ENOUGH = 0.5  # share of the marks that have to be near
ROUNDS = 30


@dataclass(frozen=True)
class FoundMark:
    """By how much a mark has moved, in pixels."""

    x: float
    y: float
    dx: float
    dy: float


def find(marks: Marks, picture: Grey) -> list[FoundMark]:
    """Those that are still seen; what somebody stands before, or what has changed, is left out."""
    found: list[FoundMark] = []
    for reach in REACH:
        wider = [_search(mark, picture, reach) for mark in marks.marks]
        found = [each for each in wider if each is not None]
        if len(found) >= ENOUGH * len(marks.marks):
            break
    return found


def _search(mark: Mark, picture: Grey, reach: int) -> FoundMark | None:
    height, width = picture.shape
    left, top = max(mark.x - HALF - reach, 0), max(mark.y - HALF - reach, 0)
    right, bottom = min(mark.x + HALF + reach + 1, width), min(mark.y + HALF + reach + 1, height)
    scores = cv2.matchTemplate(picture[top:bottom, left:right], mark.piece, cv2.TM_CCOEFF_NORMED)
    _, best, _, (x, y) = cv2.minMaxLoc(scores)
    if not best >= ALIKE:
        return None
    finer = _refined(mark.piece, picture, left + x, top + y)
    if finer is None:
        return None
    return FoundMark(mark.x, mark.y, finer[0] + HALF - mark.x, finer[1] + HALF - mark.y)


def _refined(piece: Grey, picture: Grey, left: int, top: int) -> tuple[float, float] | None:
    """Where the piece's corner is to parts of a pixel, by Gauss-Newton with gain and offset of the light."""
    pad = 3
    height, width = picture.shape
    if left < pad or top < pad or left + SIDE + pad > width or top + SIDE + pad > height:
        return None
    there = cv2.GaussianBlur(
        picture[top - pad : top + SIDE + pad, left - pad : left + SIDE + pad], (0, 0), 1.0
    )
    window = there.astype(np.float32)
    wanted = cv2.GaussianBlur(piece, (0, 0), 1.0).astype(np.float32)
    inner = np.s_[2:-2, 2:-2]  # the blur knows nothing beyond the piece's rim
    x = y = 0.0
    for _ in range(ROUNDS):
        centre = (window.shape[1] / 2 - 0.5 + x, window.shape[0] / 2 - 0.5 + y)
        seen = cv2.getRectSubPix(window, (SIDE, SIDE), centre)
        gx, gy = (
            cv2.Sobel(seen, cv2.CV_32F, 1, 0, scale=1 / 8),
            cv2.Sobel(seen, cv2.CV_32F, 0, 1, scale=1 / 8),
        )
        columns = [gx[inner].ravel(), gy[inner].ravel(), seen[inner].ravel(), np.ones(seen[inner].size)]
        # wanted = gain · (seen + gradient · step) + offset, the step scaled by the gain
        answer = np.linalg.lstsq(np.column_stack(columns), wanted[inner].ravel(), rcond=None)[0]
        if not answer[2] > 0:
            return None
        step = answer[:2] / answer[2]
        x, y = x + float(step[0]), y + float(step[1])
        if not (abs(x) < pad - 0.5 and abs(y) < pad - 0.5):
            return None
        if np.hypot(*step) < 0.002:
            return left + x, top + y
    return None
