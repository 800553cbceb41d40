"""A layer's frames as JSON, read in chunks: memory and queries stay bounded however long the layer is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter
from typing import Any

import numpy as np

from gtm_hit.formats.wildtrack_json import PersonPosition, frame_json
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Annotation, Dataset, Layer, LayerFrame
from gtm_hit.ops.rectangles import annotation_rectangles

FRAMES_PER_CHUNK = 250
METRE_DIGITS = 6  # micrometres: enough to hide the last bits of floating point, not a position

# frame id, person, position, height, radius, state, origin
Row = tuple[int, int, int, float | None, float | None, str, str]


@dataclass(frozen=True)
class ExportedFrame:
    number: int
    persons: list[int]
    not_validated: int
    json: bytes


class FrameReader:
    """Frames of one layer that were saved at least once, by number."""

    def __init__(self, layer: Layer, dataset: Dataset, cameras: list[Camera], table: RectangleTable) -> None:
        self.layer = layer
        self.dataset = dataset
        self.cameras = cameras
        self.table = table

    def count(self) -> int:
        return self._saved().count()

    def __iter__(self) -> Iterator[ExportedFrame]:
        after = -1
        while frames := list(
            self._saved()
            .filter(frame__number__gt=after)
            .order_by("frame__number")
            .values_list("frame_id", "frame__number")[:FRAMES_PER_CHUNK]
        ):
            yield from self._chunk(frames)
            after = frames[-1][1]

    def _saved(self) -> Any:
        return LayerFrame.objects.filter(layer=self.layer, revision__gte=1)

    def _chunk(self, frames: list[tuple[int, int]]) -> Iterator[ExportedFrame]:
        rows: list[Row] = list(
            Annotation.objects.filter(layer=self.layer, frame__in=[frame for frame, _ in frames])
            .order_by("frame_id", "person")
            .values_list("frame_id", "person", "position", "height", "radius", "state", "origin")
        )
        placed = zip(rows, self._people(rows), strict=True)
        people = {frame: list(together) for frame, together in groupby(placed, key=lambda pair: pair[0][0])}
        for frame, number in frames:
            present = people.get(frame, [])
            yield ExportedFrame(
                number,
                [row[1] for row, _ in present],
                sum(row[5] != Annotation.State.VALIDATED for row, _ in present),
                frame_json(map(itemgetter(1), present), len(self.cameras)),
            )

    def _people(self, rows: list[Row]) -> Iterator[PersonPosition]:
        positions = np.array([row[2] for row in rows], dtype=np.int64)
        # None becomes NaN: the dataset's own cylinder.
        heights, radii = (np.array([row[column] for row in rows], dtype=np.float64) for column in (3, 4))
        boxes, visible = annotation_rectangles(
            self.dataset, self.cameras, self.table, positions, heights, radii
        )
        shown = np.where(visible[:, :, None], boxes, np.int16(-1))
        metres = self.dataset.grid.metres(positions).round(METRE_DIGITS).tolist()
        for row, box, (x, y) in zip(rows, shown, metres, strict=True):
            yield PersonPosition(row[1], row[2], box, extra(row, x, y))


def extra(row: Row, x: float, y: float) -> dict[str, Any]:
    """What follows the published keys of a person: metres, an own size, where the position came from."""
    _, _, _, height, radius, state, origin = row
    keys: dict[str, Any] = {"x": x, "y": y}
    if height is not None:
        keys["height"] = height
    if radius is not None:
        keys["radius"] = radius
    keys["origin"] = origin
    if state != Annotation.State.VALIDATED:
        keys["validated"] = False
    return keys
