"""Two layers of a dataset against each other: scores, identities, and what is wrong in each frame."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Any

import numpy as np
from django.utils.translation import gettext as _

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics import detection
from gtm_hit.metrics.annotations import Annotations, Ids, MetricsError
from gtm_hit.metrics.detection import DetectionScore, FrameScores
from gtm_hit.metrics.limits import MOST_PAIRS, check_size
from gtm_hit.metrics.matching import RADIUS, match_places
from gtm_hit.metrics.tracking import Switch, TrackingScore
from gtm_hit.models import Layer
from gtm_hit.ops.quality.layer_rows import (
    LayerRows,
    LayerState,
    QualityError,
    read_layers,
    saved_numbers,
    state_of,
)
from gtm_hit.ops.quality.statistics.numbers import plain

MOST_FRAMES = 2000  # compared for a page; a command compares all
LARGEST_RADIUS = 10.0  # metres


class Scope(StrEnum):
    BOTH = "both"  # frames that both layers have: a worker's batch is not blamed for the rest of the day
    EITHER = "either"  # a frame that only one has counts too: its people are all missed, or all extra


class Kind(StrEnum):
    MATCHED = "matched"
    SWAPPED = "swapped"  # matched, but the found person was somebody else before
    MISSED = "missed"
    EXTRA = "extra"


@dataclass(frozen=True)
class Question:
    truth: LayerState
    found: LayerState
    grid: Grid
    radius: float
    scope: Scope
    start: int  # frame number from which on to compare
    most: int | None  # frames; None: all


@dataclass(frozen=True)
class Mark:
    """One person of one frame: rows of both sides, None where a side does not have the person."""

    kind: Kind
    truth: int | None
    found: int | None
    distance: float | None  # metres
    before: int | None  # the number under which a swapped person was found last


@dataclass(frozen=True, eq=False)
class Comparison:
    radius: float
    truth: LayerRows
    found: LayerRows
    truth_xy: Annotations
    found_xy: Annotations
    numbers: Ids  # frames compared, ascending, also those where nobody is
    only_truth: int  # frames of one layer alone; left out unless the scope is EITHER
    only_found: int
    later: int  # frames after the last one compared
    frames: FrameScores  # frames where somebody is, on either side
    switched: Ids  # (F,) switches in each of those frames
    overall: DetectionScore
    curve: list[DetectionScore]
    tracking: TrackingScore
    switches: list[Switch]

    @property
    def worst_first(self) -> Ids:
        """Rows of `frames` by the number of mistakes, then by the sum of distances, then by frame number."""
        scores = self.frames
        mistakes = scores.truth + scores.found - 2 * scores.matched + self.switched
        order: Ids = np.lexsort((scores.numbers, -scores.distance_sums, -mistakes))
        return order


def compare(
    truth: Layer,
    found: Layer,
    radius: float = RADIUS,
    scope: Scope = Scope.BOTH,
    start: int = 0,
    most: int | None = None,
) -> Comparison:
    """Kept per process until one of the layers is saved again. Raises QualityError."""
    if truth.dataset_id != found.dataset_id:
        raise QualityError(_("Layers of different datasets cannot be compared."))
    if not 0 < radius <= LARGEST_RADIUS:
        raise QualityError(_("The radius is more than 0 and at most %(most)g m.") % {"most": LARGEST_RADIUS})
    grid = truth.dataset.grid
    return _compare(Question(state_of(truth), state_of(found), grid, radius, scope, start, most))


@lru_cache(maxsize=4)
def _compare(asked: Question) -> Comparison:
    # pandas, behind motmetrics, takes longer to import than most pages take.
    from gtm_hit.metrics import tracking

    layers = Layer.objects.in_bulk([asked.truth.layer, asked.found.layer])
    truth_numbers, found_numbers = (saved_numbers(layers[side.layer]) for side in (asked.truth, asked.found))
    wanted = (np.intersect1d if asked.scope is Scope.BOTH else np.union1d)(truth_numbers, found_numbers)
    from_start = wanted[wanted >= asked.start]
    numbers = from_start[: asked.most]
    if not len(numbers):
        raise QualityError(_("The layers have no frame in common."))
    rows = read_layers(layers.values(), (int(numbers[0]), int(numbers[-1])))
    truth, found = rows[asked.truth.layer].within(numbers), rows[asked.found.layer].within(numbers)
    truth_xy, found_xy = truth.annotations(asked.grid), found.annotations(asked.grid)
    try:
        check_size(truth_xy, found_xy, MOST_PAIRS if asked.most else None)
    except MetricsError as error:
        raise QualityError(str(error)) from error
    frames = detection.evaluate_frames(truth_xy, found_xy, asked.radius)
    result = tracking.evaluate(truth_xy, found_xy, asked.radius)
    places = np.searchsorted(frames.numbers, [switch.frame for switch in result.switches])
    return Comparison(
        radius=asked.radius,
        truth=truth,
        found=found,
        truth_xy=truth_xy,
        found_xy=found_xy,
        numbers=numbers,
        only_truth=len(np.setdiff1d(truth_numbers, found_numbers)),
        only_found=len(np.setdiff1d(found_numbers, truth_numbers)),
        later=len(from_start) - len(numbers),
        frames=frames,
        switched=np.bincount(places.astype(np.int64), minlength=len(frames.numbers)),
        overall=frames.overall(),
        curve=detection.curve(truth_xy, found_xy),
        tracking=result.score,
        switches=result.switches,
    )


def marks(comparison: Comparison, number: int) -> list[Mark]:
    """Everybody of one frame, mistakes first, then the farthest pairs."""
    truth_rows = np.flatnonzero(comparison.truth.frames == number)
    found_rows = np.flatnonzero(comparison.found.frames == number)
    first, second, distances = match_places(
        comparison.truth_xy.xy[truth_rows], comparison.found_xy.xy[found_rows], comparison.radius
    )
    # Switches follow CLEAR MOT, which may keep another pair than the nearest: told by the truth's person.
    before = {switch.truth_person: switch.before for switch in comparison.switches if switch.frame == number}
    pairs = [
        _pair(comparison, int(truth_rows[one]), int(found_rows[other]), distance, before)
        for one, other, distance in zip(first, second, distances.tolist(), strict=True)
    ]
    missed = [Mark(Kind.MISSED, row, None, None, None) for row in np.delete(truth_rows, first).tolist()]
    extra = [Mark(Kind.EXTRA, None, row, None, None) for row in np.delete(found_rows, second).tolist()]
    # Equal distances differ in their last bits: rounded, such pairs come by person.
    pairs.sort(key=lambda mark: (mark.kind is not Kind.SWAPPED, -round(mark.distance or 0.0, 9), mark.truth))
    return [*missed, *extra, *pairs]


def _pair(comparison: Comparison, truth: int, found: int, distance: float, before: dict[int, int]) -> Mark:
    was = before.get(int(comparison.truth.persons[truth]))
    kind = Kind.MATCHED if was is None else Kind.SWAPPED
    return Mark(kind, truth, found, distance, was)


def person_part(rows: LayerRows, row: int) -> dict[str, Any]:
    """A person as the browser's geometry takes it; None for the dataset's cylinder."""
    return {
        "person": int(rows.persons[row]),
        "position": int(rows.positions[row]),
        "height": plain(float(rows.heights[row])),
        "radius": plain(float(rows.radii[row])),
    }


def mark_part(comparison: Comparison, mark: Mark) -> dict[str, Any]:
    return {
        "kind": mark.kind.value,
        "truth": None if mark.truth is None else person_part(comparison.truth, mark.truth),
        "found": None if mark.found is None else person_part(comparison.found, mark.found),
        "distance": mark.distance,
        "before": mark.before,
    }


def as_numbers(comparison: Comparison) -> dict[str, Any]:
    """JSON's types only; scores as fractions, metres; what is not defined is null."""
    found, identity = comparison.overall, comparison.tracking
    return {
        "radius": comparison.radius,
        "frames": len(comparison.numbers),
        "frames_only_in_truth": comparison.only_truth,
        "frames_only_in_found": comparison.only_found,
        **{name: plain(getattr(found, name)) for name in ("moda", "modp", "precision", "recall")},
        **{name: getattr(found, name) for name in ("truth", "found", "matched", "missed", "extra")},
        **{
            name: plain(getattr(identity, name))
            for name in ("mota", "motp", "mean_distance", "idf1", "id_precision", "id_recall", "switches")
        },
        "truth_persons": identity.truth_persons,
        "found_persons": identity.found_persons,
        "hota": plain(identity.hota.hota),
        "deta": plain(identity.hota.detection),
        "assa": plain(identity.hota.association),
        "loca": plain(identity.hota.localisation),
        "curve": [
            {name: plain(getattr(score, name)) for name in ("radius", "moda", "modp", "precision", "recall")}
            for score in comparison.curve
        ],
    }


def frame_lines(comparison: Comparison) -> list[dict[str, Any]]:
    """One per frame where somebody is, worst first."""
    scores = comparison.frames
    columns = {
        "frame": scores.numbers,
        "truth": scores.truth,
        "found": scores.found,
        "matched": scores.matched,
        "missed": scores.truth - scores.matched,
        "extra": scores.found - scores.matched,
        "swapped": comparison.switched,
        "moda": scores.moda,
        "modp": scores.modp,
        "precision": scores.precision,
        "recall": scores.recall,
    }
    lists = {name: values[comparison.worst_first].tolist() for name, values in columns.items()}
    return [
        {name: plain(value) for name, value in zip(lists, line, strict=True)}
        for line in zip(*lists.values(), strict=True)
    ]
