"""Clicks on the same things in several views, as CSV or JSON.

    thing,camera,x,y                   the first line may be left out
    lamp,C1,1411.0,146.0

    [{"thing": "lamp", "camera": "C1", "x": 1411.0, "y": 146.0}, …]

Pixels are those of the picture as taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gtm_hit.formats.annotations.delimited_text import real, records
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, shown
from gtm_hit.formats.strict_json import parse_json

MOST_BYTES = 10_000_000
COLUMNS = ["thing", "camera", "x", "y"]


@dataclass(frozen=True)
class ThingClick:
    thing: str
    camera: str
    x: float
    y: float


def read_clicks(path: Path) -> list[ThingClick]:
    """FormatError with everything that is wrong, line by line."""
    problems = ProblemList(path)
    data = read_source(path, MOST_BYTES)
    read = _of_json if path.suffix.lower() == ".json" else _of_csv
    clicks: list[ThingClick] = []
    first: dict[tuple[str, str], str] = {}
    for place, click in read(data, problems):
        before = first.setdefault((click.thing, click.camera), place)
        if before != place:
            problems.add(
                place, f"{shown(click.thing)} was clicked in {shown(click.camera)} in {before} already"
            )
        clicks.append(click)
    if not clicks and not problems:
        problems.add("", "holds no click")
    problems.raise_if_any()
    return clicks


def _of_csv(data: bytes, problems: ProblemList) -> Iterator[tuple[str, ThingClick]]:
    for number, words in records(data):
        if words == COLUMNS:
            continue
        if len(words) != len(COLUMNS) or not (words[0] and words[1]):
            problems.add(f"line {number}", f"is no line of the form {','.join(COLUMNS)}")
            continue
        x, y = real(words[2], "x", number, problems), real(words[3], "y", number, problems)
        yield f"line {number}", ThingClick(words[0], words[1], x, y)


def _of_json(data: bytes, problems: ProblemList) -> Iterator[tuple[str, ThingClick]]:
    entries = parse_json(data, problems.path)
    if not isinstance(entries, list):
        problems.add("", "is no list of clicks")
        return
    for index, entry in enumerate(entries):
        if _is_click(entry):
            x, y = float(entry["x"]), float(entry["y"])
            yield f"entry {index}", ThingClick(str(entry["thing"]), str(entry["camera"]), x, y)
        else:
            problems.add(f"entry {index}", f"is no object with {', '.join(COLUMNS)}: {shown(entry)}")


def _is_click(entry: Any) -> bool:
    if not isinstance(entry, dict) or not all(name in entry for name in COLUMNS):
        return False
    numbers = all(isinstance(entry[n], int | float) and not isinstance(entry[n], bool) for n in ("x", "y"))
    return numbers and all(isinstance(entry[name], str | int) for name in ("thing", "camera"))
