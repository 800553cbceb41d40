"""The rectangle rules once more, slowly: OpenCV projects every corner, the rule's words follow one by one."""

from __future__ import annotations

import cv2
import numpy as np

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule
from gtm_hit.geometry.grid import Grid


def reference_rectangles(
    camera: Camera, grid: Grid, cylinder: Cylinder, rule: FootRule, positions: np.ndarray
) -> np.ndarray:
    """Boxes (N, 4) int64, all 0 where not visible."""
    precision = np.float32 if rule is FootRule.CORNERS else np.float64
    centres = _centres(grid, positions, precision)
    corners = _corners(centres, precision(cylinder.radius), precision(cylinder.height))
    pixels = _project(camera, corners.reshape(-1, 3)).reshape(-1, 8, 2)
    assert pixels.dtype == precision
    depths = (corners.astype(np.float64) @ camera.rotation.T + camera.tvec)[..., 2]
    feet = np.column_stack((centres, np.zeros(len(centres), precision)))
    heads = np.column_stack((centres, np.full(len(centres), precision(cylinder.height))))
    foot_v, head_v = (_project(camera, axis.astype(np.float64))[:, 1] for axis in (feet, heads))
    in_front = ((depths > 0).all(axis=1) | (depths < 0).all(axis=1)) & (head_v < foot_v)
    boxes = np.zeros((len(positions), 4), np.int64)
    for index in np.flatnonzero(in_front):
        if rule is FootRule.CORNERS:
            box = _corners_box(pixels[index], camera.width)
        else:
            box = _centre_box(pixels[index], float(foot_v[index]), camera.width, camera.height)
        if box is not None and _acceptable(box, camera):
            boxes[index] = [int(side) for side in box]
    return boxes


def _centres(grid: Grid, positions: np.ndarray, precision: type) -> np.ndarray:
    rows, columns = np.divmod(positions, grid.columns)
    width, length = (precision(size) for size in grid.extent)
    x = precision(grid.origin_x) + columns.astype(precision) * width / precision(grid.columns)
    y = precision(grid.origin_y) + rows.astype(precision) * length / precision(grid.rows)
    return np.column_stack((x, y))


def _corners(centres: np.ndarray, radius: float, height: float) -> np.ndarray:
    signs = [(sx, sy, up) for sx in (-1, 1) for sy in (-1, 1) for up in (0, 1)]
    corners = np.zeros((len(centres), 8, 3), centres.dtype)
    for number, (sx, sy, up) in enumerate(signs):
        corners[:, number, 0] = centres[:, 0] + sx * radius
        corners[:, number, 1] = centres[:, 1] + sy * radius
        corners[:, number, 2] = up * height
    return corners


def _project(camera: Camera, points: np.ndarray) -> np.ndarray:
    points = np.ascontiguousarray(points)
    pixels, _ = cv2.projectPoints(points, camera.rvec, camera.tvec, camera.matrix, camera.distortion)
    return pixels.reshape(-1, 2)


def _corners_box(pixels: np.ndarray, width: int) -> tuple | None:
    points = [(int(u), int(v)) for u, v in pixels]  # int() truncates toward zero
    xs, ys = zip(*points, strict=True)
    box = (min(xs), min(ys), max(xs), sum(sorted(ys)[-4:]) // 4)
    return None if box[2] - box[0] > width // 3 else box


def _centre_box(pixels: np.ndarray, foot: float, width: int, height: int) -> tuple | None:
    box = (*pixels.min(axis=0).tolist(), float(pixels[:, 0].max()), foot)
    return None if box[2] - box[0] > width / 3 or box[3] - box[1] > height / 3 else box


def _acceptable(box: tuple, camera: Camera) -> bool:
    xmin, ymin, xmax, ymax = box
    outside = xmin >= camera.width - 2 or ymin >= camera.height - 2 or xmax <= 1 or ymax <= 1
    storable = all(-32768 <= int(side) <= 32767 for side in box)
    return storable and not outside and not xmax - xmin > ymax - ymin
