"""A layer's frames, read in chunks: memory and queries stay bounded however long the layer is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Annotation, Dataset, Layer, LayerFrame
from gtm_hit.ops.gold.withdraw import without_faults
from gtm_hit.ops.ground.rectangles import annotation_rectangles

FRAMES_PER_CHUNK = 250
COLUMNS = ("person", "position", "height", "radius", "state", "origin")
METRE_DIGITS = 6  # micrometres: enough to hide the last bits of floating point, not a position

Ids = NDArray[np.int64]
Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Chunk:
    """Consecutive frames of a layer with everybody in them, by frame number and person."""

    numbers: list[int]  # of all frames, also of those with nobody
    frames: Ids  # (N,) frame number of each annotation
    persons: Ids  # (N,)
    positions: Ids  # (N,)
    xy: Floats  # (N, 2) metres
    heights: Floats  # (N,) metres, NaN for the dataset's cylinder
    radii: Floats  # (N,) likewise
    states: list[str]
    origins: list[str]
    boxes: NDArray[np.int16]  # (N, C, 4) pixels
    visible: NDArray[np.bool_]  # (N, C)

    def by_frame(self) -> Iterator[tuple[int, slice]]:
        """Every frame's number, and which rows are in it."""
        starts = np.searchsorted(self.frames, self.numbers, side="left").tolist()
        ends = np.searchsorted(self.frames, self.numbers, side="right").tolist()
        for number, start, end in zip(self.numbers, starts, ends, strict=True):
            yield number, slice(start, end)


class FrameReader:
    """Frames of one layer that were saved at least once, by number."""

    def __init__(self, layer: Layer, dataset: Dataset, cameras: list[Camera], table: RectangleTable) -> None:
        self.layer = layer
        self.dataset = dataset
        self.cameras = cameras
        self.table = table
        # Errors that were planted on purpose never leave the house.
        self.honest = without_faults(layer)

    def count(self) -> int:
        return self._saved().count()

    def __iter__(self) -> Iterator[Chunk]:
        after = -1
        while frames := list(
            self._saved()
            .filter(frame__number__gt=after)
            .order_by("frame__number")
            .values_list("frame_id", "frame__number")[:FRAMES_PER_CHUNK]
        ):
            yield self._chunk(dict(frames))
            after = frames[-1][1]

    def _saved(self) -> Any:
        return LayerFrame.objects.filter(layer=self.layer, revision__gte=1)

    def _chunk(self, numbers: dict[int, int]) -> Chunk:
        rows = list(
            Annotation.objects.filter(layer=self.layer, frame__in=list(numbers))
            .order_by()
            .values_list("frame_id", *COLUMNS)
        )
        rows = [row for row in rows if row[0] not in self.honest] + [
            (frame, *(getattr(row, name) for name in COLUMNS))
            for frame in numbers.keys() & self.honest.keys()
            for row in self.honest[frame]
        ]
        columns: list[Any] = list(zip(*rows, strict=True)) or [()] * 7
        frames = np.fromiter(map(numbers.__getitem__, columns[0]), np.int64, len(rows))
        persons = np.array(columns[1], dtype=np.int64)
        order = np.lexsort((persons, frames))
        frames, persons, positions = frames[order], persons[order], np.array(columns[2], np.int64)[order]
        # None becomes NaN: the dataset's own cylinder.
        heights, radii = (np.array(column, dtype=np.float64)[order] for column in columns[3:5])
        states, origins = ([column[row] for row in order.tolist()] for column in columns[5:7])
        boxes, visible = annotation_rectangles(
            self.dataset, self.cameras, self.table, positions, heights, radii
        )
        return Chunk(
            numbers=sorted(numbers.values()),
            frames=frames,
            persons=persons,
            positions=positions,
            xy=self.dataset.grid.metres(positions).round(METRE_DIGITS),
            heights=heights,
            radii=radii,
            states=states,
            origins=origins,
            boxes=boxes,
            visible=visible,
        )
