"""Cells of the ground that at least two cameras see, and where somebody standing there is in each picture."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.sync.motion import Boxes, small_size
from gtm_hit.calibration.sync.series import SyncError
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid

SOMEBODY = Cylinder(0.25, 1.7)  # metres
AROUND = 25.0  # metres beyond the cameras that are looked at
FINEST = 0.25  # metres between two cells
MOST_CELLS = 6000
MOST_POSITIONS = 120_000
SMALLEST = 0.08  # of the picture's height; who is smaller tells little


def ground_meters(cameras: Sequence[Camera]) -> list[Boxes]:
    """By camera, as its pictures were taken. Raises SyncError where no two cameras see the same ground."""
    grid = _grid(cameras)
    seen = np.stack([_boxes(camera, grid) for camera in cameras])  # (cameras, cells, 4)
    shared = np.flatnonzero((seen[..., 2] > seen[..., 0]).sum(axis=0) >= 2)
    if shared.size == 0:
        raise SyncError("no two cameras see the same ground")
    chosen = shared[:: math.ceil(shared.size / MOST_CELLS)]
    return [
        Boxes(boxes, small_size(camera.width, camera.height))
        for camera, boxes in zip(cameras, seen[:, chosen], strict=True)
    ]


def _grid(cameras: Sequence[Camera]) -> Grid:
    centres = np.array([camera.centre[:2] for camera in cameras])
    low, high = centres.min(axis=0) - AROUND, centres.max(axis=0) + AROUND
    width, length = high - low
    step = max(FINEST, math.sqrt(width * length / MOST_POSITIONS))
    return Grid(math.ceil(width / step), math.ceil(length / step), step, float(low[0]), float(low[1]))


def _boxes(camera: Camera, grid: Grid) -> NDArray[np.int64]:
    """(cells, 4) in the small picture; zeros where nobody would be seen whole or large enough."""
    boxes, visible = rectangles(camera, grid, SOMEBODY, FootRule.CENTRE, np.arange(grid.count))
    tall = boxes[:, 3] - boxes[:, 1] >= SMALLEST * camera.height
    inside = (boxes[:, 3] < camera.height) & (boxes[:, 0] >= 0) & (boxes[:, 2] < camera.width)
    size = small_size(camera.width, camera.height)
    small = np.floor(boxes * (size[0] / camera.width)).astype(np.int64)
    small[:, 2:] += 1
    small = np.clip(small, 0, [*size, *size])
    small[~(visible & tall & inside)] = 0
    return small
