"""Deliberate errors in the people a batch starts with: made, found again, taken back. Pure and seeded.

Frames are given as positions by person, by frame number. Whether one was repaired is judged by places
on the ground, whatever numbers people go by then.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.annotations import Floats
from gtm_hit.metrics.matching import RADIUS, match_places

SHIFTS = (0.25, 0.50)  # metres a shifted person stands off
ROOM = 0.5  # metres around a shifted person where nobody else is
LONELY = 1.0  # metres around an invented person where nobody is
NEIGHBOURS = 3.0  # metres between two whose numbers can be mixed up
ANGLES = 16
PLACES = 200  # tried for an invented person

Positions = dict[int, int]
Frames = Mapping[int, Positions]


class FaultKind(StrEnum):
    SHIFTED = "shifted"
    REMOVED = "removed"
    SWAPPED = "swapped"
    INVENTED = "invented"


ALL_KINDS = tuple(FaultKind)


@dataclass(frozen=True)
class Fault:
    kind: FaultKind
    frame: int  # number; a swap lasts from there to the end
    person: int
    other: int | None = None  # of a swap
    right: int | None = None  # position; None: nobody is there
    wrong: int | None = None  # position; None: removed


def plant(
    frames: Frames, grid: Grid, kinds: Sequence[FaultKind], count: int, rng: np.random.Generator
) -> list[Fault]:
    """At most `count` faults, in different frames as long as there are any, of different people.

    Fewer where there is no room for more: an invented person takes an empty place, a swap two neighbours.
    """
    made: list[Fault] = []
    order = [int(number) for number in rng.permutation(sorted(frames))]
    wishes = [kinds[int(index)] for index in rng.integers(len(kinds), size=count)] if kinds else []
    for index, wish in enumerate(wishes):
        touched = {person for fault in made for person in (fault.person, fault.other)}
        for number in order[index % len(order) :] + order[: index % len(order)] if order else []:
            one = _make(wish, number, frames, grid, touched, rng)
            if one is not None:
                made.append(one)
                break
    return sorted(made, key=lambda fault: (fault.frame, fault.person))


def _make(
    kind: FaultKind,
    number: int,
    frames: Frames,
    grid: Grid,
    touched: set[int | None],
    rng: np.random.Generator,
) -> Fault | None:
    people = frames[number]
    free = [int(person) for person in rng.permutation(sorted(people.keys() - touched))]
    if kind is FaultKind.REMOVED:
        return Fault(kind, number, free[0], right=people[free[0]]) if free else None
    if kind is FaultKind.SHIFTED:
        return _shift(number, people, free, grid, rng)
    if kind is FaultKind.SWAPPED:
        return _swap(number, frames, free, grid)
    return _invent(number, frames, grid, touched, rng)


def _shift(
    number: int, people: Positions, free: list[int], grid: Grid, rng: np.random.Generator
) -> Fault | None:
    for person in free:
        here = grid.metres([people[person]])[0]
        angles = rng.permutation(ANGLES) * 2 * np.pi / ANGLES
        reach = rng.uniform(*SHIFTS)
        places = grid.position(here + reach * np.column_stack((np.cos(angles), np.sin(angles))))
        others = [place for one, place in people.items() if one != person]
        for place in places[places >= 0].tolist():
            if _nearest(grid, place, others) >= ROOM and place != people[person]:
                return Fault(FaultKind.SHIFTED, number, person, right=people[person], wrong=place)
    return None


def _swap(number: int, frames: Frames, free: list[int], grid: Grid) -> Fault | None:
    """Of two who were there in the frame before as well: otherwise nobody could tell."""
    earlier = [frame for frame in sorted(frames) if frame < number]
    if not earlier:
        return None
    before, people = frames[earlier[-1]], frames[number]
    both = [person for person in free if person in before]
    for person in both:
        others = [one for one in both if one != person]
        gaps = [apart(grid, people[person], people[one]) for one in others]
        if others and min(gaps) <= NEIGHBOURS:
            other = others[int(np.argmin(gaps))]
            return Fault(FaultKind.SWAPPED, number, person, other, people[person], people[other])
    return None


def _invent(
    number: int, frames: Frames, grid: Grid, touched: set[int | None], rng: np.random.Generator
) -> Fault | None:
    people = list(frames[number].values())
    if not people:
        return None
    points = grid.metres(people)
    tried = rng.uniform(points.min(axis=0) - 1, points.max(axis=0) + 1, (PLACES, 2))
    used = {person for one in frames.values() for person in one} | (touched - {None})
    for place in grid.position(tried).tolist():
        if place >= 0 and _nearest(grid, place, people) >= LONELY:
            return Fault(FaultKind.INVENTED, number, _unused(used, rng), wrong=place)
    return None


def _unused(used: set[int | None], rng: np.random.Generator) -> int:
    """Anywhere among the numbers there are: the largest would be the one that catches the eye."""
    largest = max(number for number in used if number is not None)
    free = [number for number in range(1, largest + 4) if number not in used]
    return int(rng.choice(free))


def planted(frames: Frames, faults: Sequence[Fault]) -> dict[int, Positions]:
    """The frames with the faults in them."""
    return _put(frames, faults, lambda fault: fault.wrong)


def unplanted(shown: Frames, faults: Sequence[Fault]) -> dict[int, Positions]:
    """What was there before the faults were planted: the way back of `planted`."""
    return _put(shown, faults, lambda fault: fault.right)


def _put(
    frames: Frames, faults: Sequence[Fault], place: Callable[[Fault], int | None]
) -> dict[int, Positions]:
    """Each fault's person at `place`, nowhere where there is none; a swap undoes itself."""
    put = {number: dict(people) for number, people in frames.items()}
    for fault in faults:
        where = place(fault)
        if fault.kind is FaultKind.SWAPPED:
            for number in put:
                if number >= fault.frame:
                    _exchange(put[number], fault.person, fault.other)
        elif where is None:
            put[fault.frame].pop(fault.person, None)
        else:
            put[fault.frame][fault.person] = where
    return put


