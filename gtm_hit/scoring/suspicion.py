"""How much speaks against one assignment, and what: signals between 0 and 1, joined as independent doubts."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from statistics import median

from gtm_hit.scoring.evidence import Evidence

LEAST_PEOPLE = 10  # fewer say nothing about pace and edits
BEHAVIOUR = frozenset({"pace", "untouched", "edits"})


@dataclass(frozen=True)
class Usual:
    """What is usual in a campaign, per person marked."""

    seconds: float = 4.0
    untouched: float = 0.5  # share of those put there by a program
    edits: float = 1.0
    warnings: float = 0.01


@dataclass(frozen=True)
class Signal:
    name: str
    strength: float  # 0 to 1
    value: float
    usual: float


@dataclass(frozen=True)
class Suspicion:
    value: float  # 0 to 1
    signals: list[Signal]  # strongest first

    def __float__(self) -> float:
        return self.value


def usual(done: Iterable[Evidence]) -> Usual:
    """Medians over a campaign's assignments; what nobody knows yet stays at its default."""
    enough = [one for one in done if one.people >= LEAST_PEOPLE]
    given = [one for one in enough if one.carried >= LEAST_PEOPLE]
    if not enough:
        return Usual()
    return Usual(
        seconds=median(one.seconds / one.people for one in enough),
        untouched=median(one.untouched / one.carried for one in given) if given else Usual.untouched,
        edits=median(one.edits / one.people for one in enough),
        warnings=median(one.warnings / one.people for one in enough),
    )


def suspicion(evidence: Evidence, usually: Usual) -> Suspicion:
    return _joined(_signals(evidence, usually))


def careless(evidence: Evidence, usually: Usual) -> float:
    """How much the way of working alone speaks against it, whatever came out."""
    return _joined([one for one in _signals(evidence, usually) if one.name in BEHAVIOUR]).value


def _joined(signals: list[Signal]) -> Suspicion:
    heard = sorted((one for one in signals if one.strength > 0), key=lambda one: -one.strength)
    return Suspicion(1 - math.prod(1 - one.strength for one in heard), heard)


def _signals(evidence: Evidence, usually: Usual) -> list[Signal]:
    return [*_against_truth(evidence), *_against_others(evidence), *_working(evidence, usually)]


def _against_truth(evidence: Evidence) -> list[Signal]:
    found = []
    if evidence.truth + evidence.found:
        wrong = evidence.truth + evidence.found - evidence.matched - evidence.placed
        share = wrong / max(1.0, evidence.truth)
        found.append(Signal("gold", 0.9 * _rise(share, 0.1, 0.5), share, 0.1))
    if evidence.faults:
        left = (evidence.faults - evidence.repaired) / evidence.faults
        sure = evidence.faults / (evidence.faults + 0.5)
        found.append(
            Signal("faults", 0.95 * left * sure, evidence.faults - evidence.repaired, evidence.faults)
        )
    return found


def _against_others(evidence: Evidence) -> list[Signal]:
    if not evidence.shared:
        return []
    apart = 1 - evidence.agreed / evidence.shared
    return [Signal("agreement", 0.6 * _rise(apart, 0.08, 0.4), apart, 0.08)]


def _working(evidence: Evidence, usually: Usual) -> list[Signal]:
    if evidence.people < LEAST_PEOPLE:
        return []
    pace, edits = evidence.seconds / evidence.people, evidence.edits / evidence.people
    warned = evidence.warnings / evidence.people
    signals = [
        Signal("pace", 0.7 * _fall(pace, usually.seconds), pace, usually.seconds),
        Signal("edits", 0.3 * _fall(edits, usually.edits), edits, usually.edits),
        Signal(
            "warnings", 0.6 * _rise(warned, max(0.01, 2 * usually.warnings), 0.15), warned, usually.warnings
        ),
    ]
    if evidence.carried >= LEAST_PEOPLE:
        share, most = evidence.untouched / evidence.carried, max(usually.untouched, 0.5)
        signals.append(Signal("untouched", 0.6 * _rise(share, (1 + most) / 2, 1.0), share, usually.untouched))
    return signals


def _rise(value: float, first: float, last: float) -> float:
    """0 up to `first`, 1 from `last` on."""
    return min(1.0, max(0.0, (value - first) / (last - first))) if last > first else 0.0


def _fall(value: float, usual: float) -> float:
    """0 from half of what is usual on, 1 at nothing."""
    return min(1.0, max(0.0, 1 - 2 * value / usual)) if usual > 0 else 0.0
