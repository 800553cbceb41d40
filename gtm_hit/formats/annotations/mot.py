"""MOTChallenge text: `gt.txt` and `det.txt` of one view, and people on the ground.

    frame,id,left,top,width,height,1,1,1                  ground truth of a view
    frame,-1,left,top,width,height,confidence,-1,-1,-1    detections of a view
    frame,id,-1,-1,-1,-1,1,x,y,z                          on the ground, metres (3D MOT 2015)

The benchmark counts frames and ids from 1. Here a person's id is `person + 1`, and a frame is the place of
its number among the dataset's frame numbers. Pixels are not shifted: `left` is xmin, `width` is xmax - xmin.
"""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gtm_hit.formats.annotations.delimited_text import (
    MOST_WHOLE,
    real,
    records,
    short,
    whole,
)
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList

MOST_BYTES = 512 * 2**20
MOST_ID = MOST_WHOLE + 1  # of the largest person
_NAMES = ("frame", "id", "left", "top", "width", "height", "confidence")
_TRUTH_NAMES = (*_NAMES, "class", "visibility")
_WORLD_NAMES = (*_NAMES, "x", "y", "z")
_LAYOUTS = {6: _NAMES[:6], 7: _NAMES, 9: _TRUTH_NAMES, 10: _WORLD_NAMES}


@dataclass(frozen=True, eq=False)
class MotTable:
    """One row per person and frame.

    frames : (N,) int64, frame numbers of the dataset
    persons : (N,) int64; None where nobody has an identity
    boxes : (N, 4) float64, xmin ymin xmax ymax in pixels; None where nobody has a box
    confidences : (N,) float64
    world : (N, 3) float64, metres; None where nobody has a place
    lines : (N,) int64, where the rows stood in the file; None when they come from elsewhere
    """

    frames: NDArray[np.int64]
    persons: NDArray[np.int64] | None
    boxes: NDArray[np.float64] | None
    confidences: NDArray[np.float64]
    world: NDArray[np.float64] | None = None
    lines: NDArray[np.int64] | None = None


def read_mot(path: Path, numbers: Sequence[int]) -> MotTable:
    """Raises FormatError, as `parse_mot`."""
    return parse_mot(read_source(path, MOST_BYTES), str(path), numbers)


def parse_mot(data: bytes, path: str, numbers: Sequence[int]) -> MotTable:
    """The rows of a file with 6, 7, 9 or 10 values a line; `numbers` are the dataset's frames in order.

    People twice in a frame are left to the caller.

    Raises FormatError naming every line that is wrong: values missing or not finite, frames the dataset does
    not have, ids below 1 other than -1, boxes without area, neither box nor place.
    """
    problems = ProblemList(path)
    lines, values = array("q"), array("d")
    names: tuple[str, ...] = ()
    for line, words in records(data):
        names = names or _LAYOUTS.get(len(words), ())
        if len(words) != len(names):
            wanted = ",".join(names) or "6, 7, 9 or 10"
            problems.add(f"line {line}", f"{len(words)} values instead of {wanted}")
            continue
        lines.append(line)
        values.extend(_row(dict(zip(names, words, strict=True)), line, numbers, problems))
    table = np.frombuffer(values, dtype=np.float64).reshape(-1, 10)
    frames, persons = table[:, 0].astype(np.int64), table[:, 1].astype(np.int64)
    identified = bool((persons >= 0).any())
    if identified and not problems:  # what stands in for wrong ids is -1 too
        for row in np.flatnonzero(persons < 0):
            problems.add(f"line {lines[row]}", "id is -1 while other lines have one")
    problems.raise_if_any()
    return MotTable(
        frames,
        persons if identified else None,
        _unless_all_missing(table[:, 2:6]),
        table[:, 6],
        _unless_all_missing(table[:, 7:10]),
        np.frombuffer(lines, dtype=np.int64),
    )


def places_of(numbers: Sequence[int]) -> dict[int, int]:
    """What the benchmark calls the dataset's frames: 1, 2 … in order."""
    return {number: place for place, number in enumerate(numbers, start=1)}


def mot_lines(table: MotTable, places: Mapping[int, int]) -> bytes:
    """The lines of one table.

    With a place they are ground, without identities detections, otherwise ground truth.
    """
    frames = [str(places[number]) for number in table.frames.tolist()]
    return "".join(",".join(row) + "\n" for row in zip(*_columns(table, frames), strict=True)).encode()


def seqinfo(name: str, frames: int, frames_per_second: float, width: int, height: int, suffix: str) -> bytes:
    """The `seqinfo.ini` evaluation kits read beside `gt/gt.txt`."""
    return (
        f"[Sequence]\nname={name}\nimDir=img1\nframeRate={short(frames_per_second)}\nseqLength={frames}\n"
        f"imWidth={width}\nimHeight={height}\nimExt={suffix}\n"
    ).encode()


def _row(
    values: dict[str, str], line: int, numbers: Sequence[int], problems: ProblemList
) -> tuple[float, ...]:
    """Frame, person, box, confidence, place; NaN for a box or place the line does not have."""
    frame = whole(values["frame"], "frame", 1, line, problems)
    if frame > len(numbers):
        problems.add(f"line {line}", f"frame {frame} is not one of the dataset's {len(numbers)}")
    person = whole(values["id"], "id", -1, line, problems, most=MOST_ID)
    if person == 0:
        problems.add(f"line {line}", "id is 0, but ids count from 1")
    left, top, width, height = (real(values[name], name, line, problems) for name in _NAMES[2:6])
    confidence = real(values.get("confidence", "1"), "confidence", line, problems)
    world = [real(values.get(name, "-1"), name, line, problems) for name in ("x", "y", "z")]
    box = [left, top, left + width, top + height]
    if (left, top, width, height) == (-1, -1, -1, -1):
        box = [np.nan] * 4
    elif width <= 0 or height <= 0:
        problems.add(f"line {line}", f"the box {left} {top} {width} {height} has no area")
    if world == [-1, -1, -1]:
        world = [np.nan] * 3
    if np.isnan(box[0]) and np.isnan(world[0]):
        problems.add(f"line {line}", "has neither a box nor a place")
    number = numbers[frame - 1] if frame <= len(numbers) else 0
    return number, person - 1 if person > 0 else -1, *box, confidence, *world


def _unless_all_missing(columns: NDArray[np.float64]) -> NDArray[np.float64] | None:
    return None if len(columns) and np.isnan(columns).all() else columns


def _columns(table: MotTable, frames: list[str]) -> list[list[str]]:
    count = len(frames)
    ids = ["-1"] * count if table.persons is None else [str(person + 1) for person in table.persons.tolist()]
    boxes = np.full((count, 4), np.nan) if table.boxes is None else np.array(table.boxes, dtype=np.float64)
    boxes[:, 2:] -= boxes[:, :2]
    columns = [frames, ids, *_texts(boxes), [short(each) for each in table.confidences.tolist()]]
    if table.world is not None:
        return [*columns, *_texts(table.world)]
    # Class 1 is a pedestrian; 1 is fully visible, as nobody measured occlusion.
    return [*columns, *([["-1"] * count] * 3 if table.persons is None else [["1"] * count] * 2)]


def _texts(columns: NDArray[np.float64]) -> list[list[str]]:
    # NaN is the only number that differs from itself.
    return [["-1" if value != value else short(value) for value in column] for column in columns.T.tolist()]
