"""Who left and came back: proposed as the same, never joined unless somebody said so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gtm_hit.stitching.joining import Chain
from gtm_hit.stitching.rules import Rules
from gtm_hit.stitching.scoring import STRIDE
from gtm_hit.stitching.tracks import Ids, Source, Track
from gtm_hit.stitching.verdicts import Verdict, Verdicts

LEAST = 3  # frames of somebody worth asking about; less is rather nobody


@dataclass(frozen=True, eq=False)
class Return:
    before: Track
    after: Track
    metres: float  # between where the one was last and the other first
    seconds: float


def linked(chains: Sequence[Chain], verdicts: Sequence[Verdict]) -> list[list[Chain]]:
    """Chains of one person, in order of time, where somebody said that they are the same."""
    where = {source: index for index, chain in enumerate(chains) for source in chain.sources}
    groups = {index: [chain] for index, chain in enumerate(chains)}
    leader = list(range(len(chains)))
    for verdict in verdicts:
        if not verdict.same:
            continue
        ends = sorted({leader[where[source]] for source in verdict.before | verdict.after if source in where})
        if len(ends) != 2 or _at_once(groups[ends[0]], groups[ends[1]]):
            continue
        groups[ends[0]] += groups.pop(ends[1])
        leader = [ends[0] if each == ends[1] else each for each in leader]
    return [sorted(group, key=lambda chain: chain.first) for group in groups.values()]


def returners(people: Sequence[Sequence[Chain]], rules: Rules, verdicts: Verdicts) -> list[Return]:
    """For everybody who left at most one who came, the nearest in space first."""
    seen = [
        person
        for person in people
        if sum(len(track.frames) for chain in person for track in chain.tracks) >= LEAST
    ]
    lasts = [person[-1].tail for person in seen]
    firsts = [person[0].tracks[0] for person in seen]
    found = sorted(_candidates(lasts, firsts, rules))
    gone, come, proposed = set[int](), set[int](), list[Return]()
    for metres, waited, one, other in found:
        if one in gone or other in come or verdicts.of(_sources(seen[one]), _sources(seen[other])) < 0:
            continue
        gone.add(one)
        come.add(other)
        before = seen[one][-1].tracks[-1]
        proposed.append(Return(before, firsts[other], metres, waited))
    return proposed


def _candidates(
    lasts: Sequence[Track], firsts: Sequence[Track], rules: Rules
) -> list[tuple[float, float, int, int]]:
    """Metres and seconds between, who left, who came."""
    if not lasts:
        return []
    begun: Ids = np.array([track.first for track in firsts])
    order = np.argsort(begun, kind="stable")
    places = np.stack([track.xy[0] for track in firsts])[order]
    begun = begun[order]
    found = []
    for one, track in enumerate(lasts):
        start = np.searchsorted(begun, track.last + rules.gap + 2)
        end = np.searchsorted(begun, track.last + rules.return_seconds / rules.seconds, side="right")
        metres = np.hypot(*(places[start:end] - track.xy[-1]).T)
        waited = (begun[start:end] - track.last) * rules.seconds
        for index in np.flatnonzero((metres <= rules.return_reach) & (metres <= STRIDE * waited)).tolist():
            found.append((float(metres[index]), float(waited[index]), one, int(order[start + index])))
    return found


def _sources(person: Sequence[Chain]) -> set[Source]:
    return set().union(*(chain.sources for chain in person))


def _at_once(ones: Sequence[Chain], others: Sequence[Chain]) -> bool:
    return any(
        len(np.intersect1d(one.frames, other.frames, assume_unique=True))
        for first in ones
        for second in others
        for one in first.tracks
        for other in second.tracks
    )
