"""Neighbouring batches into chains of tracks, one chain per person: by common frames, else by motion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from gtm_hit.stitching.assigning import Answer, Pair, assign
from gtm_hit.stitching.merging import latest, merged
from gtm_hit.stitching.rules import Rules
from gtm_hit.stitching.scoring import log_odds
from gtm_hit.stitching.tracks import Batch, Floats, Source, Track
from gtm_hit.stitching.verdicts import Verdicts

TAIL = 16  # frames of a chain that are looked at when it is continued, at least
DECIDED = 1e3  # log odds of what somebody said


@dataclass(eq=False)
class Chain:
    """One person, track after track."""

    tracks: list[Track]
    tail: Track = field(init=False)
    sources: set[Source] = field(init=False)

    def __post_init__(self) -> None:
        self.tail, self.sources = self.tracks[-1], set(self.tracks[-1].sources)

    def append(self, track: Track) -> None:
        self.tracks.append(track)
        self.sources |= track.sources
        self.tail = latest(merged([self.tail, track]), max(TAIL, len(track.frames)))

    @property
    def first(self) -> int:
        return self.tracks[0].first

    @property
    def last(self) -> int:
        return self.tail.last


@dataclass(frozen=True, eq=False)
class Doubt:
    """A pair somebody has to decide about; it is left apart until then."""

    before: Track
    after: Track
    lead: float  # log odds for one person; less than 0 for two
    seconds: float  # between the two; 0 or less where they share frames


@dataclass(eq=False)
class Joined:
    chains: list[Chain] = field(default_factory=list)
    doubts: list[Doubt] = field(default_factory=list)
    joins: int = 0
    decided: int = 0  # of the joins, those somebody decided


def join(
    batches: Sequence[Batch],
    rules: Rules,
    verdicts: Verdicts | None = None,
    told: Callable[[int, int], object] = lambda done, total: None,
) -> Joined:
    """The batches' people as chains; the order of the batches does not matter, nor how anybody numbered."""
    joined, open_ends = Joined(), list[Chain]()
    ordered = sorted(batches, key=lambda one: (one.first, one.last))
    for done, batch in enumerate(ordered, start=1):
        open_ends = [chain for chain in open_ends if chain.last >= batch.first - rules.gap - 1]
        open_ends += _continue(joined, open_ends, batch, rules, verdicts or Verdicts())
        told(done, len(ordered))
    return joined


def _continue(
    joined: Joined, chains: Sequence[Chain], batch: Batch, rules: Rules, verdicts: Verdicts
) -> list[Chain]:
    """Append the batch's tracks to chains; the chains that begin with it."""
    tails = [chain.tail for chain in chains]
    odds = (
        log_odds(tails, batch.tracks, rules)
        if tails and batch.tracks
        else np.zeros((len(tails), len(batch.tracks)))
    )
    said = verdicts.between([chain.sources for chain in chains], [track.sources for track in batch.tracks])
    odds[said > 0], odds[said < 0] = DECIDED, -np.inf
    answer = assign(odds, rules.margin)
    continued = _append(joined, chains, batch, answer, said, rules)
    begun = [Chain([track]) for column, track in enumerate(batch.tracks) if column not in continued]
    joined.chains += begun
    return begun


def _append(
    joined: Joined, chains: Sequence[Chain], batch: Batch, answer: Answer, said: Floats, rules: Rules
) -> set[int]:
    sure = [pair for pair in answer.pairs if pair.lead >= rules.margin]
    asked = [pair for pair in answer.pairs if pair.lead < rules.margin]
    for pair in asked:
        joined.doubts.append(_doubt(chains[pair.row], batch.tracks[pair.column], pair.lead, rules))
    for pair in _with_nobody_else(answer, said):
        joined.doubts.append(_doubt(chains[pair.row], batch.tracks[pair.column], -pair.lead, rules))
    for pair in sure:
        chains[pair.row].append(batch.tracks[pair.column])
        joined.decided += bool(said[pair.row, pair.column] > 0)
    joined.joins += len(sure)
    return {pair.column for pair in sure}


def _with_nobody_else(answer: Answer, said: Floats) -> list[Pair]:
    """Refused pairs of two who both stay alone: of the others one is asked about already, or sure."""
    rows, columns = {pair.row for pair in answer.pairs}, {pair.column for pair in answer.pairs}
    return [
        pair
        for pair in answer.refused
        if pair.row not in rows and pair.column not in columns and not said[pair.row, pair.column]
    ]


def _doubt(chain: Chain, after: Track, lead: float, rules: Rules) -> Doubt:
    return Doubt(chain.tracks[-1], after, lead, (after.first - chain.last) * rules.seconds)
