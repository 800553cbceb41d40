"""Detections projected and clustered, as the papers' first baseline: feet on the ground, near ones joined."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage

from gtm_hit.geometry.camera import Camera, Floats, back_project
from gtm_hit.vision.boxes import Box, as_array


@dataclass(frozen=True)
class ProjectedSettings:
    lowest: float = 0.5  # detector scores below are not looked at
    apart: float = 0.6  # metres, average of the pairs, up to which feet are one person's
    views: int = 1  # in how many views a person must be boxed; the papers keep single ones


@dataclass(frozen=True, eq=False)
class Cluster:
    xy: Floats  # (2,) metres
    score: float
    boxes: dict[str, int]


def projected(
    boxes: Mapping[str, Sequence[Box]], cameras: Mapping[str, Camera], settings: ProjectedSettings
) -> list[Cluster]:
    feet, owners = _feet(boxes, cameras, settings.lowest)
    if not len(feet):
        return []
    joined = linkage(feet, "average") if len(feet) > 1 else np.zeros((0, 4))
    labels = fcluster(joined, settings.apart, "distance") if len(feet) > 1 else np.ones(1, int)
    clusters = []
    for label in np.unique(labels):
        rows = np.flatnonzero(labels == label)
        chosen = {owners[row][0]: owners[row][1] for row in rows}
        scores = [boxes[owners[row][0]][owners[row][1]].score for row in rows]
        if len(chosen) >= settings.views:
            clusters.append(Cluster(feet[rows].mean(axis=0), float(np.mean(scores)), chosen))
    return sorted(clusters, key=lambda each: -each.score)


def _feet(
    boxes: Mapping[str, Sequence[Box]], cameras: Mapping[str, Camera], lowest: float
) -> tuple[Floats, list[tuple[str, int]]]:
    feet, owners = [np.zeros((0, 2))], []
    for name, found in boxes.items():
        array = as_array(list(found))
        ground = back_project(cameras[name], np.column_stack((array[:, [0, 2]].mean(axis=1), array[:, 3])))
        rows = np.flatnonzero((array[:, 4] >= lowest) & np.isfinite(ground).all(axis=1))
        feet.append(ground[rows])
        owners += [(name, int(row)) for row in rows]
    return np.concatenate(feet), owners
