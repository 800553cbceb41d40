"""How a standing body looks in the foreground of a view: the person's template.

A template says of each part of the window around a body how surely it is not the background there. The
built-in one is drawn; from people whose places are known, one is fitted that also knows how these people,
their shadows and this background look.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Floats

Image = NDArray[np.float32]

ROWS = 20  # of a window, from head to feet
PITCH = 0.02  # width of its columns, as a share of the body's height
HALF = 16  # columns to either side of the middle
ALIKE = 0.6  # correlation with the drawn template below which places are not believed
FEWEST = 40  # windows from which a template is fitted
NOBODY = 0.12  # share of the background that is taken for foreground
SURELY = 0.9  # more than this a template never says: clothes may look like the ground
# Half the body's width in each row, as a share of its height.
DRAWN = np.interp(
    np.arange(ROWS),
    (0, 1, 2, 3, 4, 5, 8, 14, 17, 19),
    (0.05, 0.06, 0.06, 0.085, 0.12, 0.13, 0.13, 0.105, 0.12, 0.09),
)
SOFT = 0.025  # over which an outline is blurred: people differ


@dataclass(frozen=True)
class Template:
    chance: tuple[tuple[float, ...], ...]  # (ROWS, 2 · HALF), 0…1
    people: int = 0  # whom it was fitted to; 0: drawn
    windows: int = 0  # in so many views

    @property
    def nobody(self) -> float:
        """The chance beside the body: of the background to be taken for foreground."""
        return float(np.median(np.array(self.chance)[:, [0, 1, -2, -1]]))

    @property
    def body(self) -> Floats:
        """The chance that the body is there, (ROWS, 2 · HALF), whatever else may be."""
        chance = (np.array(self.chance) - self.nobody) / (1 - self.nobody)
        return np.clip(chance, 0.0, SURELY)


def drawn() -> Template:
    middle = PITCH * np.abs(np.arange(2 * HALF) + 0.5 - HALF)
    inside = 1 / (1 + np.exp((middle - DRAWN[:, None]) / SOFT))
    return Template(_rows(NOBODY + (0.7 - NOBODY) * inside))


def fitted(windows: Floats, people: int, usual: Template) -> Template | None:
    """The template of windows (N, ROWS, 2 · HALF) of masks with one body alone in each; None where they are
    too few, or look so little like anybody that their places cannot be right.

    Bodies walk to either side and are seen from all around, so left and right count as one.
    """
    if len(windows) < FEWEST:
        return None
    mean = windows.mean(axis=0)
    mean = np.clip((mean + mean[:, ::-1]) / 2, 0.0, SURELY)
    alike = float(np.corrcoef(mean.ravel(), np.array(usual.chance).ravel())[0, 1])
    return Template(_rows(mean), people, len(windows)) if alike >= ALIKE else None


def _rows(chance: Floats) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in np.round(chance, 3).tolist())


def sampled(image: Image, boxes: Floats, beside: int = 0) -> Floats:
    """The image in the windows of boxes (N, 4), (N, ROWS, 2 · (HALF + beside)); 0 outside the picture."""
    tall = boxes[:, 3] - boxes[:, 1]
    columns = PITCH * (np.arange(2 * (HALF + beside)) + 0.5 - HALF - beside)
    x = (boxes[:, 0] + boxes[:, 2])[:, None] / 2 + tall[:, None] * columns
    y = boxes[:, 1][:, None] + tall[:, None] * (np.arange(ROWS) + 0.5) / ROWS
    shape = (len(boxes), ROWS, len(columns))
    maps = [
        np.nan_to_num(np.broadcast_to(each, shape).reshape(-1, len(columns)) - 0.5, nan=-9.0)
        for each in (x[:, None, :], y[:, :, None])
    ]
    if not len(boxes):
        return np.zeros(shape)
    across, down = (each.astype(np.float32) for each in maps)
    return cv2.remap(image, across, down, cv2.INTER_LINEAR).reshape(shape).astype(np.float64)


def painted(template: Template, boxes: Floats, shape: tuple[int, int]) -> Image:
    """Log of the chance of each pixel that none of the bodies covers it, (h, w)."""
    free = np.zeros(shape, np.float32)
    log = np.log1p(-template.body).astype(np.float32)
    for box in boxes[np.isfinite(boxes).all(axis=1)]:
        tall, middle = box[3] - box[1], (box[0] + box[2]) / 2
        left, top = middle - HALF * PITCH * tall, box[1]
        x = np.arange(max(0, int(left)), min(shape[1], int(left + 2 * HALF * PITCH * tall) + 1))
        y = np.arange(max(0, int(top)), min(shape[0], int(box[3]) + 1))
        if len(x) and len(y):
            column = (x + 0.5 - left) / (PITCH * tall) - 0.5
            row = (y + 0.5 - top) / tall * ROWS - 0.5
            across, down = np.meshgrid(column.astype(np.float32), row.astype(np.float32))
            free[y[0] : y[-1] + 1, x[0] : x[-1] + 1] += cv2.remap(log, across, down, cv2.INTER_LINEAR)
    return free
