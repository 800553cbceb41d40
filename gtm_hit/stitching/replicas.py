"""Who is who among workers who annotated the same frames, each with a numbering of his own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gtm_hit.metrics.matching import match_places
from gtm_hit.stitching.tracks import Batch, Floats, Source, Track


@dataclass(frozen=True, eq=False)
class Point:
    """One worker's annotation of one person in one frame."""

    replica: int
    source: Source
    xy: Floats  # (2,) metres
    moved: bool = False  # stands here under an identity that elsewhere is somebody else's


People = dict[int, list[Point]]  # one person's annotations by frame, one per replica at most
_Member = tuple[int, Track]


def same_people(replicas: Sequence[Batch], gate: float) -> list[People]:
    """Everybody who was annotated; tracks first, then single places that stray from their track's person."""
    people = [_points(group) for group in _grouped(replicas, gate)]
    for frame in sorted({frame for person in people for frame in person}):
        _regroup(people, frame, len(replicas), gate)
    return [person for person in people if person]


def _grouped(replicas: Sequence[Batch], gate: float) -> list[list[_Member]]:
    """Tracks that are together in most of their common frames, the closest company first."""
    members = [(number, track) for number, replica in enumerate(replicas) for track in replica.tracks]
    groups = {index: [member] for index, member in enumerate(members)}
    leader = list(range(len(members)))
    for _, one, other in sorted(_company(members, gate)):
        first, second = sorted((leader[one], leader[other]))
        if first == second or _overlapping(groups[first], groups[second]):
            continue
        groups[first] += groups.pop(second)
        leader = [first if each == second else each for each in leader]
    return list(groups.values())


def _company(members: Sequence[_Member], gate: float) -> list[tuple[tuple[float, float], int, int]]:
    found = []
    for one, other in _near(members, gate):
        apart = _apart(members[one][1], members[other][1])
        together = int((apart < gate).sum())
        if together * 2 > len(apart):
            found.append(((-float(together), float(np.minimum(apart, gate).mean())), one, other))
    return found


def _near(members: Sequence[_Member], gate: float) -> list[tuple[int, int]]:
    """Pairs of different workers whose tracks' boxes on the ground touch while both are there."""
    if not members:
        return []
    replica = np.array([number for number, _ in members])
    low = np.array([[track.first, *track.xy.min(axis=0)] for _, track in members])
    high = np.array([[track.last, *track.xy.max(axis=0)] for _, track in members])
    touching = (low[:, None] <= high[None] + np.array([0.0, gate, gate])).all(axis=2)
    pairs = np.argwhere(np.triu(touching & touching.T & (replica[:, None] != replica), 1))
    return [(one, other) for one, other in pairs.tolist()]


def _apart(one: Track, other: Track) -> Floats:
    _, rows, others = np.intersect1d(one.frames, other.frames, assume_unique=True, return_indices=True)
    distances: Floats = np.hypot(*(one.xy[rows] - other.xy[others]).T)
    return distances


def _overlapping(ones: Sequence[_Member], others: Sequence[_Member]) -> bool:
    """One worker has both at once: they are two people."""
    return any(
        replica == number and len(np.intersect1d(one.frames, other.frames, assume_unique=True))
        for replica, one in ones
        for number, other in others
    )


def _points(group: Sequence[_Member]) -> People:
    person: People = {}
    for replica, track in group:
        for frame, xy, vote in zip(track.frames.tolist(), track.xy, track.votes, strict=True):
            person.setdefault(frame, []).append(Point(replica, vote[0], xy))
    return person


def _regroup(people: list[People], frame: int, count: int, gate: float) -> None:
    """Give places that stray from their person to whom they stand with, or to somebody of their own.

    Also places of nobody else: a worker who swapped two people has their tracks with neither of them.
    """
    strayed = [point for person in people for point in _strayed(person, frame, gate)]
    for replica in range(count):
        alone = [person[frame][0] for person in people if len(person.get(frame, [])) == 1]
        mine = [point for point in strayed + alone if point.replica == replica]
        if not mine:
            continue
        housed = _rehouse(people, frame, mine, gate)
        people += [{frame: [point]} for point in mine if point in strayed and point not in housed]
        for person in people:
            if len(points := person.get(frame, [])) == 1 and points[0] in housed:
                del person[frame]


def _strayed(person: People, frame: int, gate: float) -> list[Point]:
    """Takes them out of the person."""
    points = person.get(frame, [])
    if len(points) < 2:
        return []
    middle = points[0].xy if len(points) == 2 else np.median([point.xy for point in points], axis=0)
    far = [point for point in points if np.hypot(*(point.xy - middle)) >= gate]
    person[frame] = [point for point in points if point not in far]
    if not person[frame]:
        del person[frame]
    return far


def _rehouse(people: list[People], frame: int, points: list[Point], gate: float) -> list[Point]:
    """Put one worker's points to people whom others have there and he has not; those that found a place."""
    replica = points[0].replica
    free = [
        person
        for person in people
        if person.get(frame) and all(point.replica != replica for point in person[frame])
    ]
    if not free:
        return []
    places = np.stack([np.mean([point.xy for point in person[frame]], axis=0) for person in free])
    rows, columns, _ = match_places(np.stack([point.xy for point in points]), places, gate)
    for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
        free[column][frame].append(replace(points[row], moved=True))
    return [points[row] for row in rows.tolist()]
