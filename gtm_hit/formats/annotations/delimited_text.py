"""Numbers out of text with one record per line and commas between the values."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterator

from gtm_hit.formats.problems import ProblemList, shown

MOST_WHOLE = 2**31 - 1

# Lengths are bounded: a number of a million digits is no number anybody meant.
_REAL = re.compile(r"[+-]?(?:[0-9]{1,40}(?:\.[0-9]{0,40})?|\.[0-9]{1,40})(?:[eE][+-]?[0-9]{1,4})?")


def records(data: bytes) -> Iterator[tuple[int, list[str]]]:
    """Line numbers, counted from 1, and the values of every line that is not blank and no `#` comment."""
    # Line by line: a list of all lines takes several times the memory of the file.
    lines = io.TextIOWrapper(io.BytesIO(data), "utf-8-sig", "replace", newline="\n")
    for number, line in enumerate(lines, start=1):
        stripped = line.strip()
        if stripped and not stripped.startswith("#"):
            yield number, [word.strip().strip('"') for word in stripped.split(",")]


def whole(
    word: str, name: str, least: int, number: int, problems: ProblemList, most: int = MOST_WHOLE
) -> int:
    """An integer from `least` on, also as numpy writes it (`3.00e+00`); `least`, and told, if it is none."""
    if word.isascii() and word.isdigit() and len(word) < 10:
        value = float(word)
    else:
        value = float(word) if _REAL.fullmatch(word) else math.nan
    if value.is_integer() and least <= value <= most:
        return int(value)
    problems.add(f"line {number}", f"{name} is {shown(word)} instead of an integer from {least} to {most}")
    return least


def real(word: str, name: str, number: int, problems: ProblemList) -> float:
    """A finite number; 0, and told, if it is none."""
    value = float(word) if _REAL.fullmatch(word) else math.nan
    if math.isfinite(value):
        return value
    problems.add(f"line {number}", f"{name} is {shown(word)} instead of a finite number")
    return 0.0


def short(value: float) -> str:
    """A number with six decimals at most, whole numbers with none: micrometres, millionths of a pixel."""
    rounded = round(value, 6)
    return str(int(rounded)) if rounded.is_integer() else repr(rounded)
