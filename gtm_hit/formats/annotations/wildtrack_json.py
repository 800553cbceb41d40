"""One JSON file per annotated frame, as WILDTRACK and MultiviewX publish them in `annotations_positions/`."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import chain
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np

from gtm_hit.formats.files import read_source, write_bytes
from gtm_hit.formats.problems import ProblemList, shown
from gtm_hit.formats.strict_json import parse_json
from gtm_hit.geometry.grid import Grid

MOST_BYTES = 64_000_000
MOST_ID = 2**31 - 1

_LINE_BREAK = ",\n        "
# Python's own encoder is the fast one only without indent; for plain values the separator does the same.
_FLAT = json.JSONEncoder(separators=(_LINE_BREAK, ": "), allow_nan=False)
_BOX_KEYS = ("viewNum", "xmin", "ymin", "xmax", "ymax")
_PERSON_KEYS = {"personID", "positionID", "views"}
_VIEW_VALUES = itemgetter(*_BOX_KEYS)
_NUMBER_AT_END = re.compile(r"([0-9]{1,9})$")


@dataclass(frozen=True, eq=False)
class PersonPosition:
    """One person of one frame.

    boxes : (C, 4) int32, xmin ymin xmax ymax in pixels by camera, all -1 if not visible; None without views
    extra : further keys of the file and their JSON values
    """

    person: int
    position: int
    boxes: np.ndarray | None
    extra: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class FrameAnnotations:
    number: int
    people: list[PersonPosition]


def read_frame(path: Path, grid: Grid, cameras: int, repeated: bool = False) -> FrameAnnotations:
    """The people of one file; the frame number is the one its name ends with.

    With `repeated`, people twice in the file are left to the caller.

    Raises FormatError with everything wrong in the file.
    """
    match = _NUMBER_AT_END.search(path.stem)
    data = read_source(path, MOST_BYTES)
    problems = ProblemList(path)
    if match is None:
        problems.add("", "the name does not end with a frame number of at most 9 digits")
    people = _people(data, grid, cameras, problems, repeated)
    problems.raise_if_any()
    return FrameAnnotations(int(match[1]) if match else -1, people)


def frame_json(people: Iterable[PersonPosition], cameras: int) -> bytes:
    """The bytes of one frame's file: what json.dumps with an indent of 4 makes, several times as fast.

    People keep their order, `extra` follows the published keys. Raises ValueError for what no reader takes: a
    person twice or without boxes of every camera, negative ids, extra keys that hide the published ones.
    """
    template = _person_template(cameras)
    texts = []
    seen: set[int] = set()
    for person in people:
        if person.person in seen or min(person.person, person.position) < 0:
            raise ValueError(
                f"person {person.person} at position {person.position} is there twice or negative"
            )
        seen.add(person.person)
        boxes = person.boxes
        if boxes is None or boxes.shape != (cameras, 4) or boxes.dtype.kind != "i":
            raise ValueError(f"person {person.person} does not have integer boxes of {cameras} cameras")
        extra = extra_text(person.extra) if person.extra else ""
        texts.append(template % (person.person, person.position, *boxes.ravel().tolist(), extra))
    return joined(texts)


def person_texts(
    persons: np.ndarray, positions: np.ndarray, boxes: np.ndarray, extras: Iterable[str]
) -> list[str]:
    """What `joined` makes the bytes of `frame_json` of, many people at once.

    persons, positions : (N,) ids, nobody twice in one frame
    boxes : (N, C, 4) integers
    extras : what `extra_text` gives, or nothing
    """
    template = _person_template(boxes.shape[1])
    ids = np.column_stack((persons, positions))
    if ids.size and ids.min() < 0:
        raise ValueError("persons and positions are not negative")
    numbers = np.concatenate((ids, boxes.reshape(len(boxes), 4 * boxes.shape[1])), axis=1)
    return [template % (*row, extra) for row, extra in zip(numbers.tolist(), extras, strict=True)]


def joined(people: Sequence[str]) -> bytes:
    """The file of one frame's people."""
    return ("[\n" + ",\n".join(people) + "\n]" if people else "[]").encode()


def write_frame(folder: Path, frame: FrameAnnotations, cameras: int) -> Path:
    """Writes `<folder>/<number>.json`; with 8 digits, as WILDTRACK has them."""
    path = folder / f"{frame.number:08d}.json"
    write_bytes(path, frame_json(frame.people, cameras))
    return path


@cache
def _person_template(cameras: int) -> str:
    keys = dict.fromkeys(_BOX_KEYS[1:], "%d")
    views = [{"viewNum": camera, **keys} for camera in range(cameras)]
    text = json.dumps([{"personID": "%d", "positionID": "%d", "views": views}], indent=4).replace(
        '"%d"', "%d"
    )
    return text.removeprefix("[\n").removesuffix("\n    }\n]") + "%s\n    }"


