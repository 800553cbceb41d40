"""`frame column row` text, one person per line: what MVDet and the evaluation tools around it exchange.

Columns and rows are those of the grid. A fourth value, the person, makes identities comparable. Lines may end
with a comment after `#`; numbers may be written as numpy writes them (`3.000e+00`).
"""

from __future__ import annotations

import io
import re
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, shown

MOST_BYTES = 512 * 2**20
MOST = 2**31 - 1  # what a frame, column, row or person may be
_NAMES = ("frame", "column", "row", "person")
_NUMBER = re.compile(rb"[+-]?(?:[0-9]{1,40}(?:\.[0-9]{0,40})?|\.[0-9]{1,40})(?:[eE][+-]?[0-9]{1,3})?")

Ids = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class FrameColumnRow:
    """One row per person and frame, in the order of the file."""

    frames: Ids  # (N,)
    columns: Ids  # (N,)
    rows: Ids  # (N,)
    persons: Ids | None = None  # (N,)
    lines: Ids | None = None  # (N,) where the rows stood in the file; None when they come from elsewhere


def read(
    path: Path, *, persons: bool | None = False, may_be_empty: bool = False, repeated: bool = False
) -> FrameColumnRow:
    """All lines of the file; raises FormatError naming every line that is wrong.

    With `persons` every line must have the fourth value; without it the fourth value is ignored where all
    lines have one, and with None it is taken there. `may_be_empty` is for a program's detections: it may have
    found nobody. With `repeated`, people twice in a frame are left to the caller.
    """
    problems = ProblemList(path)
    data = b"" if may_be_empty and _is_empty(path) else read_source(path, MOST_BYTES)
    lengths = {len(words) for _, words in _lines(data)}
    if not (lengths or may_be_empty):
        problems.add("", "holds no `frame column row` line")
    if persons and lengths == {3}:
        problems.add("", "no line has a person, the fourth value")
        problems.raise_if_any()
    expected = 4 if persons or lengths == {4} else 3
    numbers, values = array("q"), array("q")
    for number, words in _lines(data):
        numbers.append(number)
        values.extend(_values(number, words, expected, problems))
    table = np.frombuffer(values, dtype=np.int64).reshape(-1, expected)
    identified = expected == 4 and persons is not False
    if identified and not repeated:
        _tell_repeated(table[:, 0], table[:, 3], numbers, problems)
    problems.raise_if_any()
    places = np.frombuffer(numbers, dtype=np.int64)
    return FrameColumnRow(table[:, 0], table[:, 1], table[:, 2], table[:, 3] if identified else None, places)


def lines(table: FrameColumnRow) -> bytes:
    parts = [table.frames, table.columns, table.rows]
    rows = np.column_stack([*parts, table.persons] if table.persons is not None else parts)
    return "".join(" ".join(map(str, row)) + "\n" for row in rows.tolist()).encode()


def _is_empty(path: Path) -> bool:
    try:
        return path.is_file() and not path.stat().st_size
    except OSError:
        return False  # whoever reads it says what is wrong


def _lines(data: bytes) -> Iterator[tuple[int, list[bytes]]]:
    """Line numbers, counted from 1, and the words of every line that has any."""
    number = 0
    for together in io.BytesIO(data.removeprefix(b"\xef\xbb\xbf")):
        # Lines may end with a carriage return alone, too.
        for line in together.splitlines():
            number += 1
            words = line.partition(b"#")[0].split()
            if words:
                yield number, words


def _values(number: int, words: list[bytes], expected: int, problems: ProblemList) -> list[int]:
    place = f"line {number}"
    if len(words) != expected:
        wanted = " ".join(_NAMES[:expected])
        problems.add(place, f"{len(words)} values instead of {expected} ({wanted})")
        return [0] * expected
    return [_whole(place, name, word, problems) for name, word in zip(_NAMES, words, strict=False)]


def _whole(place: str, name: str, word: bytes, problems: ProblemList) -> int:
    if word.isdigit() and len(word) < 10:
        return int(word)
    value = float(word) if _NUMBER.fullmatch(word) else float("nan")
    if value.is_integer() and 0 <= value <= MOST:
        return int(value)
    text = shown(word.decode("ascii", "backslashreplace"))
    problems.add(place, f"{name} is not a whole number from 0 to {MOST}: {text}")
    return 0


def _tell_repeated(frames: Ids, persons: Ids, numbers: Sequence[int], problems: ProblemList) -> None:
    """Every row whose person is already in its frame."""
    if problems:
        return  # what stands in for wrong values would look like repetitions
    first: dict[tuple[int, int], int] = {}
    for frame, person, number in zip(frames.tolist(), persons.tolist(), numbers, strict=True):
        earlier = first.setdefault((frame, person), number)
        if earlier != number:
            problems.add(f"line {number}", f"person {person} is already in frame {frame} on line {earlier}")
