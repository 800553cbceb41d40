"""How far projections are from clicks, how that changes with every number, and what it costs."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Seen:
    """All observations, of free and measured points, sorted by camera."""

    cameras: Ints  # (N,)
    points: Ints  # (N,) in the list of free points followed by the measured ones
    pixels: Floats  # (N, 2)
    weights: Floats  # (N,)

    def of(self, camera: int) -> slice:
        first, last = np.searchsorted(self.cameras, (camera, camera + 1))
        return slice(int(first), int(last))

    def where(self, kept: Flags) -> Seen:
        return Seen(self.cameras[kept], self.points[kept], self.pixels[kept], self.weights[kept])


def projections(rows: Floats, points: Floats, seen: Seen) -> Floats:
    """(N, 2) pixels where each observation should be."""
    found = np.empty((len(seen.pixels), 2))
    for number, row in enumerate(rows):
        part = seen.of(number)
        if part.start < part.stop:
            found[part] = _projected(row, points[seen.points[part]])[0]
    return found


def misses(rows: Floats, points: Floats, seen: Seen) -> Floats:
    """(N, 2) projection minus click, pixels."""
    return projections(rows, points, seen) - seen.pixels


def depths(rows: Floats, points: Floats, seen: Seen) -> Floats:
    """(N,) metres in front of its camera that each observed point lies; negative behind it."""
    found = np.empty(len(seen.pixels))
    for number, row in enumerate(rows):
        part = seen.of(number)
        found[part] = points[seen.points[part]] @ cv2.Rodrigues(row[:3])[0][2] + row[5]
    return found


def derivatives(rows: Floats, points: Floats, seen: Seen) -> tuple[Floats, Floats, Floats]:
    """Misses (N, 2), and how they change with the camera's numbers (N, 2, K) and with the point (N, 2, 3)."""
    count, width = len(seen.pixels), rows.shape[1]
    found = np.empty((count, 2))
    by_camera, by_point = np.empty((count, 2, width)), np.empty((count, 2, 3))
    for number, row in enumerate(rows):
        part = seen.of(number)
        if part.start == part.stop:
            continue
        found[part], jacobian = _projected(row, points[seen.points[part]])
        by_camera[part] = jacobian.reshape(-1, 2, jacobian.shape[1])[..., :width]
        # A world point moves a projection as the translation does, turned by the rotation.
        by_point[part] = by_camera[part][..., 3:6] @ cv2.Rodrigues(row[:3])[0]
    return found - seen.pixels, by_camera, by_point


def huber(missed: Floats, turn: float) -> tuple[Floats, Floats]:
    """Of misses (N, 2): half the robust square, (N,), and how much each counts in a step.

    Beyond `turn` pixels a miss costs in proportion to its length, not to its square.
    """
    lengths = np.hypot(missed[:, 0], missed[:, 1])
    far = lengths > turn
    halves = 0.5 * np.where(far, 2 * turn * lengths - turn * turn, lengths * lengths)
    return halves, np.where(far, turn / np.maximum(lengths, turn), 1.0)


def _projected(row: Floats, points: Floats) -> tuple[Floats, Floats]:
    matrix = np.array([[row[6], 0.0, row[8]], [0.0, row[7], row[9]], [0.0, 0.0, 1.0]])
    pixels, jacobian = cv2.projectPoints(points.reshape(-1, 1, 3), row[:3], row[3:6], matrix, row[10:])
    return np.asarray(pixels, dtype=np.float64).reshape(-1, 2), np.asarray(jacobian, dtype=np.float64)
