"""What an annotator sees of the proposals: of his frames, with the numbers that his people have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gtm_hit.metrics.matching import match_places
from gtm_hit.models import Annotation, Frame, Layer, Proposal, ProposalRun
from gtm_hit.ops.frames.neighbours import Neighbours
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.frames.saving import rows_by_frame
from gtm_hit.ops.proposals import refusals, runs
from gtm_hit.vision.doubt import doubt
from gtm_hit.vision.link import FILLED, NOBODY, Floats, Ids, Places, for_pace, link
from gtm_hit.vision.people import Evidence

CERTAIN = 0.7  # of the score: below, somebody should look before it is accepted
SAME = 0.35  # metres between an annotation and the proposal of the same person


@dataclass(frozen=True)
class Proposed:
    """One proposal; `person` is the number its track has among the annotations, None for nobody yet."""

    id: int
    position: int
    height: float | None
    radius: float | None
    score: float
    doubt: float
    track: int
    person: int | None
    seated: bool
    filled: bool
    evidence: list[dict[str, Any]]


@dataclass(frozen=True)
class ProposedFrame:
    number: int
    people: list[Proposed]
    refused: list[int]  # positions


@dataclass(frozen=True)
class ForLayer:
    """`run` is None where nothing is proposed."""

    run: ProposalRun | None
    frames: list[ProposedFrame]


def for_layer(layer: Layer, frames: Sequence[Frame], beside: Neighbours) -> ForLayer:
    """With a fixed number of queries."""
    run = runs.in_use(layer.dataset)
    refused = refusals.refused_in(layer, [frame.pk for frame in frames])
    if run is None:
        return ForLayer(None, [])
    rows = _rows(run, frames)
    own = rows_by_frame(Annotation.objects.filter(layer=layer), [frame.pk for frame in frames])
    tracks, persons = _identities(layer, frames, rows, own, beside)
    people: dict[int, list[Proposed]] = {frame.pk: [] for frame in frames}
    for row, track in zip(rows, tracks.tolist(), strict=True):
        people[row.proposal_frame.frame_id].append(_proposed(row, track, persons.get(track)))
    return ForLayer(
        run,
        [ProposedFrame(frame.number, people[frame.pk], refused.get(frame.pk, [])) for frame in frames],
    )


def _rows(run: ProposalRun, frames: Sequence[Frame]) -> list[Proposal]:
    wanted = Proposal.objects.filter(proposal_frame__run=run, proposal_frame__frame__in=list(frames))
    return list(wanted.select_related("proposal_frame").order_by("-score", "pk"))


def _proposed(row: Proposal, track: int, person: int | None) -> Proposed:
    evidence = [Evidence(**{**each, "seen": _nan(each["seen"])}) for each in row.evidence]
    return Proposed(
        id=row.pk,
        position=row.position,
        height=row.height,
        radius=row.radius,
        score=row.score,
        doubt=doubt(row.score, evidence, row.certainty),
        track=track,
        person=person,
        seated=row.seated,
        filled=row.filled,
        evidence=row.evidence,
    )


def _nan(value: float | None) -> float:
    return float("nan") if value is None else value


@dataclass(frozen=True, eq=False)
class _Known:
    """People somebody marked, by the number of their frame."""

    frames: list[int]
    persons: list[int]
    positions: list[int]


def _identities(
    layer: Layer,
    frames: Sequence[Frame],
    rows: Sequence[Proposal],
    own: dict[int, list[Row]],
    beside: Neighbours,
) -> tuple[Ids, dict[int, int]]:
    """The track of each row, (N,), and the person of each track that has one.

    Where neighbours are accepted they are linked with the proposals and keep their numbers; else the run's
    own tracks hold. Annotations of the layer itself name the tracks they stand on.
    """
    number_of = {frame.pk: frame.number for frame in frames}
    known = _known(beside)
    time = {number: at for at, number in enumerate(sorted({*number_of.values(), *known.frames}))}
    at = np.array([time[number_of[row.proposal_frame.frame_id]] for row in rows], dtype=np.int64)
    xy = np.array([(row.x, row.y) for row in rows], dtype=np.float64).reshape(-1, 2)
    grid = layer.dataset.grid
    tracks = np.array([NOBODY if row.track is None else row.track for row in rows], dtype=np.int64)
    if known.frames:
        places = Places(
            np.concatenate((at, np.array([time[number] for number in known.frames], dtype=np.int64))),
            np.concatenate((xy, grid.metres(known.positions))),
            np.concatenate((np.full(len(rows), NOBODY), np.array(known.persons, dtype=np.int64))),
        )
        tracks = _linked(places, layer.dataset.seconds_per_frame)[: len(rows)]
    tracks = _each_named(tracks, max(known.persons, default=0))
    persons = {track: track for track in set(known.persons) & set(tracks.tolist())}
    mine = {time[number_of[pk]]: people for pk, people in own.items()}
    marked = {
        frame: grid.metres([one.position for one in people]) for frame, people in mine.items() if people
    }
    return tracks, persons | _named_by(mine, marked, at, xy, tracks)


def _known(beside: Neighbours) -> _Known:
    found = [(frame.number, row) for frame in (*beside.before, *beside.after) for row in frame.annotations]
    return _Known(
        [number for number, _row in found],
        [row.person for _number, row in found],
        [row.position for _number, row in found],
    )


def _linked(places: Places, seconds: float) -> Ids:
    """The track of each place, (N,); NOBODY for those linked to nobody."""
    linked = link(places, for_pace(seconds))
    tracks = np.full(len(places.frames), NOBODY)
    given = linked.rows != FILLED
    tracks[linked.rows[given]] = linked.tracks[given]
    return tracks


def _each_named(tracks: Ids, largest: int) -> Ids:
    """Those linked to nobody get numbers of their own, above all others."""
    alone = tracks == NOBODY
    free = max(int(tracks.max(initial=0)), largest) + 1
    named = tracks.copy()
    named[alone] = free + np.arange(int(alone.sum()))
    return named


def _named_by(
    own: dict[int, list[Row]], marked: dict[int, Floats], at: Ids, xy: Floats, tracks: Ids
) -> dict[int, int]:
    """The person most often marked where a track is."""
    votes: dict[tuple[int, int], int] = {}
    for frame, places in marked.items():
        there = np.flatnonzero(at == frame)
        first, second, _apart = match_places(places, xy[there], SAME)
        for one, other in zip(first.tolist(), second.tolist(), strict=True):
            pair = (int(tracks[there[other]]), own[frame][one].person)
            votes[pair] = votes.get(pair, 0) + 1
    return {track: person for (track, person), _count in sorted(votes.items(), key=lambda vote: vote[1])}
