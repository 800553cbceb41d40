"""Identities over time: MOTA, MOTP, IDF1 and switches by motmetrics, HOTA by `hota`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import motmetrics
import numpy as np
import pandas as pd

from gtm_hit.metrics import hota
from gtm_hit.metrics.annotations import Annotations, Ids, by_frame
from gtm_hit.metrics.matching import RADIUS, check_radius, distances_between, is_near

_NAMES = ("mota", "motp", "idf1", "idp", "idr", "num_switches", "num_fragmentations")


@dataclass(frozen=True)
class TrackingScore:
    radius: float  # metres
    truth_persons: int
    found_persons: int
    mota: float  # at most 1, may be negative
    motp: float  # 1 - mean distance / radius over the matches, as MODP
    mean_distance: float  # metres, what motmetrics calls MOTP
    idf1: float
    id_precision: float
    id_recall: float
    switches: int
    fragmentations: int
    hota: hota.HotaScore


@dataclass(frozen=True)
class Switch:
    """A person of the truth who goes on under another identity."""

    frame: int
    truth_person: int
    found_person: int
    before: int  # identity the person was found under last


@dataclass(frozen=True)
class TrackingResult:
    score: TrackingScore
    switches: list[Switch]


def evaluate(truth: Annotations, found: Annotations, radius: float = RADIUS) -> TrackingResult:
    """Compare identities; pairs closer than `radius` metres may be matched.

    A match of the frame before is kept while it is still near, even where another pair is nearer: CLEAR MOT's
    rule, so the matches can differ from those of `detection`.
    """
    check_radius(radius)
    truth_persons, truth_ids = np.unique(truth.identities(), return_inverse=True)
    found_persons, found_ids = np.unique(found.identities(), return_inverse=True)
    # motmetrics keeps identities in columns of floats: small ones survive that.
    events = motmetrics.MOTAccumulator()
    for number, rows, others in by_frame(truth, found):
        distances = distances_between(truth.xy[rows], found.xy[others])
        distances[~is_near(distances, radius)] = np.nan
        events.update(truth_ids[rows], found_ids[others], distances, frameid=number)
    values = _summary(events)
    score = TrackingScore(
        radius=radius,
        truth_persons=len(truth_persons),
        found_persons=len(found_persons),
        mota=_defined(values["mota"]),
        motp=1.0 - _defined(values["motp"]) / radius,
        mean_distance=_defined(values["motp"]),
        idf1=_defined(values["idf1"]),
        id_precision=_defined(values["idp"]),
        id_recall=_defined(values["idr"]),
        switches=int(values["num_switches"]),
        fragmentations=int(values["num_fragmentations"]),
        hota=hota.evaluate(truth, found, radius),
    )
    return TrackingResult(score, _switches(events.mot_events, truth_persons, found_persons))


def _summary(events: motmetrics.MOTAccumulator) -> dict[str, Any]:
    computed = motmetrics.metrics.create().compute(events, metrics=list(_NAMES))
    return {name: computed[name].iloc[0] for name in _NAMES}


def _defined(value: float) -> float:
    """Infinite is how motmetrics divides by nothing; here that is NaN."""
    return float(value) if np.isfinite(value) else float("nan")


def _switches(events: pd.DataFrame, truth_persons: Ids, found_persons: Ids) -> list[Switch]:
    last: dict[int, int] = {}
    switches = []
    # Other kinds repeat these two or describe who was not matched.
    matched = events[events.Type.isin(["MATCH", "SWITCH"])]
    for (frame, _), kind, truth_id, found_id in zip(
        matched.index, matched.Type, matched.OId.astype(int), matched.HId.astype(int), strict=True
    ):
        truth_person, found_person = int(truth_persons[truth_id]), int(found_persons[found_id])
        if kind == "SWITCH":
            switches.append(Switch(int(frame), truth_person, found_person, last[truth_person]))
        last[truth_person] = found_person
    return switches
