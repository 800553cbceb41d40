"""Taking out what a worker left of planted faults, so that nobody ever learns from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.scoring.faults import (
    Fault,
    FaultKind,
    Frames,
    Positions,
    apart,
    found_again,
    leftovers,
    repaired,
)


@dataclass(frozen=True)
class Change:
    """One person of one frame as he is to be: None removes him; `was` is the number he had."""

    frame: int
    was: int | None  # None: he is added
    person: int | None
    position: int | None


def changes(faults: Sequence[Fault], right: Frames, now: Frames, grid: Grid) -> dict[Fault, list[Change]]:
    """What has to change for every fault that was not repaired; an empty list where nothing is left of it."""
    return {
        fault: _undo(fault, right, now, grid)
        for fault in faults
        if fault.frame in now and not repaired(fault, right, now, grid)
    }


def _undo(fault: Fault, right: Frames, now: Frames, grid: Grid) -> list[Change]:
    match fault.kind:
        case FaultKind.SHIFTED:
            return _moved_back(fault, right[fault.frame], now[fault.frame], grid)
        case FaultKind.REMOVED:
            return [Change(fault.frame, None, _number(fault, right, now, grid), fault.right)]
        case FaultKind.INVENTED:
            gone = leftovers(fault, right[fault.frame], now[fault.frame], grid)
            return [Change(fault.frame, person, None, None) for person in gone]
    later = [number for number in sorted(now) if number >= fault.frame]
    return [change for number in later for change in _named_back(fault, number, right, now, grid)]


def _moved_back(fault: Fault, right: Positions, now: Positions, grid: Grid) -> list[Change]:
    """Whoever stands nearer to the wrong place than half the way back, and is nobody else."""
    assert fault.right is not None and fault.wrong is not None
    others = {person: place for person, place in right.items() if person != fault.person}
    taken = set(found_again(others, {p: at for p, at in now.items() if p != fault.person}, grid).values())
    half = apart(grid, fault.right, fault.wrong) / 2
    near = [
        (apart(grid, place, fault.wrong), person)
        for person, place in now.items()
        if person not in taken and apart(grid, place, fault.wrong) <= min(half, RADIUS)
    ]
    return [Change(fault.frame, min(near)[1], min(near)[1], fault.right)] if near else []


def _named_back(fault: Fault, number: int, right: Frames, now: Frames, grid: Grid) -> list[Change]:
    """The numbers exchanged once more, in every frame in which they still are."""
    assert fault.other is not None
    before = max((frame for frame in right if frame < fault.frame), default=None)
    if before is None or number not in right:
        return []
    was = found_again(right[before], now.get(before, {}), grid)
    names = found_again(right[number], now[number], grid)
    one, other = was.get(fault.person), was.get(fault.other)
    if one is None or other is None:
        return []
    exchanged = {one: other, other: one}
    back = [
        (name, old)
        for name, old in ((names.get(fault.person), one), (names.get(fault.other), other))
        if name is not None and name != old and exchanged.get(old) == name
    ]
    used = set(now[number]) - {name for name, _old in back}
    return [Change(number, name, old, now[number][name]) for name, old in back if old not in used]


def _number(fault: Fault, right: Frames, now: Frames, grid: Grid) -> int:
    """The one he goes by in the nearest frame that has him, else his own, else one that nobody has."""
    here = now[fault.frame]
    nearest_first = sorted(right.keys() & now.keys(), key=lambda number: abs(number - fault.frame))
    names = [found_again(right[number], now[number], grid).get(fault.person) for number in nearest_first]
    wishes = [name for name in [*names, fault.person] if name is not None and name not in here]
    return wishes[0] if wishes else max(one for people in now.values() for one in people) + 1


def changed(now: Positions, made: Sequence[Change]) -> Positions:
    """The people of one frame after its changes."""
    kept = {person: place for person, place in now.items() if person not in {one.was for one in made}}
    return kept | {
        one.person: one.position for one in made if one.person is not None and one.position is not None
    }
