"""HOTA, higher order tracking accuracy, of places on the ground.

Luiten et al., "HOTA: A Higher Order Metric for Evaluating Multi-Object Tracking", IJCV 2021. Two places are
as similar as 1 - distance / radius, never less than 0: the measure behind MODP.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from gtm_hit.metrics.annotations import Annotations, Floats, Ids, by_frame
from gtm_hit.metrics.matching import RADIUS, check_radius, distances_between

ALPHAS = np.arange(1, 20) / 20  # similarity a match must reach; the scores are means over these


@dataclass(frozen=True)
class HotaScore:
    """Means over ALPHAS; NaN where there is nothing to divide by."""

    hota: float
    detection: float  # DetA
    association: float  # AssA
    localisation: float  # LocA; 1 at an alpha that no match reaches


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Pairs of persons that were similar at all, one entry per frame and pair."""

    truth: Ids  # dense number of the person
    found: Ids
    weight: Floats  # similarity as a share of all similarity either person had in the frame


def evaluate(truth: Annotations, found: Annotations, radius: float = RADIUS) -> HotaScore:
    check_radius(radius)
    truth_ids, truth_counts = _dense(truth)
    found_ids, found_counts = _dense(found)
    frames = [
        (truth_ids[rows], found_ids[others], _similarity(truth.xy[rows], found.xy[others], radius))
        for _, rows, others in by_frame(truth, found)
        if len(rows) and len(others)
    ]
    alignment = _Alignment(_similar_pairs(frames), truth_counts, found_counts)
    first, second, similarity = _matched(frames, alignment)
    scores = [
        _at_alpha(first[kept], second[kept], similarity[kept], truth_counts, found_counts)
        for kept in (similarity >= alpha - np.finfo(float).eps for alpha in ALPHAS)
    ]
    detection, association, localisation = np.array(scores).T
    if not np.isnan(localisation).all():
        # TrackEval's convention, without which its numbers and ours could not be compared.
        localisation = np.where(np.isnan(localisation), 1.0, localisation)
    return HotaScore(
        float(np.mean(np.sqrt(detection * association))),
        float(np.mean(detection)),
        float(np.mean(association)),
        float(np.mean(localisation)),
    )


class _Alignment:
    """How well two persons fit over all frames, looked up by pair: a dense table of all pairs may not fit."""

    def __init__(self, pairs: _Pairs, truth_counts: Ids, found_counts: Ids) -> None:
        self._width = max(len(found_counts), 1)
        self._keys, inverse = np.unique(pairs.truth * self._width + pairs.found, return_inverse=True)
        shared = np.bincount(inverse, weights=pairs.weight, minlength=len(self._keys))
        truth, found = np.divmod(self._keys, self._width)
        self._scores = shared / (truth_counts[truth] + found_counts[found] - shared)

    def of(self, truth: Ids, found: Ids) -> Floats:
        """(N, M) scores of persons (N,) and (M,); 0 for pairs that were never similar."""
        if not len(self._keys):
            return np.zeros((len(truth), len(found)))
        keys = truth[:, None] * self._width + found[None, :]
        places = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        return np.where(self._keys[places] == keys, self._scores[places], 0.0)


def _dense(annotations: Annotations) -> tuple[Ids, Ids]:
    """Persons numbered from 0 without holes, and how many annotations each has."""
    _, dense, counts = np.unique(annotations.identities(), return_inverse=True, return_counts=True)
    return dense.astype(np.int64), counts.astype(np.int64)


def _similarity(truth_xy: Floats, found_xy: Floats, radius: float) -> Floats:
    return np.maximum(0.0, 1.0 - distances_between(truth_xy, found_xy) / radius)


def _similar_pairs(frames: list[tuple[Ids, Ids, Floats]]) -> _Pairs:
    truth, found, weights = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)], [np.zeros(0)]
    for truth_ids, found_ids, similarity in frames:
        rows, columns = np.nonzero(similarity)
        share = similarity.sum(axis=0)[columns] + similarity.sum(axis=1)[rows] - similarity[rows, columns]
        truth.append(truth_ids[rows])
        found.append(found_ids[columns])
        weights.append(similarity[rows, columns] / share)
    return _Pairs(np.concatenate(truth), np.concatenate(found), np.concatenate(weights))


def _matched(frames: list[tuple[Ids, Ids, Floats]], alignment: _Alignment) -> tuple[Ids, Ids, Floats]:
    """Persons of both sides matched in every frame, and their similarity there, (K,) each."""
    truth, found, similarities = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)], [np.zeros(0)]
    for truth_ids, found_ids, similarity in frames:
        score = alignment.of(truth_ids, found_ids) * similarity
        rows, columns = linear_sum_assignment(score, maximize=True)
        truth.append(truth_ids[rows])
        found.append(found_ids[columns])
        similarities.append(similarity[rows, columns])
    return np.concatenate(truth), np.concatenate(found), np.concatenate(similarities)


def _at_alpha(
    truth: Ids, found: Ids, similarity: Floats, truth_counts: Ids, found_counts: Ids
) -> tuple[float, float, float]:
    """DetA, AssA and LocA of the matches that reach one alpha."""
    people = int(truth_counts.sum() + found_counts.sum())
    if not people:
        return float("nan"), float("nan"), float("nan")
    if not len(truth):
        return 0.0, 0.0, float("nan")
    width = len(found_counts)
    keys, together = np.unique(truth * width + found, return_counts=True)
    ever = truth_counts[keys // width] + found_counts[keys % width] - together
    association = float(np.sum(together * together / ever)) / len(truth)
    return len(truth) / (people - len(truth)), association, float(similarity.mean())
