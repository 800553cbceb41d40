"""How well the foreground of a view agrees with bodies standing somewhere, all others being where they are.

A body is an outline: how often each part around somebody who stands or walks is not the background, measured
on people whose places are known. Where others stand, before or behind, their outlines explain what is seen.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, Floats, project
from gtm_hit.vision.masks import Mask

Flags = NDArray[np.bool_]
Cells = NDArray[np.float32]  # (N, rows, columns, 2): pixels of the mask

# Percent, from above the head to below the feet, from the side to the middle; the other side is alike.
# Measured on MultiviewX's frames 0-2 and the demo scene's frames 0-4.
_LEFT = (
    (0, 0, 0, 0, 0, 0, 0, 0),
    (0, 0, 0, 0, 0, 2, 26, 35),
    (0, 0, 0, 0, 0, 14, 56, 71),
    (0, 0, 0, 0, 0, 25, 85, 95),
    (0, 0, 0, 0, 0, 34, 94, 97),
    (0, 0, 0, 6, 21, 50, 93, 97),
    (0, 0, 0, 15, 34, 66, 90, 90),
    (0, 0, 0, 19, 50, 82, 89, 87),
    (0, 0, 6, 26, 53, 83, 89, 88),
    (0, 1, 12, 30, 51, 80, 86, 87),
    (0, 4, 14, 32, 54, 82, 87, 87),
    (2, 7, 16, 30, 54, 86, 90, 90),
    (2, 7, 17, 28, 54, 86, 92, 90),
    (5, 7, 15, 24, 50, 85, 91, 89),
    (2, 4, 7, 17, 46, 83, 91, 91),
    (3, 3, 2, 13, 44, 79, 89, 88),
    (1, 2, 3, 15, 43, 76, 84, 79),
    (2, 2, 6, 20, 48, 76, 79, 71),
    (2, 3, 7, 25, 53, 77, 75, 64),
    (3, 4, 13, 33, 58, 75, 64, 48),
    (8, 11, 22, 40, 59, 64, 55, 42),
    (12, 19, 28, 41, 51, 58, 50, 43),
    (17, 26, 36, 47, 55, 59, 54, 45),
    (20, 25, 33, 40, 45, 49, 47, 41),
)
OUTLINE = np.hstack((np.array(_LEFT), np.array(_LEFT)[:, -2::-1])).astype(np.float32) / 100
ROWS, COLUMNS = OUTLINE.shape
ABOVE, BELOW = 0.10, 0.02  # of the body's height, that belong to the outline
SIDE = 0.45  # metres to either side
# Where the middle of each row is, from head to feet, and that of each column, metres.
DOWN = np.asarray((np.arange(ROWS) + 0.5) / ROWS * (1 + ABOVE + BELOW) - ABOVE, dtype=np.float32)
ASIDE = np.asarray((np.arange(COLUMNS) - (COLUMNS - 1) / 2) * 2 * SIDE / COLUMNS, dtype=np.float32)
NEAREST = 0.5  # metres before the camera
DOUBT = 0.08  # a pixel is at least so likely not what the mask says
MOST = 0.98  # how surely others explain what is seen
FOUND = 10.0  # what a view must say for somebody, or it says nothing: who stands still is background


class Shown:
    """What the foreground of a view shows while some bodies (M, 3) are there."""

    def __init__(self, mask: Mask, camera: Camera, bodies: Floats) -> None:
        self._mask, self._camera = mask, camera
        self._scale = mask.shape[1] / camera.width
        self._cells, self._seen = _cells(camera, bodies, self._scale)
        corners = _corners(self._cells)
        self._low, self._high = corners.min(axis=1), corners.max(axis=1)

    def agreement(self, places: Floats, without: int | None = None) -> Floats:
        """How much likelier the foreground is with somebody at each place (N, 3) than with nobody, beside the
        bodies; `without` one of them, who is the one meant.

        The sum of logarithms, (N,); all 0 where the view shows none of the places.
        """
        at, seen = _cells(self._camera, places, self._scale)
        window = _window(at[seen], self._mask)
        if window is None:
            return np.zeros(len(places))
        left, top, right, bottom = window
        explained = self.explained(window, without)
        at -= np.array((left, top), np.float32)
        shown, theirs = _sampled(self._mask[top:bottom, left:right], at, -1.0), _sampled(explained, at, 0.0)
        total = _likelier(shown, np.clip(theirs, 0, MOST)) * seen
        return total if total.max() > FOUND else np.zeros(len(places))

    def explained(self, window: tuple[int, int, int, int], without: int | None = None) -> NDArray[np.float32]:
        """How surely each pixel of a window of the mask is one of the bodies."""
        left, top, right, bottom = window
        size = (right - left, bottom - top)
        beside = (self._high < (left, top)).any(axis=1) | (self._low > (right, bottom)).any(axis=1)
        rest = np.ones(size[::-1], np.float32)
        for body in np.flatnonzero(self._seen & ~beside).tolist():
            if body == without:
                continue
            cells = self._cells[body]
            first, aside, down = cells[0, 0], cells[0, 1] - cells[0, 0], cells[1, 0] - cells[0, 0]
            turn = np.column_stack((aside, down, first - (left, top))).astype(np.float64)
            rest *= 1 - cv2.warpAffine(OUTLINE, turn, size, flags=cv2.INTER_LINEAR)
        return np.asarray(1 - rest, dtype=np.float32)


def _likelier(shown: NDArray, theirs: NDArray) -> Floats:
    """(N,) of samples (N, rows, columns); what lies beyond the picture says nothing."""
    sure = np.clip(shown, DOUBT, 1 - DOUBT)
    with_it = 1 - (1 - OUTLINE) * (1 - theirs)
    ratio = (1 - sure + with_it * (2 * sure - 1)) / (1 - sure + theirs * (2 * sure - 1))
    total: Floats = (np.log(ratio) * (shown >= 0)).sum(axis=(1, 2), dtype=np.float64)
    return total


def _axes(camera: Camera, bodies: Floats) -> tuple[Floats, Floats, Floats, Flags]:
    """Of bodies (N, 3) the pixels of head and foot and what a metre aside is there, each (N, 2); whether they
    can be seen at all, (N,)."""
    xy = bodies[:, :2]
    away = xy - camera.centre[:2]
    away = away / np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-9)[:, None]
    aside = np.column_stack((-away[:, 1], away[:, 0])) / 4
    heights = (bodies[:, 2], np.zeros(len(xy)), bodies[:, 2] / 2, bodies[:, 2] / 2)
    places = (xy, xy, xy + aside, xy - aside)
    points = np.stack([np.column_stack(each) for each in zip(places, heights, strict=True)])
    depth = (points @ camera.rotation[2] + camera.tvec[2]) * camera.facing
    head, foot, right, left = project(camera, points.reshape(-1, 3)).reshape(4, -1, 2)
    finite = np.isfinite(head + foot + right + left).all(axis=1)
    return head, foot, (right - left) * 2, (depth > NEAREST).all(axis=0) & finite


def _cells(camera: Camera, bodies: Floats, scale: float) -> tuple[Cells, Flags]:
    head, foot, metre, seen = _axes(camera, bodies)
    top = ((np.where(seen[:, None], head, -1e4) + 0.5) * scale - 0.5).astype(np.float32)
    tall = (np.where(seen[:, None], foot - head, 0.0) * scale).astype(np.float32)
    wide = (np.where(seen[:, None], metre, 0.0) * scale).astype(np.float32)
    at = top[:, None] + tall[:, None] * DOWN[:, None]
    return at[:, :, None] + (wide[:, None] * ASIDE[:, None])[:, None], seen


def _corners(at: Cells) -> NDArray[np.float32]:
    """(N, 4, 2): cells lie on straight lines, so nothing is beyond."""
    corners: NDArray[np.float32] = at[:, [0, 0, -1, -1], [0, -1, 0, -1]]
    return corners


def _window(at: Cells, mask: Mask) -> tuple[int, int, int, int] | None:
    """Left, top, right and bottom of the part of the mask that matters; None: all is beyond."""
    if not len(at):
        return None
    corners = _corners(at).reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    left, top = (max(0, int(side)) for side in low)
    right, bottom = (min(int(side) + 2, most) for side, most in zip(high, mask.shape[::-1], strict=True))
    return (left, top, right, bottom) if left < right and top < bottom else None


def _sampled(image: NDArray, at: Cells, beyond: float) -> NDArray:
    """(N, rows, columns)."""
    flat = at.reshape(-1, COLUMNS, 2)
    parts = [
        cv2.remap(image, flat[start : start + 30_000], None, cv2.INTER_LINEAR, borderValue=beyond)  # type: ignore[call-overload]
        for start in range(0, len(flat), 30_000)  # no more rows than OpenCV can count
    ]
    return np.concatenate(parts).reshape(at.shape[:3])
