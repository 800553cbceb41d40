"""Two calibrations of a dataset beside each other: cameras, the ground, and boxes of what is annotated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import islice
from typing import Any

import numpy as np

from gtm_hit.calibration.comparing import CameraChange, Change, OtherCameras, compare_cameras
from gtm_hit.calibration.shift_map import Band, bands
from gtm_hit.models import Annotation, Dataset
from gtm_hit.ops.calibration import comparison as compared
from gtm_hit.ops.calibration import replacing
from gtm_hit.ops.calibration.sides import Side
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.jobs.progress import Progress, no_progress

MOST_PEOPLE = 20_000  # whose boxes are compared while somebody waits for a page
LOST = -1.0  # in the map as JSON has it


class NotComparable(OperationError, ValueError):
    """The two are not of the same cameras; says what differs."""


@dataclass(frozen=True)
class Difference:
    before: Side
    after: Side
    change: Change
    boxes: Sequence[dict[str, Any]]  # as a comparison's cameras, in the same order
    compared: int  # annotations whose boxes were compared
    annotations: int  # that there are

    def worst_bands(self) -> list[Band]:
        return bands(self.change.worst, self.change.cells)

    def bands(self, camera: int) -> list[Band]:
        return bands(self.change.cm[camera], self.change.cells)


def difference(
    dataset: Dataset,
    before: Side,
    after: Side,
    most: int | None = MOST_PEOPLE,
    progress: Progress = no_progress,
) -> Difference:
    """Nothing is written. Raises NotComparable.

    most : annotations whose boxes are compared, taken evenly from all there are; None: all of them
    """
    try:
        change = compare_cameras(before.cameras, after.cameras, dataset.grid)
    except OtherCameras as error:
        raise NotComparable(str(error)) from error
    total = Annotation.objects.filter(layer__dataset=dataset).count()
    every = 1 if most is None else max(1, -(-total // most))
    old, new = (compared.Calibration(each.cameras, dataset.grid, dataset.rule) for each in (before, after))
    counted = compared.Comparison(old, new)
    people = replacing.people_of(dataset, every)
    while block := list(islice(people, replacing.PEOPLE_TOGETHER)):
        counted.add(block)
        progress(replacing.COMPARING, min(counted.people, total), total)
    return Difference(before, after, change, counted.cameras(), counted.people, total)


def content(found: Difference) -> dict[str, Any]:
    """As JSON has it."""
    cells = found.change.cells
    pairs = zip(found.change.cameras, found.boxes, strict=True)
    return {
        "before": {"key": found.before.key, "words": found.before.words},
        "after": {"key": found.after.key, "words": found.after.words},
        "cameras": [_camera(change, boxes) for change, boxes in pairs],
        "annotations": found.annotations,
        "compared": found.compared,
        "ground": {
            "origin": [cells.grid.origin_x, cells.grid.origin_y],
            "cell_metres": cells.side,
            "columns": cells.columns,
            "rows": cells.rows,
            "worst_cm": _map(found.change.worst),
        },
    }


def _camera(change: CameraChange, boxes: dict[str, Any]) -> dict[str, Any]:
    return {
        "name": change.name,
        "centre_cm": change.moved,
        "centre_along_cm": list(change.centre),
        "rotation_degrees": change.turned,
        "before": _lens(change.before.matrix),
        "after": _lens(change.after.matrix),
        "distortion_px": change.distortion,
        "ground_cm": asdict(change.ground),
        "boxes": boxes,
    }


def _lens(matrix: np.ndarray) -> dict[str, float]:
    (fx, _, cx), (_, fy, cy), _ = matrix.tolist()
    return {"fx": fx, "fy": fy, "cx": cx, "cy": cy}


def _map(cm: np.ndarray) -> list[list[float | None]]:
    """Row by row along Y; None where no camera sees the ground, LOST where one does no more."""
    told = np.where(np.isposinf(cm), LOST, np.round(cm, 3))
    return [[None if np.isnan(value) else value for value in row] for row in told.tolist()]
