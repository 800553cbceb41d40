"""Rectangles of annotations: from the table, or computed for people with a size of their own."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, rectangles
from gtm_hit.geometry.table import Boxes, RectangleTable
from gtm_hit.models import Dataset


def annotation_rectangles(
    dataset: Dataset,
    cameras: list[Camera],
    table: RectangleTable,
    positions: ArrayLike,
    heights: ArrayLike,
    radii: ArrayLike,
) -> tuple[Boxes, NDArray[np.bool_]]:
    """Boxes (N, cameras, 4) and visibility (N, cameras) of annotations at positions (N,).

    `heights` and `radii` (N,) are metres; NaN means the dataset's cylinder.
    """
    ids = np.asarray(positions, dtype=np.int64)
    boxes, visible = table.rectangles(ids)
    sizes = np.column_stack((np.asarray(radii, dtype=np.float64), np.asarray(heights, dtype=np.float64)))
    usual = dataset.cylinder
    own = ~np.isnan(sizes).all(axis=1)
    sizes = np.where(np.isnan(sizes), (usual.radius, usual.height), sizes)
    different, which = np.unique(sizes[own], axis=0, return_inverse=True)
    rows = np.flatnonzero(own)
    for index, (radius, height) in enumerate(different.tolist()):
        alike = rows[which.ravel() == index]
        for number, camera in enumerate(cameras):
            boxes[alike, number], visible[alike, number] = rectangles(
                camera, dataset.grid, Cylinder(radius, height), dataset.rule, ids[alike]
            )
    return boxes, visible
