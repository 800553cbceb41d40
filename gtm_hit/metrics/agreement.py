"""How far workers who did the same batch agree, in metres."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from gtm_hit.metrics.annotations import Annotations, Floats, MetricsError
from gtm_hit.metrics.identities import going_together
from gtm_hit.metrics.matching import RADIUS, Matches, match


@dataclass(frozen=True)
class PairAgreement:
    """Two workers, or the sums over all pairs of workers."""

    annotations: int  # of both together
    matched: int  # pairs
    median_distance: float  # metres over the matched pairs; NaN without
    p95_distance: float  # metres
    same_identity: int  # matched pairs whose identities go together, see `going_together`

    @property
    def matched_share(self) -> float:
        """Annotations of either worker that the other has too; NaN when nobody annotated anything."""
        return 2 * self.matched / self.annotations if self.annotations else float("nan")

    @property
    def identity_agreement(self) -> float:
        """Share of the matched pairs; NaN without matches."""
        return self.same_identity / self.matched if self.matched else float("nan")


@dataclass(frozen=True)
class WorkerBias:
    """A worker against the consensus of the others; metres, NaN where nobody agrees on a person."""

    annotations: int
    confirmed: int  # annotations that at least one other worker has too
    x: float  # mean of the worker's X minus the others'
    y: float
    spread_x: float  # standard deviation of the same differences
    spread_y: float


@dataclass(frozen=True)
class Agreement:
    overall: PairAgreement
    pairs: dict[tuple[str, str], PairAgreement]
    workers: dict[str, WorkerBias]


def evaluate(layers: Mapping[str, Annotations], radius: float = RADIUS) -> Agreement:
    """Compare every worker's annotations of the same frames with every other's.

    The consensus of the others about a person is the median, X and Y each, of the annotations that the other
    workers' best matching pairs with it; it needs no common numbering of people.
    """
    if len(layers) < 2:
        raise MetricsError(f"agreement takes two workers or more, not {len(layers)}")
    matches = {
        (first, second): match(layers[first], layers[second], radius)
        for first, second in combinations(layers, 2)
    }
    pairs = {
        (first, second): _pair(layers[first], layers[second], found)
        for (first, second), found in matches.items()
    }
    workers = {worker: _bias(worker, layers, matches) for worker in layers}
    return Agreement(_overall(pairs, matches), pairs, workers)


def _pair(first: Annotations, second: Annotations, matches: Matches) -> PairAgreement:
    same = going_together(first.identities()[matches.truth], second.identities()[matches.found])
    return _summed(len(first) + len(second), matches.distances, same)


def _overall(
    pairs: dict[tuple[str, str], PairAgreement], matches: dict[tuple[str, str], Matches]
) -> PairAgreement:
    return _summed(
        sum(pair.annotations for pair in pairs.values()),
        np.concatenate([found.distances for found in matches.values()]),
        sum(pair.same_identity for pair in pairs.values()),
    )


def _summed(annotations: int, distances: Floats, same_identity: int) -> PairAgreement:
    median, p95 = np.percentile(distances, [50, 95]) if len(distances) else (np.nan, np.nan)
    return PairAgreement(annotations, len(distances), float(median), float(p95), same_identity)


def _bias(
    worker: str, layers: Mapping[str, Annotations], matches: dict[tuple[str, str], Matches]
) -> WorkerBias:
    own = layers[worker]
    others = np.full((len(layers), len(own), 2), np.nan)
    for (first, second), found in matches.items():
        # Every other worker has one slice; the worker's own stays empty.
        if worker == first:
            others[list(layers).index(second), found.truth] = layers[second].xy[found.found]
        elif worker == second:
            others[list(layers).index(first), found.found] = layers[first].xy[found.truth]
    confirmed = ~np.isnan(others[..., 0]).all(axis=0)
    if not confirmed.any():
        return WorkerBias(len(own), 0, *[float("nan")] * 4)
    difference = own.xy[confirmed] - np.nanmedian(others[:, confirmed], axis=0)
    x, y = difference.mean(axis=0)
    spread_x, spread_y = difference.std(axis=0)
    return WorkerBias(len(own), int(confirmed.sum()), float(x), float(y), float(spread_x), float(spread_y))
