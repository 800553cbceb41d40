"""`.pos`: where feet and heads of people are in one picture, as WILDTRACK's authors clicked them.

    identity
    0 x y
    1 x y

One file a frame and camera; people are divided by blank lines or by the next identity, and either point may
be missing. The published description numbers feet 0 and head 1, the published program reads feet 1 and head
2. Both are read; which of the two a file has shows in its numbers, unless it has none but 1.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from gtm_hit.formats.annotations.delimited_text import real
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, plain, shown

MOST_BYTES = 10_000_000
_POINT = re.compile(r"([0-9]+)\s+(\S+)\s+(\S+)")


class Numbering(StrEnum):
    """What the number before a point means."""

    FROM_ZERO = "0 feet, 1 head"
    FROM_ONE = "1 feet, 2 head"

    @property
    def feet(self) -> int:
        return 0 if self is Numbering.FROM_ZERO else 1


@dataclass(frozen=True)
class PosPerson:
    """One person's points in one picture, pixels; None where not clicked."""

    name: str
    feet: tuple[float, float] | None
    head: tuple[float, float] | None


@dataclass(frozen=True)
class PosFile:
    people: tuple[PosPerson, ...]
    numbering: Numbering  # which of the two was read


@dataclass(frozen=True)
class _Line:
    number: int
    name: str
    kind: int
    pixel: tuple[float, float]


def read_pos(path: Path, numbering: Numbering | None = None) -> PosFile:
    """FormatError with everything that is wrong; without `numbering` it is told by the file itself."""
    return parse_pos(read_source(path, MOST_BYTES), str(path), numbering)


def parse_pos(data: bytes, path: str, numbering: Numbering | None = None) -> PosFile:
    """As `read_pos`, `path` being what problems are reported under."""
    problems = ProblemList(path)
    names, lines = _lines(data, problems)
    numbering = numbering or numbering_of({line.kind for line in lines}, problems)
    points: dict[tuple[str, int], _Line] = {}
    for line in lines:
        part = line.kind - numbering.feet
        if part not in (0, 1):
            problems.add(f"line {line.number}", f"point {line.kind} is none of “{numbering}”")
        before = points.setdefault((line.name, part), line)
        if before is not line:
            reason = f"{shown(line.name)} has a point {line.kind} already in line {before.number}"
            problems.add(f"line {line.number}", reason)
    problems.raise_if_any()
    people = (
        PosPerson(name, *(points[name, part].pixel if (name, part) in points else None for part in (0, 1)))
        for name in names
    )
    return PosFile(tuple(people), numbering)


def numbering_of(kinds: Collection[int], problems: ProblemList) -> Numbering:
    """Told by the numbers of points; 1 alone may be either, and 0 together with 2 neither."""
    if 0 in kinds and 2 in kinds:
        problems.add("", "has points 0 and points 2: feet and heads cannot be told apart")
    elif kinds and set(kinds) <= {1}:
        problems.add(
            "", f"has points 1 only: say whether they are “{Numbering.FROM_ZERO}” or “{Numbering.FROM_ONE}”"
        )
    return Numbering.FROM_ONE if 2 in kinds else Numbering.FROM_ZERO


def _lines(data: bytes, problems: ProblemList) -> tuple[list[str], list[_Line]]:
    names: list[str] = []
    lines: list[_Line] = []
    for number, text in enumerate(data.decode("utf-8-sig", "replace").splitlines(), start=1):
        stripped = text.strip()
        match = _POINT.fullmatch(stripped)
        if not stripped:
            continue
        if match is None:
            names.append(plain(stripped))
        elif not names:
            problems.add(f"line {number}", "a point before any identity")
        else:
            pixel = (real(match[2], "x", number, problems), real(match[3], "y", number, problems))
            lines.append(_Line(number, names[-1], int(match[1][:9]), pixel))
    for name, count in Counter(names).items():
        if count > 1:
            problems.add("", f"the identity {shown(name)} is there {count} times")
    return names, lines
