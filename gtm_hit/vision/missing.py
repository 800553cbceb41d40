"""Who is missing in finished annotations, or should not be there: places worth a second look.

Frames are counted 0, 1, 2 … along time; places are metres on the ground.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gtm_hit.metrics.matching import distances_between, match_places

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
Flags = NDArray[np.bool_]


class Why(StrEnum):
    PROPOSED = "proposed"  # somebody seems to stand where nobody is marked
    HOLE = "hole"  # marked before and after, not in between
    ENDS = "ends"  # marked until here, and not at the border
    UNSUPPORTED = "unsupported"  # marked where no view shows anybody
    STILL = "still"  # marked at the same place, while whoever stood there has walked on


@dataclass(frozen=True)
class MissingSettings:
    score: float = 0.5  # from which on a proposal counts
    alone: float = 0.8  # the same of a proposal that no other frame confirms
    faint: float = 0.2  # enough to confirm what tracks say
    near: float = 0.5  # metres between somebody marked and proposed
    around: float = 1.0  # metres that a prediction may be off
    gap: int = 4  # frames of a hole
    border: float = 1.5  # metres from the border of the area: who is nearer may have left
    stood: float = 0.03  # metres: less is no step
    walked: float = 0.4  # metres: as much is one
    short: int = 3  # frames of a track that others confirm


@dataclass(frozen=True, eq=False)
class Marked:
    """Annotations; `seen` says whether any view shows somebody there, None where nobody knows."""

    frames: Ids
    xy: Floats
    persons: Ids
    seen: Flags | None = None


@dataclass(frozen=True, eq=False)
class Seen:
    """Proposals; tracks are NOBODY (-1) for those without."""

    frames: Ids
    xy: Floats
    scores: Floats
    tracks: Ids


@dataclass(frozen=True)
class Area:
    """The rectangle in which people are marked, metres."""

    west: float
    south: float
    east: float
    north: float

    def inside(self, x: float, y: float) -> float:
        """Metres to the border; negative outside."""
        return min(x - self.west, self.east - x, y - self.south, self.north - y)


@dataclass(frozen=True)
class Case:
    why: Why
    frame: int
    x: float
    y: float
    person: int | None
    weight: float  # 0 to 1: how likely something is wrong


def find(
    marked: Marked, seen: Seen, frames: int, area: Area, settings: MissingSettings | None = None
) -> list[Case]:
    """Everything worth a look in `frames` frames, the likeliest first; of one place only the likeliest."""
    settings = settings or MissingSettings()
    cases = [
        *_proposed(marked, seen, settings),
        *_tracks(marked, seen, frames, area, settings),
        *_unsupported(marked, seen, settings),
        *_still(marked, seen, settings),
    ]
    return _each_place_once(cases, settings)


def _proposed(marked: Marked, seen: Seen, settings: MissingSettings) -> Iterator[Case]:
    lengths = _lengths(seen.tracks)
    for frame in np.unique(seen.frames).tolist():
        there = np.flatnonzero((seen.frames == frame) & (seen.scores >= settings.score))
        if not len(there):
            continue
        people = marked.xy[marked.frames == frame]
        for row in there[_unmarked(people, seen.xy[there], settings)].tolist():
            confirmed = lengths.get(int(seen.tracks[row]), 1) >= settings.short
            if confirmed or seen.scores[row] >= settings.alone:
                yield _case(Why.PROPOSED, frame, seen.xy[row], None, float(seen.scores[row]))


def _unmarked(people: Floats, places: Floats, settings: MissingSettings) -> Ids:
    """Rows of the places where nobody is marked.

    Somebody marked whom no place is near is taken for whoever is proposed a step beside: programs misplace
    people more often than they see one twice.
    """
    left, open_places = np.arange(len(people)), np.arange(len(places))
    for metres in (settings.near, settings.around):
        if len(left) and len(open_places):
            first, second, _apart = match_places(people[left], places[open_places], metres)
            left, open_places = np.delete(left, first), np.delete(open_places, second)
    return open_places


def _lengths(tracks: Ids) -> dict[int, int]:
    each, counts = np.unique(tracks[tracks >= 0], return_counts=True)
    return dict(zip(each.tolist(), counts.tolist(), strict=True))


def _tracks(marked: Marked, seen: Seen, frames: int, area: Area, settings: MissingSettings) -> Iterator[Case]:
    for person in np.unique(marked.persons).tolist():
        rows = np.flatnonzero(marked.persons == person)
        rows = rows[np.argsort(marked.frames[rows])]
        for before, after in pairwise(rows.tolist()):
            missing = int(marked.frames[after] - marked.frames[before]) - 1
            if 0 < missing <= settings.gap:
                yield from _hole(marked, before, after, person)
        if len(rows) > 1:
            yield from _ends(marked, seen, rows, frames, area, settings)
            yield from _ends(marked, seen, rows[::-1], frames, area, settings)


def _hole(marked: Marked, before: int, after: int, person: int) -> Iterator[Case]:
    first, last = int(marked.frames[before]), int(marked.frames[after])
    for frame in range(first + 1, last):
        part = (frame - first) / (last - first)
        xy = marked.xy[before] * (1 - part) + marked.xy[after] * part
        yield _case(Why.HOLE, frame, xy, person, 0.9)


def _ends(
    marked: Marked, seen: Seen, rows: Ids, frames: int, area: Area, settings: MissingSettings
) -> Iterator[Case]:
    """The last of `rows`, whichever way they run: somebody should be in the next frame, and is confirmed."""
    last, before = int(rows[-1]), int(rows[-2])
    pace = int(marked.frames[last] - marked.frames[before])
    frame = int(marked.frames[last]) + (1 if pace > 0 else -1)
    x, y = marked.xy[last] + (marked.xy[last] - marked.xy[before]) / abs(pace)
    if not 0 <= frame < frames or area.inside(x, y) < settings.border:
        return
    place = np.array([[x, y]])
    if _any_near(place, marked.xy[marked.frames == frame], settings.near):
        return  # there under another number
    there = (seen.frames == frame) & (seen.scores >= settings.faint)
    if _any_near(place, seen.xy[there], settings.around):
        yield _case(Why.ENDS, frame, place[0], int(marked.persons[last]), 0.6)


def _unsupported(marked: Marked, seen: Seen, settings: MissingSettings) -> Iterator[Case]:
    if marked.seen is None:
        return
    for row in np.flatnonzero(~marked.seen).tolist():
        frame = int(marked.frames[row])
        if not _any_near(marked.xy[row][None], seen.xy[seen.frames == frame], settings.around):
            yield _case(Why.UNSUPPORTED, frame, marked.xy[row], int(marked.persons[row]), 0.4)


def _still(marked: Marked, seen: Seen, settings: MissingSettings) -> Iterator[Case]:
    at = {
        (person, frame): row
        for row, (person, frame) in enumerate(
            zip(marked.persons.tolist(), marked.frames.tolist(), strict=True)
        )
    }
    of_track = {
        (track, frame): row
        for row, (track, frame) in enumerate(zip(seen.tracks.tolist(), seen.frames.tolist(), strict=True))
        if track >= 0
    }
    by_frame: dict[int, list[int]] = defaultdict(list)
    for row, frame in enumerate(seen.frames.tolist()):
        by_frame[frame].append(row)
    for (person, frame), row in at.items():
        before = at.get((person, frame - 1))
        if before is None or np.hypot(*(marked.xy[row] - marked.xy[before])) > settings.stood:
            continue
        walked = _walked_on(seen, by_frame, of_track, marked.xy[row], frame, settings)
        if walked is not None:
            yield _case(Why.STILL, frame, marked.xy[row], person, 0.5)


def _walked_on(
    seen: Seen,
    by_frame: dict[int, list[int]],
    of_track: dict[tuple[int, int], int],
    place: Floats,
    frame: int,
    settings: MissingSettings,
) -> int | None:
    """The row of whoever stood there in the frame before and is somewhere else now."""
    if _any_near(place[None], seen.xy[by_frame[frame]], settings.near):
        return None
    for row in by_frame[frame - 1]:
        now = of_track.get((int(seen.tracks[row]), frame))
        near = np.hypot(*(seen.xy[row] - place)) < settings.near
        if not near or now is None or np.hypot(*(seen.xy[now] - seen.xy[row])) < settings.walked:
            continue
        later = of_track.get((int(seen.tracks[row]), frame + 1))
        if later is None or np.hypot(*(seen.xy[later] - place)) >= settings.near:
            return now  # else they were seen beside their place once
    return None


def _any_near(place: Floats, others: Floats, metres: float) -> bool:
    return bool(len(others)) and bool((distances_between(place, others) < metres).any())


def _case(why: Why, frame: int, xy: Floats, person: int | None, weight: float) -> Case:
    return Case(why, frame, float(xy[0]), float(xy[1]), person, weight)


def _each_place_once(cases: list[Case], settings: MissingSettings) -> list[Case]:
    """Likeliest first; of cases that say the same of a place the others go."""
    kept: list[Case] = []
    by_frame: dict[int, list[Case]] = defaultdict(list)
    for case in sorted(cases, key=lambda one: (-one.weight, one.frame, one.x, one.y)):
        others = by_frame[case.frame]
        about_nobody = case.why in {Why.UNSUPPORTED, Why.STILL}
        if about_nobody or not any(_same(case, other, settings) for other in others):
            kept.append(case)
            others.append(case)
    return kept


def _same(case: Case, other: Case, settings: MissingSettings) -> bool:
    """A prediction and the proposal that it is about; two proposals are two people."""
    if case.person is not None and case.person == other.person:
        return True
    if case.why == other.why:
        return False
    return bool(np.hypot(case.x - other.x, case.y - other.y) < settings.around)
