"""What a paper prints about a dataset, for any of its layers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from django.utils.translation import gettext as _

from gtm_hit.geometry.table import RectangleTable
from gtm_hit.metrics import statistics
from gtm_hit.metrics.annotations import Annotations, Floats, Ids
from gtm_hit.metrics.coverage import Coverage, coverage
from gtm_hit.metrics.figures import CameraMark, camera_mark
from gtm_hit.metrics.statistics import Summary, Tracks, Visibility, distribution
from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.ground.rectangles import annotation_rectangles
from gtm_hit.ops.quality.layer_rows import LayerRows, LayerState, frame_numbers, read_layer, state_of

EVERY = 8  # the paper counts every eighth position of the grid along both axes
ROWS_AT_ONCE = 50_000
STEPS = (1e-4, 1e4)  # metres; outside, areas and speeds leave the range of numbers
RATES = (1e-6, 1e6)  # frame numbers per second


@dataclass(frozen=True, eq=False)
class LayerStatistics:
    layer: str
    dataset: str
    cameras: list[str]
    marks: list[CameraMark]
    summary: Summary
    visibility: Visibility
    numbers: Ids  # (F,) annotated frames
    people_per_frame: Ids  # (F,)
    tracks: Tracks  # one row per person
    heights: Floats  # (P,) metres, one per person: the mean of what was annotated, else the cylinder's
    own_heights: int  # people with a height of their own
    speeds: Floats  # metres per second


def unmeasurable(dataset: Dataset) -> str:
    """Why nothing can be measured in the dataset; empty when it can."""
    within = {
        _("The step of the grid"): (dataset.step, STEPS, "m"),
        _("The frame rate"): (dataset.frame_rate, RATES, "/s"),
    }
    for name, (value, (least, most), unit) in within.items():
        if not least <= value <= most:
            return _("%(name)s is %(value)g %(unit)s: nothing can be measured with that.") % {
                "name": name,
                "value": value,
                "unit": unit,
            }
    return ""


def layer_statistics(layer: Layer) -> LayerStatistics:
    """Kept per process until the layer is saved again, or the dataset's cameras or cylinder change."""
    return _layer_statistics(state_of(layer), table(layer.dataset).path, layer.dataset.seconds_per_frame)


def ground_coverage(dataset: Dataset, every: int = EVERY) -> Coverage:
    return _ground_coverage(table(dataset).path, every)


@lru_cache(maxsize=32)
def _ground_coverage(path: Path, every: int) -> Coverage:
    found = RectangleTable.open(path)
    return coverage(found.grid, (found.visible(camera) for camera in range(found.cameras_count)), every)


@lru_cache(maxsize=8)
def _layer_statistics(state: LayerState, path: Path, seconds_per_frame: float) -> LayerStatistics:
    layer = Layer.objects.select_related("dataset").get(pk=state.layer)
    dataset, rows = layer.dataset, read_layer(layer)
    cameras = dataset.calibrated_cameras()
    annotations = rows.annotations(dataset.grid)
    people_per_frame = statistics.people_per_frame(annotations, rows.numbers)
    numbers = np.union1d(frame_numbers(dataset), rows.numbers)
    tracks = statistics.tracks_of(annotations, numbers)
    heights, own_heights = _heights(rows, tracks, dataset.cylinder_height)
    speeds = statistics.speeds(annotations, _with_gaps(numbers, dataset.frame_step), seconds_per_frame)
    return LayerStatistics(
        layer=layer.name,
        dataset=dataset.name,
        cameras=[camera.name for camera in cameras],
        marks=[camera_mark(camera) for camera in cameras],
        summary=_summary(annotations, people_per_frame, tracks, speeds, heights),
        visibility=_visibility(dataset, rows, RectangleTable.open(path)),
        numbers=rows.numbers,
        people_per_frame=people_per_frame,
        tracks=tracks,
        heights=heights,
        own_heights=own_heights,
        speeds=speeds,
    )


def _summary(
    annotations: Annotations, people_per_frame: Ids, tracks: Tracks, speeds: Floats, heights: Floats
) -> Summary:
    return Summary(
        frames=len(people_per_frame),
        people=len(tracks.persons),
        annotations=len(annotations),
        people_per_frame=distribution(people_per_frame),
        track_annotations=distribution(tracks.annotations),
        track_path=distribution(tracks.path),
        speed=distribution(speeds),
        height=distribution(heights),
    )


def _with_gaps(numbers: Ids, step: int) -> Ids:
    """The frames, and after each the one that should follow: where it is missing, no speed is known."""
    return np.union1d(numbers, numbers + step)


def _heights(rows: LayerRows, tracks: Tracks, usual: float) -> tuple[Floats, int]:
    known = ~np.isnan(rows.heights)
    persons = np.searchsorted(tracks.persons, rows.persons[known])
    count = np.bincount(persons, minlength=len(tracks.persons))
    total = np.bincount(persons, weights=rows.heights[known], minlength=len(tracks.persons))
    heights = np.divide(total, count, out=np.full(len(count), usual), where=count > 0)
    return heights, int((count > 0).sum())


def _visibility(dataset: Dataset, rows: LayerRows, found: RectangleTable) -> Visibility:
    """In pieces: the rectangles of a long layer need not be in memory together."""
    cameras = dataset.calibrated_cameras()
    visible = np.zeros((len(rows), len(cameras)), dtype=bool)
    for start in range(0, len(rows), ROWS_AT_ONCE):
        piece = slice(start, start + ROWS_AT_ONCE)
        _, visible[piece] = annotation_rectangles(
            dataset, cameras, found, rows.positions[piece], rows.heights[piece], rows.radii[piece]
        )
    return statistics.visibility(visible)
