"""Where the upper part of a body is in the foreground of a view: sharper than any detector's box.

Feet are left out, for shadows start there. Who overlaps with somebody else in a view is not measured in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Floats

Mask = NDArray[np.float32]


@dataclass(frozen=True)
class SilhouetteSettings:
    top: float = 0.0  # of the body's height, from the head
    bottom: float = 0.75
    reach: float = 0.20  # to either side, as a share of the height
    core: float = 0.07  # to either side: this must be foreground
    filled: float = 0.45  # share of the core that must be
    crowded: float = 0.30  # share of the window that others may cover
    smallest: float = 12.0  # pixels of the reduced picture a body must be tall
    rounds: int = 3


def middles(
    foreground: Mask, scale: float, whole: Floats, share: Floats, settings: SilhouetteSettings
) -> tuple[Floats, Floats]:
    """Middle of each body (N,), pixels of the calibrated picture, NaN where it cannot be told; and how much
    of the body's upper half is foreground (N,), NaN where nothing is known.

    whole : (N, 4) the boxes expected, pixels of the calibrated picture
    """
    surely = np.clip(2 * foreground.astype(np.float32) - 1, 0, 1)
    boxes = whole * scale
    middle, seen = np.full(len(boxes), np.nan), np.full(len(boxes), np.nan)
    for body in np.flatnonzero((share > 0.9) & (boxes[:, 3] - boxes[:, 1] >= settings.smallest)):
        middle[body], seen[body] = _middle(surely, boxes, int(body), settings)
    return middle / scale, seen


def _middle(surely: Mask, boxes: Floats, body: int, s: SilhouetteSettings) -> tuple[float, float]:
    x1, y1, x2, y2 = boxes[body]
    tall, centre = y2 - y1, (x1 + x2) / 2
    top, bottom = (max(0, round(y1 + share * tall)) for share in (s.top, s.bottom))
    seen = _filled(surely[top:bottom], centre, s.core * tall)
    others = _crowd(boxes, body, top, bottom)
    if not seen >= s.filled:
        return np.nan, seen
    for _ in range(s.rounds):
        left, right = centre - s.reach * tall, centre + s.reach * tall
        if left < 0 or right > surely.shape[1] or _covered(others, left, right) > s.crowded:
            return np.nan, seen
        columns = np.arange(int(left), int(right) + 1)
        columns = columns[columns < surely.shape[1]]
        # Columns at the window's ends count by the part of them inside: else the centre sticks to pixels.
        inside = np.clip(np.minimum(columns + 1 - left, right - columns), 0, 1)
        weight = surely[top:bottom, columns].sum(axis=0) * inside * ~_taken(others, columns)
        if weight.sum() <= 0:
            return np.nan, seen
        centre = float((weight * (columns + 0.5)).sum() / weight.sum())
    return centre - 0.5, seen


def _filled(rows: Mask, centre: float, reach: float) -> float:
    part = rows[:, max(0, round(centre - reach)) : max(0, round(centre + reach)) + 1]
    return float(part.mean()) if part.size else float("nan")


def _crowd(boxes: Floats, body: int, top: float, bottom: float) -> Floats:
    """Left and right of everybody else between two rows, (M, 2)."""
    there = (boxes[:, 1] < bottom) & (boxes[:, 3] > top) & np.isfinite(boxes[:, 0])
    there[body] = False
    return boxes[there][:, [0, 2]]


def _covered(others: Floats, left: float, right: float) -> float:
    common = np.minimum(others[:, 1], right) - np.maximum(others[:, 0], left)
    return float(np.maximum(common, 0).sum() / (right - left))


def _taken(others: Floats, columns: NDArray[np.int64]) -> NDArray[np.bool_]:
    taken = (columns[:, None] >= others[None, :, 0] - 1) & (columns[:, None] <= others[None, :, 1])
    return np.asarray(taken.any(axis=1))
