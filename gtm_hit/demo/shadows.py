"""What the sun does not reach: a map of the ground as the sun sees it.

All points on one sunbeam fall on the same place of the map, the one where the beam meets the ground; a point
is in shadow when the map knows something higher on its beam.
"""

from __future__ import annotations

import cv2
import numpy as np

from gtm_hit.demo.arrays import Floats
from gtm_hit.demo.scene import Area
from gtm_hit.demo.splat import Mesh, nearest_samples, sample_parts

NOTHING = -1.0
CLEARANCE = 0.045  # metres; what is less far below the top of its beam belongs to the same surface


def beam(points: Floats, sun: tuple[float, float, float]) -> Floats:
    """Where the sunbeams through points (…, 3) meet the ground, (…, 2) metres."""
    slope = np.array(sun[:2]) / sun[2]
    return points[..., :2] - points[..., 2:] * slope


class SunMap:
    """The height, metres, of the topmost surface on each sunbeam over an area."""

    def __init__(self, area: Area, cell: float, sun: tuple[float, float, float]) -> None:
        self.area, self.cell, self.sun = area, cell, sun
        shape = (round((area.north - area.south) / cell), round((area.east - area.west) / cell))
        self.top = np.full(shape, NOTHING, dtype=np.float32)

    def cells(self, ground: Floats) -> Floats:
        """Columns and rows (…, 2) of ground points (…, 2) in metres."""
        return ((ground - (self.area.west, self.area.south)) / self.cell).astype(np.float32)

    def add(self, mesh: Mesh) -> None:
        places = self.cells(beam(mesh.vertices, self.sun))
        first = np.floor(places.min(axis=0)).astype(int) - 2
        last = np.ceil(places.max(axis=0)).astype(int) + 2
        rows, columns = self.top.shape
        clipped = (max(first[1], 0), min(last[1], rows), max(first[0], 0), min(last[0], columns))
        if clipped[0] >= clipped[1] or clipped[2] >= clipped[3]:
            return
        placed = np.column_stack((places - first, -mesh.vertices[:, 2], np.ones(len(places))))
        shape = (int(last[1] - first[1]), int(last[0] - first[0]))
        samples = sample_parts(mesh, placed.astype(np.float32), shape)
        winner = nearest_samples(samples, shape)
        heights = np.where(winner >= 0, -samples[winner, 2], NOTHING).astype(np.float32)
        target = self.top[clipped[0] : clipped[1], clipped[2] : clipped[3]]
        source = heights[
            clipped[0] - first[1] : clipped[1] - first[1], clipped[2] - first[0] : clipped[3] - first[0]
        ]
        np.maximum(target, source, out=target)

    def add_polygon(self, ground: Floats, height: float) -> None:
        """A flat shadow whose outline (N, 2) on the ground is known."""
        outline = np.round(self.cells(ground)).astype(np.int32)
        shape = np.zeros(self.top.shape, dtype=np.uint8)
        cv2.fillPoly(shape, [outline], 1)
        np.maximum(self.top, np.where(shape > 0, height, NOTHING), out=self.top, casting="same_kind")

    def reaches(self, vertices: Floats) -> Floats:
        """The share of sunlight, 0…1, that reaches points (N, 3)."""
        places = self.cells(beam(vertices, self.sun))
        heights = vertices[:, 2].astype(np.float32) + np.float32(CLEARANCE)
        lit = np.zeros(len(places), dtype=np.float32)
        rows, columns = self.top.shape
        for dx, dy in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)):
            column = np.clip(places[:, 0].astype(np.int32) + dx, 0, columns - 1)
            row = np.clip(places[:, 1].astype(np.int32) + dy, 0, rows - 1)
            lit += self.top[row, column] < heights
        return lit / np.float32(5)

    def soft_mask(self, near: float, far: float) -> Floats:
        """How much of the sun's disc is hidden, 0…1; edges are `near` metres soft at the ground and `far`
        at 2 m height, because the sun is not a point."""
        hidden = (self.top > 0).astype(np.float32)
        sharp = cv2.GaussianBlur(hidden, (0, 0), near / self.cell)
        soft = cv2.GaussianBlur(hidden, (0, 0), far / self.cell)
        height = cv2.GaussianBlur(np.maximum(self.top, 0), (0, 0), far / self.cell)
        share = np.clip(height / np.maximum(soft, 0.05) / 2, 0, 1)
        return sharp + (soft - sharp) * share
