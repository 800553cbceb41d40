"""The boxes that standing bodies fill in a view, for any places at once.

Unlike the rectangles of annotations, which follow published rules, these are what a detector is expected to
draw: round bodies, no matter how large in the picture, cut at its border.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, Floats, project

NEAREST = 0.5  # metres before the camera; nearer than that nobody is all in the picture


@dataclass(frozen=True, eq=False)
class BodyBoxes:
    whole: Floats  # (N, 4) pixels: x1 y1 x2 y2, also beyond the picture; NaN where nobody can be seen
    boxes: Floats  # (N, 4) cut at the picture's border
    share: Floats  # (N,) of the box in the picture, 0…1

    def rows(self, rows: NDArray[np.int64]) -> BodyBoxes:
        return BodyBoxes(self.whole[rows], self.boxes[rows], self.share[rows])


def body_boxes(camera: Camera, xy: Floats, radius: Floats | float, height: Floats | float) -> BodyBoxes:
    """Boxes of bodies at xy (N, 2), metres; radius and height (N,) or one for all."""
    points = _outline(camera, xy, radius, height)  # (8, N, 3)
    depth = (points @ camera.rotation[2] + camera.tvec[2]) * camera.facing
    pixels = project(camera, points.reshape(-1, 3)).reshape(*points.shape[:2], 2)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    seen = (depth > NEAREST).all(axis=0) & np.isfinite(low).all(axis=1) & np.isfinite(high).all(axis=1)
    whole = np.where(seen[:, None], np.concatenate((low, high), axis=1), np.nan)
    border = (camera.width, camera.height)
    cut = np.concatenate((np.clip(low, 0, border), np.clip(high, 0, border)), axis=1)
    cut = np.where(seen[:, None], cut, 0.0)
    area, left = _area(whole), _area(cut)
    share = np.divide(left, area, out=np.zeros(len(left)), where=seen & (area > 0))
    return BodyBoxes(whole, cut, share)


def _outline(camera: Camera, xy: Floats, radius: Floats | float, height: Floats | float) -> Floats:
    """Four points around the foot and four around the head, as seen from the camera: (8, N, 3)."""
    away = xy - camera.centre[:2]
    away = away / np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-9)[:, None]
    aside = np.column_stack((-away[:, 1], away[:, 0]))
    reach = np.broadcast_to(np.asarray(radius, dtype=np.float64), len(xy))[:, None]
    points = np.zeros((8, len(xy), 3))
    for place, offset in enumerate((away, -away, aside, -aside)):
        points[place, :, :2] = points[place + 4, :, :2] = xy + reach * offset
    points[4:, :, 2] = height
    return points


def _area(boxes: Floats) -> Floats:
    area: Floats = (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])
    return area
