"""Identities over time: MOTA, MOTP and switches by motmetrics, IDF1 and HOTA by our own.

motmetrics has no HOTA, and its IDF1 fills a table of everybody times everybody: 10 GB for hours of video.
TrackEval has both with nineteen such tables, and asks for an OpenCV that replaces ours. The tests compute
both with it, on real people, and compare.
"""

from __future__ import annotations

from dataclasses import dataclass

import motmetrics
import numpy as np
import pandas as pd

from gtm_hit.metrics import hota
from gtm_hit.metrics.annotations import Annotations, Ids, by_frame
from gtm_hit.metrics.identities import going_together
from gtm_hit.metrics.matching import RADIUS, check_radius, distances_between, is_near

_CLEAR = ("mota", "motp", "num_switches")


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
    hota: hota.HotaScore


@dataclass(frozen=True)
class Switch:
    """A person of the truth who goes on under another identity."""

    frame: int
    truth_person: int
    before: int  # identity the person was found under last


@dataclass(frozen=True)
class TrackingResult:
    score: TrackingScore
    switches: list[Switch]


def evaluate(truth: Annotations, found: Annotations, radius: float = RADIUS) -> TrackingResult:
    """Compare identities; pairs closer than `radius` metres may be matched.

    For MOTA and switches a person's last match is kept while it is still near, even where another pair is
    nearer: CLEAR MOT's rule, so those matches can differ from the ones of `detection`.
    """
    check_radius(radius)
    events, near = _accumulated(truth, found, radius)
    clear = motmetrics.metrics.create().compute(events, metrics=list(_CLEAR)).iloc[0]
    mean_distance = _defined(clear["motp"])
    same = going_together(truth.identities()[near[0]], found.identities()[near[1]])
    score = TrackingScore(
        radius=radius,
        truth_persons=len(np.unique(truth.identities())),
        found_persons=len(np.unique(found.identities())),
        mota=_defined(clear["mota"]),
        motp=1.0 - mean_distance / radius,
        mean_distance=mean_distance,
        idf1=_fraction(2 * same, len(truth) + len(found)),
        id_precision=_fraction(same, len(found)),
        id_recall=_fraction(same, len(truth)),
        switches=int(clear["num_switches"]),
        hota=hota.evaluate(truth, found, radius),
    )
    return TrackingResult(score, _switches(events.mot_events, truth, found))


def _accumulated(
    truth: Annotations, found: Annotations, radius: float
) -> tuple[motmetrics.MOTAccumulator, tuple[Ids, Ids]]:
    """The events of CLEAR MOT, and the rows (K,) of both sides of all pairs that are near."""
    # motmetrics keeps identities in columns of floats: small ones survive that.
    truth_ids = np.unique(truth.identities(), return_inverse=True)[1]
    found_ids = np.unique(found.identities(), return_inverse=True)[1]
    events = motmetrics.MOTAccumulator()
    near_rows, near_others = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for number, rows, others in by_frame(truth, found):
        distances = distances_between(truth.xy[rows], found.xy[others])
        near = is_near(distances, radius)
        first, second = np.nonzero(near)
        near_rows.append(rows[first])
        near_others.append(others[second])
        distances[~near] = np.nan
        events.update(truth_ids[rows], found_ids[others], distances, frameid=number)
    return events, (np.concatenate(near_rows), np.concatenate(near_others))


def _fraction(part: int, whole: int) -> float:
    return part / whole if whole else float("nan")


def _defined(value: float) -> float:
    """Infinite is how motmetrics divides by nothing; here that is NaN."""
    return float(value) if np.isfinite(value) else float("nan")


def _switches(events: pd.DataFrame, truth: Annotations, found: Annotations) -> list[Switch]:
    truth_persons, found_persons = np.unique(truth.identities()), np.unique(found.identities())
    last: dict[int, int] = {}
    switches = []
    # Other kinds repeat these two or describe who was not matched.
    matched = events[events.Type.isin(["MATCH", "SWITCH"])]
    frames = matched.index.get_level_values(0)
    persons, others = truth_persons[matched.OId.astype(int)], found_persons[matched.HId.astype(int)]
    for frame, kind, person, other in zip(
        frames.tolist(), matched.Type, persons.tolist(), others.tolist(), strict=True
    ):
        if kind == "SWITCH":
            switches.append(Switch(frame, person, last[person]))
        last[person] = other
    return switches
