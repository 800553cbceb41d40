"""Annotations against the truth, in metres: shares, distances, and every mistake, worst first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from gtm_hit.metrics.annotations import Annotations, Ids, by_frame
from gtm_hit.metrics.identities import going_together
from gtm_hit.metrics.matching import RADIUS, Matches, distances_between, is_near, match

PLACED = 0.15 + 1e-6  # metres that are no mistake; six steps of 2.5 cm are not quite 0.15


class MistakeKind(StrEnum):
    MISSED = "missed"
    EXTRA = "extra"
    OFF = "off"
    RENUMBERED = "renumbered"


@dataclass(frozen=True)
class Mistake:
    """Rows of both sides; None where a side does not have the person."""

    kind: MistakeKind
    frame: int
    truth: int | None
    found: int | None
    distance: float | None = None  # metres
    before: int | None = None  # the number under which a renumbered person was found last

    @property
    def weight(self) -> float:
        """Metres; somebody missed or invented is as bad as the farthest that still counts as found."""
        return self.distance or 0.0 if self.kind is MistakeKind.OFF else RADIUS


@dataclass(frozen=True)
class TruthScore:
    frames: int
    truth: int  # annotations of the truth
    found: int
    matched: int
    placed: int  # matched pairs no farther than PLACED apart
    together: int  # near pairs whose identities go together, as IDF1 counts them
    median: float  # metres over the matched pairs; NaN without
    p95: float  # metres

    @property
    def recall(self) -> float:
        return self.matched / self.truth if self.truth else 1.0

    @property
    def precision(self) -> float:
        return self.matched / self.found if self.found else float(not self.truth)

    @property
    def idf1(self) -> float:
        return 2 * self.together / (self.truth + self.found) if self.truth + self.found else 1.0


def score(truth: Annotations, found: Annotations, radius: float = RADIUS) -> TruthScore:
    """Only pairs closer than `radius` are matched. Both sides hold just the frames that are judged."""
    matches = match(truth, found, radius)
    median, p95 = np.percentile(matches.distances, [50, 95]) if len(matches.distances) else (np.nan, np.nan)
    return TruthScore(
        frames=len(np.union1d(truth.frames, found.frames)),
        truth=len(truth),
        found=len(found),
        matched=len(matches.distances),
        placed=int((matches.distances <= PLACED).sum()),
        together=_together(truth, found, radius),
        median=float(median),
        p95=float(p95),
    )


def mistakes(truth: Annotations, found: Annotations, radius: float = RADIUS) -> list[Mistake]:
    """Worst first; equal ones by frame."""
    matches = match(truth, found, radius)
    made = [*_alone(truth, found, matches), *_off(truth, matches), *_renumbered(truth, found, matches)]
    return sorted(made, key=lambda one: (-round(one.weight, 6), one.frame, one.kind, one.truth or 0))


def _together(truth: Annotations, found: Annotations, radius: float) -> int:
    rows, others = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for _number, mine, theirs in by_frame(truth, found):
        first, second = np.nonzero(is_near(distances_between(truth.xy[mine], found.xy[theirs]), radius))
        rows.append(mine[first])
        others.append(theirs[second])
    near, far = np.concatenate(rows), np.concatenate(others)
    return going_together(truth.identities()[near], found.identities()[far])


def _alone(truth: Annotations, found: Annotations, matches: Matches) -> Iterator[Mistake]:
    for row in _others(len(truth), matches.truth):
        yield Mistake(MistakeKind.MISSED, int(truth.frames[row]), row, None)
    for row in _others(len(found), matches.found):
        yield Mistake(MistakeKind.EXTRA, int(found.frames[row]), None, row)


def _others(count: int, matched: Ids) -> list[int]:
    return np.setdiff1d(np.arange(count), matched).tolist()


def _off(truth: Annotations, matches: Matches) -> Iterator[Mistake]:
    for row, other, distance in _pairs(matches):
        if distance > PLACED:
            yield Mistake(MistakeKind.OFF, int(truth.frames[row]), row, other, distance)


def _renumbered(truth: Annotations, found: Annotations, matches: Matches) -> Iterator[Mistake]:
    """A person of the truth who goes on under another number than before."""
    persons, numbers = truth.identities(), found.identities()
    last: dict[int, int] = {}
    for row, other, distance in sorted(_pairs(matches), key=lambda pair: int(truth.frames[pair[0]])):
        person, number = int(persons[row]), int(numbers[other])
        before = last.get(person, number)
        if before != number:
            frame = int(truth.frames[row])
            yield Mistake(MistakeKind.RENUMBERED, frame, row, other, distance, before)
        last[person] = number


def _pairs(matches: Matches) -> list[tuple[int, int, float]]:
    columns = (matches.truth.tolist(), matches.found.tolist(), matches.distances.tolist())
    return list(zip(*columns, strict=True))