def repaired(fault: Fault, right: Frames, now: Frames, grid: Grid) -> bool:
    """Whether the worker's people `now` stand where they should; `right` is what was true before planting."""
    people = now.get(fault.frame, {})
    match fault.kind:
        case FaultKind.SHIFTED:
            assert fault.right is not None and fault.wrong is not None
            half = apart(grid, fault.right, fault.wrong) / 2
            return _nearest(grid, fault.right, list(people.values())) <= half
        case FaultKind.REMOVED:
            return fault.person in found_again(right[fault.frame], people, grid)
        case FaultKind.INVENTED:
            return not leftovers(fault, right[fault.frame], people, grid)
    return all(went_on(person, fault.frame, right, now, grid) for person in (fault.person, fault.other))


def found_again(right: Positions, now: Positions, grid: Grid) -> dict[int, int]:
    """The worker's number of everybody of `right` whom he has, by person."""
    persons, numbers = list(right), list(now)
    if not persons or not numbers:
        return {}
    rows, columns, _ = match_places(
        grid.metres(list(right.values())), grid.metres(list(now.values())), RADIUS
    )
    return {persons[row]: numbers[column] for row, column in zip(rows, columns, strict=True)}


def leftovers(fault: Fault, right: Positions, now: Positions, grid: Grid) -> list[int]:
    """Numbers of those who stand where nobody is, and are nobody else."""
    assert fault.wrong is not None
    known = set(found_again(right, now, grid).values())
    there = [(person, place) for person, place in now.items() if person not in known]
    return [person for person, place in there if apart(grid, place, fault.wrong) < RADIUS]


def went_on(person: int | None, number: int, right: Frames, now: Frames, grid: Grid) -> bool:
    """Whether a person goes by the number he had in the frame before, from frame `number` to the end."""
    assert person is not None
    before = max((frame for frame in right if frame < number), default=None)
    if before is None:
        return True
    was = found_again(right[before], now.get(before, {}), grid).get(person)
    later = [frame for frame in now if frame >= number and frame in right]
    names = [found_again(right[frame], now[frame], grid).get(person, was) for frame in later]
    return was is not None and all(name == was for name in names)


def _exchange(people: Positions, one: int, other: int | None) -> None:
    assert other is not None
    places = people.pop(one, None), people.pop(other, None)
    if places[0] is not None:
        people[other] = places[0]
    if places[1] is not None:
        people[one] = places[1]


def apart(grid: Grid, one: int, other: int) -> float:
    first, second = grid.metres([one, other])
    return float(np.hypot(*(first - second)))


def _nearest(grid: Grid, place: int, others: list[int]) -> float:
    if not others:
        return float("inf")
    differences: Floats = grid.metres(others) - grid.metres([place])[0]
    return float(np.hypot(differences[:, 0], differences[:, 1]).min())
