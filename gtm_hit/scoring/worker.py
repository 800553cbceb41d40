"""One score per worker, 0 to 100, with an interval that holds the true value nine times out of ten.

Every part counts successes and failures (people found and missed, faults repaired and left …). Its share is a
Beta distribution that starts at Beta(1.6, 0.4), worth two trials at 80 %: with little evidence a worker stays
near what workers usually are and his interval wide, with much the prior is forgotten. A trial counts for less
than one where trials come in lumps (people of one frame) or where the blame is shared (replicas). Shares are
stretched between the part's floor, which is worth nothing, and 1. The score is the weighted mean of the parts
that the campaign measures; the parts' deviations add up linearly, because who is careless
is so in all of them.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

from gtm_hit.scoring.evidence import Evidence

PRIOR_GOOD, PRIOR_BAD = 1.6, 0.4
NINE_OF_TEN = 1.645


@dataclass(frozen=True)
class Part:
    name: str
    weight: float
    trial: float  # how much of a trial one counted thing is
    floor: float  # the share that is worth nothing


PARTS = (
    Part("found", 4, 0.25, 0.5),  # people of the truth found, and nobody invented
    Part("placed", 2, 0.25, 0.3),
    Part("identity", 1, 0.1, 0.5),
    Part("faults", 6, 1.0, 0.0),
    Part("agreement", 2, 0.05, 0.4),
    Part("plausible", 1, 0.1, 0.8),
    Part("care", 2, 1.0, 0.0),
    Part("finishing", 2, 1.0, 0.0),
)


@dataclass(frozen=True)
class PartScore:
    name: str
    good: float
    bad: float
    score: float  # 0 to 100
    deviation: float  # of the score
    lost: float  # points it costs the whole


@dataclass(frozen=True)
class Score:
    score: float
    low: float
    high: float
    parts: list[PartScore]  # what cost most first


def counted(evidence: Evidence, name: str) -> tuple[float, float]:
    """Successes and failures of a part."""
    match name:
        case "found":
            bad = evidence.truth + evidence.found - 2 * evidence.matched
            return evidence.matched, bad
        case "placed":
            return evidence.placed, evidence.matched - evidence.placed
        case "identity":
            return evidence.same, max(0.0, evidence.matched - evidence.same)
        case "faults":
            return evidence.repaired, evidence.faults - evidence.repaired
        case "agreement":
            return evidence.agreed, evidence.shared - evidence.agreed
        case "plausible":
            return max(0.0, evidence.people - evidence.warnings), evidence.warnings
        case "care":
            return max(0.0, evidence.finished - evidence.careless), evidence.careless
    return evidence.finished, evidence.dropped


def measured_parts(evidence: Evidence) -> frozenset[str]:
    """The parts about which there is evidence at all; of a whole campaign: what it measures."""
    return frozenset(part.name for part in PARTS if sum(counted(evidence, part.name)) > 0)


def score(evidence: Evidence, measured: Collection[str] | None = None) -> Score:
    """`measured`: the parts that count; all of them when it is left out."""
    parts = [part for part in PARTS if measured is None or part.name in measured] or list(PARTS)
    whole = sum(part.weight for part in parts)
    scores = [_part(part, evidence, part.weight / whole) for part in parts]
    mean = sum(one.score * part.weight for one, part in zip(scores, parts, strict=True)) / whole
    deviation = sum(one.deviation * part.weight for one, part in zip(scores, parts, strict=True)) / whole
    mean = min(max(mean, 0.0), 100.0)
    low, high = max(0.0, mean - NINE_OF_TEN * deviation), min(100.0, mean + NINE_OF_TEN * deviation)
    return Score(mean, low, high, sorted(scores, key=lambda one: -one.lost))


def _part(part: Part, evidence: Evidence, share: float) -> PartScore:
    good, bad = counted(evidence, part.name)
    alpha, beta = PRIOR_GOOD + part.trial * good, PRIOR_BAD + part.trial * bad
    mean = alpha / (alpha + beta)
    deviation = math.sqrt(alpha * beta / (alpha + beta + 1)) / (alpha + beta)
    stretched = max(0.0, (mean - part.floor) / (1 - part.floor))
    points, spread = 100 * stretched, 100 * deviation / (1 - part.floor)
    return PartScore(part.name, good, bad, points, spread, share * (100 - points))
