"""What a saved frame must look like. All problems of a frame are found at once, with their places."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from django.utils.translation import gettext as _

from gtm_hit.formats.problems import MOST_PROBLEMS, shown
from gtm_hit.geometry.cylinder import HEIGHTS, RADII
from gtm_hit.geometry.grid import Grid
from gtm_hit.models import Annotation
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.frames.row import FIELDS, Row

MAX_PEOPLE = 500
MAX_PERSON = 2**31 - 1  # PostgreSQL's integer
MAX_SECONDS = 24 * 3600.0


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


class InvalidFrame(OperationError, ValueError):
    """A frame that cannot be saved; `problems` lists everything that is wrong with it."""

    def __init__(self, problems: list[FrameProblem]) -> None:
        super().__init__("; ".join(f"{problem.place}: {problem.reason}" for problem in problems))
        self.problems = problems


def checked(
    annotations: object, grid: Grid, *, done: bool, nobody: bool, seconds: object
) -> tuple[list[Row], float]:
    """The annotations by person and the seconds; raises InvalidFrame."""
    problems = FrameProblems()
    rows = checked_rows(annotations, grid, problems)
    if not is_number(seconds, 0, MAX_SECONDS):
        problems.tell("seconds", _("must be a number of seconds within one day"))
    if not problems:
        problems += done_problems(rows, done=done, nobody=nobody)
    if problems:
        raise InvalidFrame(problems)
    return sorted(rows, key=lambda row: row.person), float(seconds)  # type: ignore[arg-type]


def checked_rows(annotations: object, grid: Grid, problems: FrameProblems) -> list[Row]:
    """Only as good as they were sent when there are problems."""
    if not isinstance(annotations, Sequence) or isinstance(annotations, str | bytes):
        problems.tell("annotations", _("must be a list"))
        return []
    if len(annotations) > MAX_PEOPLE:
        problems.tell("annotations", _("at most %(count)d people fit in a frame") % {"count": MAX_PEOPLE})
        return []
    rows: dict[str, Row] = {}
    for index, annotation in enumerate(annotations):
        place = f"annotations[{index}]"
        if row := checked_row(annotation, place, grid, problems):
            rows[place] = row
    tell_repeated(rows, problems)
    return list(rows.values())


def checked_row(annotation: object, place: str, grid: Grid, problems: FrameProblems) -> Row | None:
    if not isinstance(annotation, Mapping):
        problems.tell(place, _("must be an object"))
        return None
    for key in annotation.keys() - set(FIELDS):
        # shown(): a lone surrogate or a megabyte from the sender must not break the answer.
        problems.tell(place, _("unknown key %(key)s") % {"key": shown(key)})
    missing = {"person": None, "position": None}
    row = Row(**{**missing, **{name: annotation[name] for name in FIELDS if name in annotation}})
    for key in wrong_fields(row, grid):
        problems.tell(f"{place}.{key}", expected(key, grid))
    return row


def wrong_fields(row: Row, grid: Grid) -> list[str]:
    fine = {
        "person": is_whole(row.person, MAX_PERSON),
        "position": is_whole(row.position, grid.count - 1),
        "state": is_choice(row.state, Annotation.State.values),
        "origin": is_choice(row.origin, Annotation.Origin.values),
        "height": row.height is None or is_number(row.height, *HEIGHTS),
        "radius": row.radius is None or is_number(row.radius, *RADII),
    }
    return [key for key in FIELDS if not fine[key]]


def expected(key: str, grid: Grid) -> str:
    """Asked for what is wrong only: translating takes longer than all the checks."""
    match key:
        case "person":
            return _("must be a whole number from 0")
        case "position":
            return _("must be a position of the grid, 0 to %(last)d") % {"last": grid.count - 1}
        case "state":
            return one_of(Annotation.State.values)
        case "origin":
            return one_of(Annotation.Origin.values)
        case "height":
            return metres_between(*HEIGHTS)
    return metres_between(*RADII)


def tell_repeated(rows: Mapping[str, Row], problems: FrameProblems) -> None:
    seen: set[int] = set()
    for place, row in rows.items():
        if not is_whole(row.person, MAX_PERSON):
            continue
        if row.person in seen:
            reason = _("person %(person)d is already in this frame") % {"person": row.person}
            problems.tell(f"{place}.person", reason)
        seen.add(row.person)


def done_problems(rows: list[Row], *, done: bool, nobody: bool) -> list[FrameProblem]:
    if nobody and rows:
        return [FrameProblem("nobody", _("somebody is annotated in this frame"))]
    if not done:
        return []
    if not rows and not nobody:
        return [FrameProblem("done", _("confirm that nobody is there before leaving an empty frame"))]
    carried = [row.person for row in rows if row.state == Annotation.State.CARRIED]
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
