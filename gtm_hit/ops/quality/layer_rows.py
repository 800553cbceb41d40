"""A layer as arrays, in two queries and a few dozen bytes per annotation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime

import numpy as np
from django.db.models import Count, Max, QuerySet, Sum
from django.db.models.functions import Coalesce

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.annotations import Annotations, Floats, Ids
from gtm_hit.models import Annotation, Dataset, Layer, LayerFrame
from gtm_hit.ops.errors import OperationError

ROWS_AT_ONCE = 10_000
SAVED = np.dtype([("layer", "i8"), ("frame", "i8"), ("number", "i8")])
PLACED = np.dtype(
    [(name, "i8") for name in ("layer", "frame", "person", "position")] + [("height", "f8"), ("radius", "f8")]
)


class QualityError(OperationError, ValueError):
    """Layers that cannot be measured; says why."""


@dataclass(frozen=True)
class LayerState:
    """Changes with every save of the layer: what was measured in one state holds as long as it lasts."""

    layer: int
    frames: int
    revisions: int
    changed_at: datetime | None


@dataclass(frozen=True, eq=False)
class LayerRows:
    """One row per annotation, by frame and person; NaN where the dataset's cylinder is meant."""

    numbers: Ids  # (F,) frames somebody saved, ascending, also those where nobody is
    frames: Ids  # (N,) frame numbers
    persons: Ids
    positions: Ids
    heights: Floats  # metres
    radii: Floats  # metres

    def __len__(self) -> int:
        return len(self.frames)

    def annotations(self, grid: Grid) -> Annotations:
        return Annotations(self.frames, grid.metres(self.positions), self.persons)

    def within(self, numbers: Ids) -> LayerRows:
        """The same rows of these frames only."""
        rows = np.isin(self.frames, numbers)
        return LayerRows(
            self.numbers[np.isin(self.numbers, numbers)],
            self.frames[rows],
            self.persons[rows],
            self.positions[rows],
            self.heights[rows],
            self.radii[rows],
        )


def state_of(layer: Layer) -> LayerState:
    saved = LayerFrame.objects.filter(layer=layer).aggregate(
        frames=Count("pk"), revisions=Sum("revision"), changed_at=Max("changed_at")
    )
    return LayerState(layer.pk, saved["frames"], saved["revisions"] or 0, saved["changed_at"])


def frame_numbers(dataset: Dataset) -> Ids:
    """(F,) ascending."""
    numbers = dataset.frames.order_by("number").values_list("number", flat=True)
    return np.fromiter(numbers.iterator(ROWS_AT_ONCE), np.int64)


def saved_numbers(layer: Layer) -> Ids:
    """(F,) ascending, of the frames somebody saved, also those where nobody is."""
    numbers = _saved([layer.pk]).order_by("frame__number").values_list("frame__number", flat=True)
    return np.fromiter(numbers.iterator(ROWS_AT_ONCE), np.int64)


def read_layer(layer: Layer) -> LayerRows:
    return read_layers([layer])[layer.pk]


def read_layers(layers: Iterable[Layer], span: tuple[int, int] | None = None) -> dict[int, LayerRows]:
    """By the layers' ids; two queries, however many layers. `span`: first and last frame number to read."""
    ids = [layer.pk for layer in layers]
    within = {} if span is None else {"frame__number__range": span}
    rows_saved = _saved(ids).filter(**within).order_by().values_list("layer_id", "frame_id", "frame__number")
    saved = np.fromiter(rows_saved.iterator(ROWS_AT_ONCE), SAVED)
    frame_ids, first = np.unique(saved["frame"], return_index=True)
    placed = np.fromiter(_placed(ids, within), PLACED)
    # Annotations are only ever written together with their frame's row.
    placed = placed[np.isin(placed["frame"], frame_ids)]
    numbers = saved["number"][first[np.searchsorted(frame_ids, placed["frame"])]]
    return {pk: _of_layer(pk, saved, placed, numbers) for pk in ids}


def _saved(layers: list[int]) -> QuerySet[LayerFrame]:
    return LayerFrame.objects.filter(layer__in=layers, revision__gte=1)


def _placed(layers: list[int], within: dict[str, tuple[int, int]]) -> Iterator[tuple[float, ...]]:
    """Sizes a row does not have come as 0, which no size can be."""
    return (
        Annotation.objects.filter(layer__in=layers, **within)
        .order_by()
        .values_list(
            "layer_id", "frame_id", "person", "position", Coalesce("height", 0.0), Coalesce("radius", 0.0)
        )
        .iterator(ROWS_AT_ONCE)
    )


def _of_layer(layer: int, saved: np.ndarray, placed: np.ndarray, numbers: Ids) -> LayerRows:
    mine = np.flatnonzero(placed["layer"] == layer)
    order = mine[np.lexsort((placed["person"][mine], numbers[mine]))]
    heights, radii = placed["height"][order], placed["radius"][order]
    heights[heights == 0.0] = np.nan
    radii[radii == 0.0] = np.nan
    return LayerRows(
        np.unique(saved["number"][saved["layer"] == layer]),
        numbers[order],
        placed["person"][order],
        placed["position"][order],
        heights,
        radii,
    )
