"""Cells of the ground that at least two cameras see, and where somebody standing there is in each picture."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.sync.motion import Boxes, small_size
from gtm_hit.calibration.sync.series import SyncError
from gtm_hit.geometry.camera import Camera, Floats, back_project, project
from gtm_hit.geometry.grid import Grid

TALL = 1.7  # metres
SLIM = 0.3  # width of somebody relative to the height
STEP_AHEAD = 0.3  # metres; what is lowest in a picture is the foot nearest to the camera
AROUND = 25.0  # metres beyond the cameras that are looked at
FINEST = 0.25  # metres between two cells
MOST_CELLS = 6000
MOST_POSITIONS = 120_000
SMALLEST = 0.08  # of the picture's height; who is smaller tells little


def ground_meters(cameras: Sequence[Camera]) -> list[Boxes]:
    """By camera, as its pictures were taken. Raises SyncError where no two cameras see the same ground."""
    grid = _grid(cameras)
    ground = grid.metres(np.arange(grid.count))
    seen = np.stack([_boxes(camera, ground) for camera in cameras])  # (cameras, cells, 4)
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


def _boxes(camera: Camera, ground: Floats) -> NDArray[np.int64]:
    """(cells, 4) in the small picture; zeros where nobody would be seen whole or large enough."""
    towards = camera.centre[:2] - ground
    away = np.linalg.norm(towards, axis=1, keepdims=True)
    standing = ground + towards / np.maximum(away, 1e-6) * STEP_AHEAD
    feet, head = (project(camera, np.column_stack((standing, np.full(len(ground), z)))) for z in (0.0, TALL))
    tall = feet[:, 1] - head[:, 1]
    half = tall * SLIM / 2
    with np.errstate(invalid="ignore"):
        seen = np.linalg.norm(back_project(camera, feet) - standing, axis=1) < 0.05  # no lens folded back
        seen &= (tall >= SMALLEST * camera.height) & (feet[:, 1] < camera.height)
        seen &= (feet[:, 0] >= half) & (feet[:, 0] < camera.width - half)
    boxes = np.column_stack((feet[:, 0] - half, head[:, 1], feet[:, 0] + half, feet[:, 1]))
    size = small_size(camera.width, camera.height)
    small = np.round(np.where(seen[:, None], boxes, 0) * (size[0] / camera.width)).astype(np.int64)
    return np.clip(small, 0, [*size, *size])
