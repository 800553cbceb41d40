"""What the tutorial gets wrong on purpose. Pure: true people in, prepared people out, always the same."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.grid import Grid
from gtm_hit.ops.errors import OperationError

SHIFT = 0.40  # metres the misplaced person stands off
LONELY = 1.0  # metres around the invented person where nobody is
SPACING = 0.5  # metres between the places tried for the invented person
LOOKED_AT = 100  # of those places, nearest the middle: projecting all takes ten times as long

Positions = dict[int, int]
"""Position by person."""

Views = Callable[[list[int], list[int]], NDArray[np.int64]]
"""In how many cameras somebody at each of the first positions is clearly seen, (N,), when people stand
at the others."""


class NoRoom(OperationError, ValueError):
    """Frames in which the tutorial's mistakes cannot be made: too few people, or too small a grid."""


@dataclass(frozen=True)
class Exercise:
    """Three frames: the first shows three boxes and wants three mistakes mended, the second everybody, two of
    them where they were before."""

    numbers: list[int]
    truth: list[Positions]
    missing: int  # in the truth of the first frame, the one who is to be marked
    right: int  # shown in the first frame where they stand
    shifted: int  # shown `SHIFT` metres off, carried over
    shifted_to: int
    invented: int  # shown where nobody is
    invented_at: int
    carried: list[int]  # shown in the second frame where they were in the first

    def shown(self, index: int) -> Positions:
        if index == 0:
            right = self.truth[0][self.right]
            return {self.right: right, self.shifted: self.shifted_to, self.invented: self.invented_at}
        people = dict(self.truth[index])
        if index == 1:
            people |= {person: self.truth[0][person] for person in self.carried}
        return people

    def yellow(self, index: int) -> set[int]:
        return {0: {self.shifted}, 1: set(self.carried)}.get(index, set())

    @property
    def next_person(self) -> int:
        return max(self.invented, *(person for people in self.truth for person in people)) + 1


def has_people(truth: list[Positions]) -> bool:
    return len(truth) == 3 and len(truth[0]) >= 3 and len(truth[0].keys() & truth[1].keys()) >= 2


def make_exercise(numbers: list[int], truth: list[Positions], grid: Grid, views: Views) -> Exercise:
    """Raises NoRoom."""
    if not has_people(truth):
        raise NoRoom("the tutorial needs three frames and three people")
    first, second = truth[0], truth[1]
    missing, shifted, right = clearest(first, grid, views)[:3]
    draft = Exercise(
        numbers=numbers,
        truth=truth,
        missing=missing,
        right=right,
        shifted=shifted,
        shifted_to=beside(shifted, first, grid),
        invented=unused_number(truth),
        invented_at=0,
        carried=walkers(first, second, grid, views)[:2],
    )
    return replace(draft, invented_at=empty_place(first, grid, views))


def unused_number(truth: list[Positions]) -> int:
    """The smallest: the largest number would be the one that catches the eye."""
    used = {person for people in truth for person in people}
    return next(number for number in range(1, len(used) + 2) if number not in used)


def clearest(people: Positions, grid: Grid, views: Views) -> list[int]:
    """People easiest to judge first: clear in many cameras, far from everybody else."""
    persons = sorted(people)
    places = [people[person] for person in persons]
    apart = between(places, places, grid)
    np.fill_diagonal(apart, np.inf)
    nearest = np.minimum(apart.min(axis=1), 2.0)
    order = np.lexsort((np.array(persons), -nearest, -views(places, places)))
    return [persons[index] for index in order]


def walkers(before: Positions, after: Positions, grid: Grid, views: Views) -> list[int]:
    """People of both frames, those first who are clear in many cameras and moved most."""
    persons = sorted(before.keys() & after.keys())
    places = [after[person] for person in persons]
    moved = np.diag(between([before[person] for person in persons], places, grid))
    order = np.lexsort((np.array(persons), -moved, -views(places, sorted(after.values()))))
    return [persons[index] for index in order]


def beside(person: int, people: Positions, grid: Grid) -> int:
    """A position `SHIFT` metres away, on the side where nobody is near."""
    here = grid.metres([people[person]])[0]
    angles = np.arange(8) * np.pi / 4
    candidates = grid.position(here + SHIFT * np.column_stack((np.cos(angles), np.sin(angles))))
    candidates = candidates[candidates >= 0]
    if not len(candidates):
        raise NoRoom(f"a grid of {grid.extent} metres has no room for the tutorial's mistakes")
    others = [place for other, place in people.items() if other != person]
    room = between(candidates.tolist(), others, grid).min(axis=1)
    return int(candidates[np.argmax(room)])


def empty_place(people: Positions, grid: Grid, views: Views) -> int:
    """A clear position amid the people, with nobody within `LONELY` metres if there is such a place."""
    others = sorted(people.values())
    points = grid.metres(others)
    low, high = points.min(axis=0), points.max(axis=0)
    axes = [np.arange(low[axis], high[axis] + SPACING, SPACING) for axis in (0, 1)]
    tried = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    candidates = np.unique(grid.nearest(tried))
    room = between(candidates.tolist(), others, grid).min(axis=1)
    lonely = candidates[room >= LONELY]
    if not len(lonely):
        return int(candidates[np.argmax(room)])
    from_middle = np.linalg.norm(grid.metres(lonely) - points.mean(axis=0), axis=1)
    tried_first = lonely[np.argsort(from_middle, kind="stable")[:LOOKED_AT]]
    return int(tried_first[np.argmax(views(tried_first.tolist(), others))])


def between(ours: list[int], others: list[int], grid: Grid) -> NDArray[np.float64]:
    """Ground distances in metres, (ours, others)."""
    return np.linalg.norm(grid.metres(ours)[:, None] - grid.metres(others)[None], axis=2)
