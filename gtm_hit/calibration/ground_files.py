"""Measured points out of a file: CSV, or JSON with a list or a regular grid.

name,x,y,z                          a heading in any order; z may be left out: 0; separated by , ; or tabs.
A1,0,0,0                            `x_cm`, `x [cm]` in the heading, or a line `# unit: cm`, tell the unit.

{"unit": "cm", "points": [{"name": "A1", "x": 0, "y": 0, "z": 0}, …]}     or [x, y, z] as a point, then
{"unit": "cm", "grid": {"columns": 4, "rows": 9, "spacing": [259, 207], "origin": [0, 0]}}   numbered 1, 2, …
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from gtm_hit.calibration.ground_points import (
    METRES,
    UNIT_WORDS,
    GroundPoint,
    GroundPointsError,
    doubts,
    likely_unit,
    regular_grid,
    same_places,
    span_of,
)
from gtm_hit.formats.annotations.delimited_text import real
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, shown
from gtm_hit.formats.strict_json import parse_json

MOST_BYTES = 5_000_000
MOST_POINTS = 10_000
MOST_NAME = 40
_UNIT_LINE = re.compile(r"#\s*units?\s*[:=]?\s*(\w+)", re.IGNORECASE)
_HEADING = re.compile(r"([a-z]+)\s*(?:[_ ]|\[|\()?\s*(mm|cm|m)?\s*[\])]?", re.IGNORECASE)
_NAMES = ("name", "point", "id", "label")


@dataclass(frozen=True)
class PointList:
    """Points in metres, the unit the file has them in, and what looks wrong about them."""

    points: tuple[GroundPoint, ...]
    unit: str
    doubts: tuple[str, ...]


@dataclass
class Rows:
    """What a file says, before units: a place in the file, a name and three numbers each."""

    unit: str = ""
    places: list[str] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    values: list[tuple[float, float, float]] = field(default_factory=list)

    def add(self, place: str, name: str, values: tuple[float, float, float]) -> None:
        self.places.append(place)
        self.names.append(name)
        self.values.append(values)


def read_points(path: Path, unit: str = "") -> PointList:
    """Raises FormatError, as `parse_points`."""
    return parse_points(read_source(path, MOST_BYTES), str(path), unit)


def parse_points(data: bytes, path: str, unit: str = "") -> PointList:
    """The points of a CSV or JSON file; `unit` says what the file does not.

    Raises FormatError with everything that is wrong: no unit or two, what is no finite number, a name or a
    place given twice; each with its line.
    """
    problems = ProblemList(path)
    is_json = data.lstrip()[:1] in (b"{", b"[")
    rows = _json_rows(parse_json(data, path), problems) if is_json else _csv_rows(data, problems)
    return finished(rows, unit, problems)


def finished(rows: Rows, unit: str, problems: ProblemList) -> PointList:
    """The rows in metres, checked; FormatError with all there is to say."""
    known = _unit(rows, unit, problems)
    if not rows.values and not problems:
        problems.add("", "holds no points")
    if len(rows.values) > MOST_POINTS:
        problems.add("", f"{len(rows.values):,} points; at most {MOST_POINTS:,} are sensible")
        problems.raise_if_any()
    scale = METRES[known]
    points = [
        GroundPoint(name, *(float(value * scale) for value in values))
        for name, values in zip(rows.names, rows.values, strict=True)
    ]
    _tell_twice(rows, points, problems)
    problems.raise_if_any()
    return PointList(tuple(points), known, tuple(doubts(points, known)))


def _unit(rows: Rows, said: str, problems: ProblemList) -> str:
    for unit in {rows.unit, said} - {""}:
        if unit not in METRES:
            problems.add("unit", f"{shown(unit)} is none of {', '.join(METRES)}")
            return "m"
    if rows.unit and said and rows.unit != said:
        problems.add("unit", f"the file says {rows.unit}, you say {said}")
    if not (rows.unit or said):
        span = span_of(np.array(rows.values, dtype=np.float64).reshape(-1, 3))
        likely = UNIT_WORDS[likely_unit(span)]
        problems.add("unit", f"not said: m, cm or mm (a span of {span:,.6g} looks like {likely})")
    return rows.unit or said or "m"


def _tell_twice(rows: Rows, points: Sequence[GroundPoint], problems: ProblemList) -> None:
    first: dict[str, str] = {}
    for place, name in zip(rows.places, rows.names, strict=True):
        if name in first:
            problems.add(place, f"the name {shown(name)} is given already: {first[name]}")
        first.setdefault(name, place)
    for earlier, later in same_places(points):
        there = f"{shown(points[earlier].name)}, {rows.places[earlier]}"
        problems.add(rows.places[later], f"lies where {there} does already")


def _csv_rows(data: bytes, problems: ProblemList) -> Rows:
    rows = Rows()
    columns: list[str] | None = None
    for number, line in enumerate(data.decode("utf-8-sig", "replace").splitlines(), start=1):
        if match := _UNIT_LINE.match(line.strip()):
            rows.unit = match[1].lower()
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        words = _words(line)
        if columns is None:
            columns, is_heading = _columns(words, number, rows, problems)
            if is_heading:
                continue
        _csv_row(words, columns, number, rows, problems)
    return rows


def _words(line: str) -> list[str]:
    separator = next((sign for sign in "\t;" if sign in line), ",")
    # With other separators a comma is where the fraction begins.
    text = line.replace(",", ".") if separator != "," else line
    return [word.strip().strip('"') for word in text.split(separator)]


def _columns(words: list[str], number: int, rows: Rows, problems: ProblemList) -> tuple[list[str], bool]:
    """What the columns are, and whether this line says so. Without a heading: name, x, y, z."""
    if len(words) in (3, 4) and all(_is_number(word) for word in words[1:]):
        return ["name", "x", "y", "z"][: len(words)], False
    matches = [_HEADING.fullmatch(word) for word in words]
    columns = [
        match[1].lower() if match else word.lower() for match, word in zip(matches, words, strict=True)
    ]
    columns = ["name" if column in _NAMES else column for column in columns]
    units = {match[2].lower() for match in matches if match and match[2]}
    if len(units) > 1:
        problems.add(f"line {number}", f"mixes units: {', '.join(sorted(units))}")
    for unit in units:
        if rows.unit and rows.unit != unit:
            problems.add(f"line {number}", f"says {unit} where the file says {rows.unit}")
        rows.unit = unit
    if missing := [name for name in ("name", "x", "y") if columns.count(name) != 1]:
        problems.add(f"line {number}", f"names no column {', '.join(missing)}, or names it twice")
        problems.raise_if_any()
    return columns, True


def _is_number(word: str) -> bool:
    quiet = ProblemList("")
    real(word, "", 0, quiet)
    return not quiet


def _csv_row(words: list[str], columns: list[str], number: int, rows: Rows, problems: ProblemList) -> None:
    if len(words) != len(columns):
        expected = f"{len(columns)} ({','.join(columns)})"
        problems.add(f"line {number}", f"{len(words)} values instead of {expected}")
        return
    values = dict(zip(columns, words, strict=True))
    x, y = (real(values[name], name, number, problems) for name in ("x", "y"))
    z = real(values["z"], "z", number, problems) if values.get("z") else 0.0
    rows.add(f"line {number}", _name(values["name"], f"line {number}", problems), (x, y, z))


def _name(name: str, place: str, problems: ProblemList) -> str:
    if not name or len(name) > MOST_NAME or not name.isprintable():
        problems.add(place, f"{shown(name)} is no name: 1 to {MOST_NAME} signs one can see")
    return name


def _json_rows(content: Any, problems: ProblemList) -> Rows:
    if isinstance(content, list):
        content = {"points": content}
    rows = Rows(str(content.get("unit", "")))
    if "grid" in content:
        _grid_rows(content["grid"], rows, problems)
        return rows
    entries = content.get("points", content.get("object_points"))
    if not isinstance(entries, list):
        problems.add("", 'has neither a list of "points" nor a "grid"')
        return rows
    for index, entry in enumerate(entries):
        place = f"points[{index}]"
        if (values := numbers_of(entry, (2, 3), place, problems)) is not None:
            name = str(entry.get("name", index + 1)) if isinstance(entry, dict) else str(index + 1)
            rows.add(place, _name(name, place, problems), (values[0], values[1], values[2]))
    return rows


def numbers_of(
    entry: Any, counts: tuple[int, ...], place: str, problems: ProblemList
) -> tuple[float, float, float] | None:
    """x, y and z of a list of so many numbers, or of an object; z is 0 if left out; None, and told."""
    if isinstance(entry, dict):
        entry = [entry.get("x"), entry.get("y"), *([entry["z"]] if "z" in entry else [])]
    is_numbers = isinstance(entry, list) and all(
        isinstance(each, int | float) and not isinstance(each, bool) and abs(each) < 1e12 for each in entry
    )
    if not is_numbers or len(entry) not in counts:
        wanted = " or ".join(map(str, counts))
        problems.add(place, f"{shown(entry)} is not a list of {wanted} finite numbers")
        return None
    x, y, z = (*map(float, entry), 0.0, 0.0)[:3]
    return x, y, z


def _grid_rows(grid: Any, rows: Rows, problems: ProblemList) -> None:
    if not isinstance(grid, dict):
        problems.add("grid", f"{shown(grid)} is not an object with columns, rows, spacing and origin")
        return
    spacing = numbers_of(grid.get("spacing"), (2,), "grid.spacing", problems)
    origin = numbers_of(grid.get("origin", [0, 0]), (2, 3), "grid.origin", problems)
    columns, count = grid.get("columns"), grid.get("rows")
    if type(columns) is not int or type(count) is not int:
        problems.add("grid", f"columns and rows are {shown(columns)} and {shown(count)}, not integers")
        return
    if spacing is None or origin is None:
        return
    try:
        made = regular_grid(columns, count, spacing[:2], origin[:2], origin[2])
    except GroundPointsError as error:
        problems.add("grid", str(error))
        return
    for point in made:
        rows.add(f"grid {point.name}", point.name, point.place)
