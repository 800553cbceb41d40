"""A layer's statistics as plain numbers, for JSON, and as lines of a table, for CSV."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import numpy as np

from gtm_hit.metrics.coverage import Coverage
from gtm_hit.metrics.statistics import Distribution
from gtm_hit.ops.quality.statistics.measuring import LayerStatistics

SPEED_STEP = 0.1  # metres per second, of the table of speeds
DISTRIBUTIONS = {
    "people_per_frame": "people",
    "track_annotations": "frames",
    "track_path": "m",
    "speed": "m/s",
    "height": "m",
}

Line = tuple[str, str | float, float | None, str]  # quantity, of what, value, unit


def as_numbers(found: LayerStatistics, ground: Coverage) -> dict[str, Any]:
    """JSON's types only; metres, seconds; what is not defined is null."""
    summary = found.summary
    return {
        "dataset": found.dataset,
        "layer": found.layer,
        "frames": summary.frames,
        "people": summary.people,
        "annotations": summary.annotations,
        "visible_per_view": dict(zip(found.cameras, found.visibility.per_view.tolist(), strict=True)),
        "visible_in_exactly": found.visibility.exactly.tolist(),
        "views_per_annotation": plain(found.visibility.mean_views),
        **{name: _distribution(getattr(summary, name)) for name in DISTRIBUTIONS},
        "people_with_own_height": found.own_heights,
        "coverage": {
            "every": ground.every,
            "positions": int(ground.seen_by.size),
            "seen_by_exactly": ground.counts.tolist(),
            "mean": ground.mean,
        },
    }


def csv_header() -> tuple[str, ...]:
    return "quantity", "of", "value", "unit"


def csv_lines(found: LayerStatistics, ground: Coverage) -> Iterator[Line]:
    """All numbers behind the page and its figures."""
    summary = found.summary
    yield from ((name, "", getattr(summary, name), "") for name in ("frames", "people", "annotations"))
    for camera, count in zip(found.cameras, found.visibility.per_view.tolist(), strict=True):
        yield "visible in view", camera, count, "annotations"
    for views, count in enumerate(found.visibility.exactly.tolist()):
        yield "visible in exactly", views, count, "annotations"
    yield "views per annotation", "mean", plain(found.visibility.mean_views), "views"
    for name, unit in DISTRIBUTIONS.items():
        for part, value in _distribution(getattr(summary, name)).items():
            yield name.replace("_", " "), part, value, "" if part == "count" else unit
    for cameras, count in enumerate(ground.counts.tolist()):
        yield f"coverage, one position in {ground.every}", cameras, count, "positions"
    yield f"coverage, one position in {ground.every}", "mean", ground.mean, "cameras"
    yield from _series(found)


def _series(found: LayerStatistics) -> Iterator[Line]:
    for number, people in zip(found.numbers.tolist(), found.people_per_frame.tolist(), strict=True):
        yield "people in frame", number, people, "people"
    tracks = found.tracks
    for name, values, unit in (
        ("annotations of person", tracks.annotations, "frames"),
        ("path of person", tracks.path.round(6), "m"),
        ("height of person", found.heights.round(6), "m"),
    ):
        for person, value in zip(tracks.persons.tolist(), values.tolist(), strict=True):
            yield name, person, value, unit
    yield from _speeds(found)


def _speeds(found: LayerStatistics) -> Iterator[Line]:
    """Hundreds of thousands of speeds, counted."""
    steps = np.floor(found.speeds / SPEED_STEP + 1e-9).astype(np.int64)
    for step, count in enumerate(np.bincount(steps).tolist() if len(steps) else []):
        if count:
            yield "speeds from", round(step * SPEED_STEP, 6), count, f"steps within {SPEED_STEP} m/s"


def _distribution(values: Distribution) -> dict[str, float | int | None]:
    return {name: plain(value) for name, value in asdict(values).items()}


def plain(value: float | int) -> float | int | None:
    """JSON has no NaN; what is not defined is null."""
    return None if math.isnan(value) else value
