"""What a saved frame must look like. All problems of a frame are found at once, with their places."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from django.utils.translation import gettext as _

from gtm_hit.formats.problems import MOST_PROBLEMS, shown
from gtm_hit.geometry.cylinder import HEIGHTS, RADII
from gtm_hit.geometry.grid import Grid
from gtm_hit.models import Annotation

MAX_PEOPLE = 500
MAX_PERSON = 2**31 - 1  # PostgreSQL's integer
MAX_SECONDS = 24 * 3600.0

Row = dict[str, Any]
"""person, position, state, origin, height, radius: the order in which rows are stored and sent."""


@dataclass(frozen=True)
class FrameProblem:
    place: str
    reason: str


class FrameProblems(list[FrameProblem]):
    """Collects what is wrong; gives up at once when there is too much to be worth listing."""

    def tell(self, place: str, reason: str) -> None:
        if len(self) == MOST_PROBLEMS:
            reason = _("more than %(count)d problems, the rest is not listed") % {"count": MOST_PROBLEMS}
            raise InvalidFrame([*self, FrameProblem("annotations", reason)])
        self.append(FrameProblem(place, reason))


class InvalidFrame(ValueError):
    """A frame that cannot be saved; `problems` lists everything that is wrong with it."""

    def __init__(self, problems: list[FrameProblem]) -> None:
        super().__init__("; ".join(f"{problem.place}: {problem.reason}" for problem in problems))
        self.problems = problems


def checked(
    annotations: object, grid: Grid, *, done: bool, nobody: bool, seconds: object
) -> tuple[list[Row], float]:
    """The annotations by person, every key present, and the seconds; raises InvalidFrame."""
    problems = FrameProblems()
    rows: list[Row] = []
    if not isinstance(annotations, Sequence) or isinstance(annotations, str | bytes):
        problems.tell("annotations", _("must be a list"))
    elif len(annotations) > MAX_PEOPLE:
        reason = _("at most %(count)d people fit in a frame") % {"count": MAX_PEOPLE}
        problems.tell("annotations", reason)
    else:
        for index, annotation in enumerate(annotations):
            rows.append(checked_row(annotation, f"annotations[{index}]", grid, problems))
        tell_repeated(rows, problems)
    if not is_number(seconds, 0, MAX_SECONDS):
        problems.tell("seconds", _("must be a number of seconds within one day"))
    if not problems:
        problems += done_problems(rows, done=done, nobody=nobody)
    if problems:
        raise InvalidFrame(problems)
    return sorted(rows, key=lambda row: row["person"]), float(seconds)  # type: ignore[arg-type]


def checked_row(annotation: object, place: str, grid: Grid, problems: FrameProblems) -> Row:
    if not isinstance(annotation, Mapping):
        problems.tell(place, _("must be an object"))
        return {"person": None}
    for key in annotation.keys() - {"person", "position", "state", "origin", "height", "radius"}:
        # shown(): a lone surrogate or a megabyte from the sender must not break the answer.
        problems.tell(place, _("unknown key %(key)s") % {"key": shown(key)})

    def check(key: str, fine: bool, reason: str) -> None:
        if not fine:
            problems.tell(f"{place}.{key}", reason)

    person, position = annotation.get("person"), annotation.get("position")
    state = annotation.get("state", Annotation.State.VALIDATED.value)
    origin = annotation.get("origin", Annotation.Origin.CLICKED.value)
    height, radius = annotation.get("height"), annotation.get("radius")
    check("person", is_whole(person, MAX_PERSON), _("must be a whole number from 0"))
    check(
        "position",
        is_whole(position, grid.count - 1),
        _("must be a position of the grid, 0 to %(last)d") % {"last": grid.count - 1},
    )
    check("state", is_choice(state, Annotation.State.values), one_of(Annotation.State.values))
    check("origin", is_choice(origin, Annotation.Origin.values), one_of(Annotation.Origin.values))
    check("height", height is None or is_number(height, *HEIGHTS), metres_between(*HEIGHTS))
    check("radius", radius is None or is_number(radius, *RADII), metres_between(*RADII))
    return {
        "person": person,
        "position": position,
        "state": state,
        "origin": origin,
        "height": height,
        "radius": radius,
    }


def tell_repeated(rows: list[Row], problems: FrameProblems) -> None:
    seen: set[int] = set()
    for index, row in enumerate(rows):
        person = row["person"]
        if not is_whole(person, MAX_PERSON):
            continue
        if person in seen:
            reason = _("person %(person)d is already in this frame") % {"person": person}
            problems.tell(f"annotations[{index}].person", reason)
        seen.add(person)


def done_problems(rows: list[Row], *, done: bool, nobody: bool) -> list[FrameProblem]:
    if nobody and rows:
        return [FrameProblem("nobody", _("somebody is annotated in this frame"))]
    if not done:
        return []
    if not rows and not nobody:
        return [FrameProblem("done", _("confirm that nobody is there before leaving an empty frame"))]
    carried = [row["person"] for row in rows if row["state"] == Annotation.State.CARRIED]
    if carried:
        people = ", ".join(str(person) for person in sorted(carried))
        reason = _("people carried over and not yet validated: %(people)s") % {"people": people}
        return [FrameProblem("done", reason)]
    return []


def is_whole(value: object, largest: int) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= largest


def is_choice(value: object, choices: list[str]) -> bool:
    return isinstance(value, str) and value in choices


def is_number(value: object, smallest: float, largest: float) -> bool:
    """Also false for NaN, which compares with nothing."""
    return isinstance(value, int | float) and not isinstance(value, bool) and smallest <= value <= largest


def one_of(choices: list[str]) -> str:
    return _("must be one of %(choices)s") % {"choices": ", ".join(choices)}


def metres_between(smallest: float, largest: float) -> str:
    values = {"smallest": smallest, "largest": largest}
    return _("must be between %(smallest)g and %(largest)g metres, or empty") % values
