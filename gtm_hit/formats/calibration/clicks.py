"""Clicks on the same things in several views, as CSV or JSON.

    thing,camera,x,y                   the first line may be left out
    lamp,C1,1411.0,146.0

    [{"thing": "lamp", "camera": "C1", "x": 1411.0, "y": 146.0}, …]

Pixels are those of the picture as taken. A fifth value, `use`, may say what the thing is kept for.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gtm_hit.formats.annotations.delimited_text import real, records, short
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, shown
from gtm_hit.formats.strict_json import parse_json

MOST_BYTES = 10_000_000
COLUMNS = ["thing", "camera", "x", "y"]
USE = "use"
USES = ("correspondence", "test")  # to adjust with, or only to test with


@dataclass(frozen=True)
class ThingClick:
    thing: str
    camera: str
    x: float
    y: float
    use: str = ""  # one of USES; empty: not said


def read_clicks(path: Path) -> list[ThingClick]:
    """FormatError with everything that is wrong, line by line."""
    return parse_clicks(read_source(path, MOST_BYTES), path)


def parse_clicks(data: bytes, name: Path | str) -> list[ThingClick]:
    """What a file of this name holds. FormatError with everything that is wrong, line by line."""
    problems = ProblemList(name)
    read = _of_json if str(name).lower().endswith(".json") else _of_csv
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


def write_clicks(clicks: Iterable[ThingClick]) -> bytes:
    """CSV, with what each thing is kept for."""
    lines = [",".join([*COLUMNS, USE])]
    lines += [f"{one.thing},{one.camera},{short(one.x)},{short(one.y)},{one.use}" for one in clicks]
    return ("\n".join(lines) + "\n").encode()


def _of_csv(data: bytes, problems: ProblemList) -> Iterator[tuple[str, ThingClick]]:
    for number, words in records(data):
        if words[: len(COLUMNS)] == COLUMNS:
            continue
        if len(words) not in {len(COLUMNS), len(COLUMNS) + 1} or not (words[0] and words[1]):
            problems.add(f"line {number}", f"is no line of the form {','.join(COLUMNS)}")
            continue
        thing, camera, use = words[0], words[1], (words[len(COLUMNS) :] or [""])[0]
        if use not in {"", *USES}:
            problems.add(f"line {number}", f"use is {shown(use)} instead of {' or '.join(USES)}")
        x, y = real(words[2], "x", number, problems), real(words[3], "y", number, problems)
        yield f"line {number}", ThingClick(thing, camera, x, y, use)


def _of_json(data: bytes, problems: ProblemList) -> Iterator[tuple[str, ThingClick]]:
    entries = parse_json(data, problems.path)
    if not isinstance(entries, list):
        problems.add("", "is no list of clicks")
        return
    for index, entry in enumerate(entries):
        if _is_click(entry):
            x, y = float(entry["x"]), float(entry["y"])
            use = str(entry.get(USE, ""))
            yield f"entry {index}", ThingClick(str(entry["thing"]), str(entry["camera"]), x, y, use)
        else:
            problems.add(f"entry {index}", f"is no object with {', '.join(COLUMNS)}: {shown(entry)}")


def _is_click(entry: Any) -> bool:
    if not isinstance(entry, dict) or not all(name in entry for name in COLUMNS):
        return False
    numbers = all(isinstance(entry[n], int | float) and not isinstance(entry[n], bool) for n in ("x", "y"))
    if entry.get(USE, "") not in {"", *USES}:
        return False
    return numbers and all(isinstance(entry[name], str | int) for name in ("thing", "camera"))
