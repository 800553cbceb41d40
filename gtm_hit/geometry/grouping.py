"""Which boxes of several views show the same person, where nobody says so."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

RADIUS = 0.5  # metres: two people hardly stand closer, and one seen twice hardly lies further apart


def group_by_place(points: Floats, weights: Floats, cameras: Ids, radius: float = RADIUS) -> Ids:
    """Groups, (M,) counted from 0, of ground points (M, 2) in metres seen by `cameras` (M,) at one instant.

    The nearest pairs are joined first. A group has one point of each camera at most, and joins another only
    while their weighted means are less than `radius` apart. Points that are NaN stay alone.
    """
    members = {index: {int(camera)} for index, camera in enumerate(cameras.tolist())}
    sums = np.column_stack((np.nan_to_num(points) * weights[:, None], weights))
    leader = np.arange(len(points))
    for first, second in _pairs(points, cameras, radius):
        one, other = int(leader[first]), int(leader[second])
        if one == other or members[one] & members[other]:
            continue
        apart = sums[one, :2] / sums[one, 2] - sums[other, :2] / sums[other, 2]
        if np.hypot(*apart) >= radius:
            continue
        members[one] |= members.pop(other)
        sums[one] += sums[other]
        leader[leader == other] = one
    return np.unique(leader, return_inverse=True)[1]


def same_ids_same_people(points: Floats, groups: Sequence[Hashable], radius: float = RADIUS) -> bool:
    """Whether ids mean the same person in every view.

    points : (M, 2) metres
    groups : (M,) what one person at one instant would share: frame and id

    They do where most points of a group lie together; where no group has two points, nothing says so.
    """
    by_group: dict[Hashable, list[int]] = defaultdict(list)
    for index, group in enumerate(groups):
        if not np.isnan(points[index, 0]):
            by_group[group].append(index)
    together = apart = 0
    for indices in by_group.values():
        if len(indices) > 1:
            away = np.hypot(*(points[indices] - np.median(points[indices], axis=0)).T)
            near = int((away < radius).sum())
            together, apart = together + near, apart + len(indices) - near
    return together > apart


def link(groups: Sequence[tuple[int, Sequence[Hashable]]]) -> list[int]:
    """Persons, counted from 0, of groups at several instants, told by the tracks they share.

    groups : the instant, and the tracks (camera and the id of that view) seen together in the group

    Tracks that were seen together most often are joined first, never two that are at one instant in
    different groups. A group without tracks is a person of its own.
    """
    parent: dict[Hashable, Hashable] = {}
    at: dict[Hashable, set[int]] = defaultdict(set)
    together: dict[tuple[Hashable, Hashable], int] = defaultdict(int)
    where: dict[tuple[int, Hashable], int] = {}
    for index, (instant, tracks) in enumerate(groups):
        for track in tracks:
            parent[track] = track
            at[track].add(instant)
            where[instant, track] = index
            if track != tracks[0]:
                together[tracks[0], track] += 1
    members = {track: [track] for track in parent}
    for first, second in sorted(together, key=lambda pair: -together[pair]):
        one, other = parent[first], parent[second]
        if one == other or _contradict(members[one], members[other], at, where):
            continue
        for track in members.pop(other):
            parent[track] = one
            members[one].append(track)
    return _numbered(groups, parent)


def _pairs(points: Floats, cameras: Ids, radius: float) -> list[tuple[int, int]]:
    """Points of different cameras closer than `radius`, the nearest first."""
    apart = np.hypot(points[:, None, 0] - points[None, :, 0], points[:, None, 1] - points[None, :, 1])
    first, second = np.nonzero(np.triu((apart < radius) & (cameras[:, None] != cameras), 1))
    order = np.argsort(apart[first, second], kind="stable")
    return list(zip(first[order].tolist(), second[order].tolist(), strict=True))


def _contradict(
    ones: Sequence[Hashable],
    others: Sequence[Hashable],
    at: dict[Hashable, set[int]],
    where: dict[tuple[int, Hashable], int],
) -> bool:
    return any(
        where[instant, one] != where[instant, other]
        for one in ones
        for other in others
        for instant in at[one] & at[other]
    )


def _numbered(
    groups: Sequence[tuple[int, Sequence[Hashable]]], parent: dict[Hashable, Hashable]
) -> list[int]:
    numbers: dict[Hashable, int] = {}
    taken: set[tuple[int, int]] = set()
    persons = []
    for index, (instant, tracks) in enumerate(groups):
        name: Hashable = parent[tracks[0]] if tracks else ("alone", index)
        number = numbers.setdefault(name, len(numbers))
        if (instant, number) in taken:  # the same track in two groups of an instant
            number = numbers.setdefault(("again", index), len(numbers))
        taken.add((instant, number))
        persons.append(number)
    return persons