def extra_text(extra: Mapping[str, Any]) -> str:
    """Further keys of a person as they follow the published ones. ValueError if they would hide those."""
    if hidden := _PERSON_KEYS & extra.keys():
        raise ValueError(f"extra keys would hide {sorted(hidden)}")
    if not any(isinstance(value, (dict, list, tuple)) for value in extra.values()):
        return _LINE_BREAK + _FLAT.encode(extra)[1:-1]
    lines = json.dumps(extra, indent=4, allow_nan=False).splitlines()
    # Without the braces, each line two levels deeper: a person stands inside a list.
    return ",\n" + "\n".join(f"    {line}" for line in lines[1:-1])


def _people(
    data: bytes,
    grid: Grid,
    cameras: int,
    problems: ProblemList,
    repeated: bool,
) -> list[PersonPosition]:
    entries = _entries(data, problems)
    every = _all_boxes(entries, cameras)
    people = []
    first_at: dict[int, int] = {}
    for index, entry in enumerate(entries):
        place = f"entry {index}"
        if not isinstance(entry, dict):
            problems.add(place, f"is {shown(entry)} instead of an object")
            continue
        person = _id(entry, "personID", MOST_ID, place, problems)
        position = _id(entry, "positionID", grid.count - 1, place, problems)
        if every is not None:
            boxes: np.ndarray | None = every[index]
        else:
            boxes = _boxes(entry["views"], cameras, place, problems) if "views" in entry else None
        if not repeated and person >= 0 and (first := first_at.setdefault(person, index)) != index:
            problems.add(place, f"person {person} is already in entry {first}")
        extra = {key: value for key, value in entry.items() if key not in _PERSON_KEYS}
        people.append(PersonPosition(person, position, boxes, extra))
    return people


def _entries(data: bytes, problems: ProblemList) -> list[Any]:
    entries = parse_json(data, problems.path)
    if isinstance(entries, list):
        return entries
    problems.add("", f"holds {shown(entries)} instead of a list of people")
    return []


def _id(entry: Mapping[str, Any], key: str, most: int, place: str, problems: ProblemList) -> int:
    value = entry.get(key)
    # bool is an int to Python and true is not a person.
    if type(value) is int and 0 <= value <= most:
        return value
    if key not in entry:
        problems.add(place, f"has no {key}")
    else:
        problems.add(place, f"{key} is {shown(value)} instead of an integer from 0 to {most}")
    return -1


def _all_boxes(entries: list[Any], cameras: int) -> np.ndarray | None:
    """Boxes (N, cameras, 4) when nothing at all is unusual in them; else they are looked at one by one."""
    try:
        if {len(entry["views"]) for entry in entries} != {cameras}:
            return None
        values = [_VIEW_VALUES(view) for entry in entries for view in entry["views"]]
    except (KeyError, TypeError, IndexError):
        return None
    flat = list(chain.from_iterable(values))
    if set(map(type, flat)) != {int}:
        return None
    if not -MOST_ID <= min(flat) <= max(flat) <= MOST_ID:
        return None
    views = np.array(flat, dtype=np.int32).reshape(len(entries), cameras, len(_BOX_KEYS))
    boxes: np.ndarray = views[..., 1:]
    in_order = (views[..., 0] == np.arange(cameras)).all()
    return boxes if in_order and (boxes[..., :2] <= boxes[..., 2:]).all() else None


def _boxes(views: Any, cameras: int, place: str, problems: ProblemList) -> np.ndarray | None:
    if not isinstance(views, list) or len(views) != cameras:
        given = f"{len(views)} views" if isinstance(views, list) else f"{shown(views)} as views"
        problems.add(place, f"has {given} instead of a list of {cameras}")
        return None
    boxes: list[tuple[int, ...] | None] = [None] * cameras
    for index, view in enumerate(views):
        try:
            values = _VIEW_VALUES(view)
        except (KeyError, TypeError, IndexError):
            problems.add(f"{place}, view {index}", f"is {shown(view)} without one of {', '.join(_BOX_KEYS)}")
            continue
        reason = _wrong_view(values, boxes)
        if reason:
            problems.add(f"{place}, view {index}", reason)
        else:
            boxes[values[0]] = values[1:]
    return np.array(boxes, dtype=np.int32) if None not in boxes else None


def _wrong_view(values: tuple[Any, ...], boxes: list[tuple[int, ...] | None]) -> str:
    number, xmin, ymin, xmax, ymax = values
    if not (type(number) is type(xmin) is type(ymin) is type(xmax) is type(ymax) is int):
        return f"{shown(values)} are not five integers"
    if not 0 <= number < len(boxes):
        return f"viewNum is {shown(number)} instead of 0 to {len(boxes) - 1}"
    if boxes[number] is not None:
        return f"viewNum {number} is there twice"
    if not (-MOST_ID <= xmin <= xmax <= MOST_ID and -MOST_ID <= ymin <= ymax <= MOST_ID):
        return f"the box {shown(values[1:])} has its corners exchanged or too far away"
    return ""
