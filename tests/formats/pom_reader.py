"""What the tests read POM files with; the format is described in `gtm_hit.formats.pom`."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from gtm_hit.formats.files import check_source, reason_of
from gtm_hit.formats.pom import PomHeader
from gtm_hit.formats.problems import FormatError, Problem, ProblemList, shown
from gtm_hit.geometry.cylinder import Cylinder
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.steps import Steps

MOST_ENTRIES = 50_000_000
BLOCK_BYTES = 1 << 20
LONGEST_LINE = 4096
MOST_HEADER_LINES = 1000

_COUNTS = ("NB_WIDTH", "NB_HEIGHT", "NB_CAMERA")
_MEASURES = ("WIDTH", "HEIGHT", "MAN_RAY", "MAN_HEIGHT", "REDUCTION", "ORIGINE_X", "ORIGINE_Y")
_OTHER_NAMES = {
    "NB_CAMERAS": "NB_CAMERA",
    "NB_CAMS": "NB_CAMERA",
    "NUM_CAM": "NB_CAMERA",
    "CAMERAS": "NB_CAMERA",
}
# What POM's own configuration may hold besides rectangles, none of it about them.
_POM_WORDS = {
    "ROOM",
    "INPUT_VIEW_FORMAT",
    "RESULT_VIEW_FORMAT",
    "RESULT_FORMAT",
    "CONVERGENCE_VIEW_FORMAT",
    "PRIOR",
    "SIGMA_IMAGE_DENSITY",
    "MAX_NB_SOLVER_ITERATIONS",
    "PROBA_IGNORED",
    "PROCESS",
}

_COUNT = re.compile(r"[0-9]{1,9}")
_MEASURE = re.compile(r"[+-]?(?:[0-9]{1,30}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][+-]?[0-9]{1,3})?")
_HEADER_LINE = re.compile(r"([A-Z_]+)\s*[:=]?\s*(.*)")
_INTEGER = re.compile(rb"-?[0-9]{1,9}")
_ID = re.compile(rb"[0-9]{1,9}")
# Possessive, so that a block is matched in one pass and without a stack.
_PLAIN_BLOCK = re.compile(
    rb"(?:RECTANGLE [0-9]{1,9} [0-9]{1,9} (?:notvisible|(?:-?[0-9]{1,9} ){3}-?[0-9]{1,9})\n)*+"
)
_NOT_VISIBLE = (-1, -1, -1, -1)


@dataclass(frozen=True, eq=False)
class PomFile:
    """A table read from text.

    header : None where the file has none
    boxes : (C, N, 4) int32, xmin ymin xmax ymax in pixels, 0 where not visible
    visible : (C, N) bool
    """

    header: PomHeader | None
    boxes: np.ndarray
    visible: np.ndarray


def read_pom(
    path: Path, grid: Grid | None = None, cameras: int | None = None, progress: Steps | None = None
) -> PomFile:
    """Reads and checks a whole table; `progress` is told bytes done and bytes in all.

    `grid` and `cameras` are needed for a file without a header and compared with the header of any other.
    Pairs of camera and position the file does not name are not visible, as POM itself has it.

    Raises FormatError: another format, header incomplete or different, camera or position outside, a pair
    named twice, corners exchanged.
    """
    problems = ProblemList(path)
    check_source(path)
    try:
        with path.open("rb") as stream:
            size = path.stat().st_size
            header_lines, first = _header_lines(stream, problems)
            header = _parse_header(header_lines, problems)
            table = _Table(*_size(header, grid, cameras, problems), problems)
            for number, block in _blocks(stream, len(header_lines) + 1, first, problems):
                table.store(*_rows(number, block, problems))
                if progress:
                    progress(min(stream.tell(), size), size)
    except (OSError, ValueError) as error:
        raise FormatError([Problem(str(path), "", f"cannot be read: {reason_of(error)}")]) from error
    if not table.named.any():
        problems.add("", "has no RECTANGLE line")
    problems.raise_if_any()
    return PomFile(header, table.boxes, table.visible)


class _Table:
    def __init__(self, cameras: int, count: int, problems: ProblemList) -> None:
        # Zeros nobody writes to take no memory, so a header cannot claim more of it than the lines do.
        self.boxes = np.zeros((cameras, count, 4), dtype=np.int32)
        self.visible = np.zeros((cameras, count), dtype=bool)
        self.named = np.zeros((cameras, count), dtype=bool)
        self.problems = problems

    def store(self, numbers: np.ndarray, rows: np.ndarray) -> None:
        """Lines of a block, by their numbers (n,).

        rows : (n, 6) camera, position, xmin ymin xmax ymax; the box -1 -1 -1 -1 is not visible
        """
        cameras, count = self.named.shape
        camera, position, boxes = rows[:, 0], rows[:, 1], rows[:, 2:]
        hidden = (boxes == _NOT_VISIBLE).all(axis=1)
        self._tell(numbers, rows, camera >= cameras, f"camera is not one of 0 to {cameras - 1}")
        self._tell(numbers, rows, position >= count, f"position is not one of 0 to {count - 1}")
        exchanged = ((boxes[:, 2] < boxes[:, 0]) | (boxes[:, 3] < boxes[:, 1])) & ~hidden
        self._tell(numbers, rows, exchanged, "corners are exchanged")
        if self.problems:
            return
        entry = camera * count + position
        named = self.named.ravel()
        repeated = named[entry]
        if not (np.diff(entry) > 0).all():
            first = np.unique(entry, return_index=True)[1]
            repeated[np.setdiff1d(np.arange(entry.size), first, assume_unique=True)] = True
        self._tell(numbers, rows, repeated, "is named twice")
        named[entry] = True
        self.visible.ravel()[entry] = ~hidden
        self.boxes.reshape(-1, 4)[entry[~hidden]] = boxes[~hidden]

    def _tell(self, numbers: np.ndarray, rows: np.ndarray, wrong: np.ndarray, reason: str) -> None:
        for index in np.flatnonzero(wrong):
            camera, position, *box = rows[index].tolist()
            self.problems.add(
                f"line {numbers[index]}", f"camera {camera}, position {position}: {reason} {box}"
            )


def _header_lines(stream: BinaryIO, problems: ProblemList) -> tuple[list[str], bytes]:
    """The lines before the first RECTANGLE, and that line; empty when there is none."""
    lines: list[str] = []
    while (line := _whole_line(stream, problems)) and not line.lstrip().startswith(b"RECTANGLE"):
        lines.append(line.decode("utf-8", "replace").strip())
        if len(lines) == MOST_HEADER_LINES:
            problems.add("", f"has no RECTANGLE in its first {MOST_HEADER_LINES} lines")
            problems.raise_if_any()
    return lines, line


def _whole_line(stream: BinaryIO, problems: ProblemList) -> bytes:
    line = stream.readline(LONGEST_LINE)
    if len(line) == LONGEST_LINE and not line.endswith(b"\n"):
        problems.add("", f"has a line longer than {LONGEST_LINE} bytes")
        problems.raise_if_any()
    return line


def _parse_header(lines: Sequence[str], problems: ProblemList) -> PomHeader | None:
    values: dict[str, float] = {}
    for number, line in enumerate(lines, start=1):
        match = _HEADER_LINE.fullmatch(line)
        if not line or line.startswith("#") or (match and match[1] in _POM_WORDS):
            continue
        name = _OTHER_NAMES.get(match[1], match[1]) if match else ""
        pattern = _COUNT if name in _COUNTS else _MEASURE
        if match is None or name not in (*_COUNTS, *_MEASURES):
            problems.add(f"line {number}", f"neither a header line nor a RECTANGLE: {shown(line)}")
        elif name in values:
            problems.add(f"line {number}", f"{name} is given twice")
        elif pattern.fullmatch(match[2]) is None:
            problems.add(f"line {number}", f"{name} is {shown(match[2])} instead of a number")
        else:
            values[name] = float(match[2])
    if not values:
        return None
    missing = [name for name in (*_COUNTS, *_MEASURES) if name not in values and name != "REDUCTION"]
    if missing:
        problems.add("", f"the header lacks {', '.join(missing)}")
    return None if problems else _header(values, problems)


def _header(values: dict[str, float], problems: ProblemList) -> PomHeader | None:
    columns, rows, cameras = (int(values[name]) for name in _COUNTS)
    if not (columns and rows and cameras):
        problems.add("", "the header names no columns, no rows or no cameras")
        return None
    # A step of 0.1 comes back as such although 3 * 0.1 is not 0.3.
    steps = [float(f"{extent:.12g}") for extent in (values["WIDTH"] / columns, values["HEIGHT"] / rows)]
    if steps[0] != steps[1]:
        problems.add("", f"positions are {steps[0]} m apart along X and {steps[1]} m along Y")
        return None
    try:
        grid = Grid(columns, rows, steps[0], values["ORIGINE_X"], values["ORIGINE_Y"])
        cylinder = Cylinder(values["MAN_RAY"], values["MAN_HEIGHT"])
    except ValueError as error:
        problems.add("", f"impossible header: {error}")
        return None
    return PomHeader(grid, cylinder, cameras, values.get("REDUCTION", 1.0))


def _size(
    header: PomHeader | None, grid: Grid | None, cameras: int | None, problems: ProblemList
) -> tuple[int, int]:
    """Cameras and positions."""
    if header:
        if grid is not None and not _same_grid(header.grid, grid):
            problems.add("", f"is for {header.grid} instead of {grid}")
        if cameras is not None and header.cameras != cameras:
            problems.add("", f"is for {header.cameras} cameras instead of {cameras}")
        grid, cameras = header.grid, header.cameras
    problems.raise_if_any()
    if grid is None or cameras is None:
        problems.add("", "has no header, and nothing else says which grid and how many cameras it is for")
        raise FormatError(problems.found)
    if grid.count * cameras > MOST_ENTRIES:
        problems.add("", f"{cameras} cameras and {grid.count} positions are too many to read")
        raise FormatError(problems.found)
    return cameras, grid.count


def _same_grid(one: Grid, other: Grid) -> bool:
    close = [
        math.isclose(getattr(one, name), getattr(other, name), abs_tol=1e-9)
        for name in ("step", "origin_x", "origin_y")
    ]
    return (one.columns, one.rows) == (other.columns, other.rows) and all(close)


def _blocks(
    stream: BinaryIO, number: int, first: bytes, problems: ProblemList
) -> Iterator[tuple[int, bytes]]:
    """Blocks of whole lines, each with the number of its first line."""
    block = first
    while block:
        if not block.endswith(b"\n"):
            block += _whole_line(stream, problems)
        block = block.replace(b"\r\n", b"\n")
        yield number, block if block.endswith(b"\n") else block + b"\n"
        number += block.count(b"\n")
        block = stream.read(BLOCK_BYTES)


def _rows(number: int, block: bytes, problems: ProblemList) -> tuple[np.ndarray, np.ndarray]:
    """Line numbers (n,) and camera, position, box (n, 6) of the RECTANGLE lines of a block."""
    if _PLAIN_BLOCK.fullmatch(block):
        values = block.replace(b"RECTANGLE ", b"").replace(b"notvisible", b"-1 -1 -1 -1")
        rows = np.fromstring(values, dtype=np.int64, sep=" ").reshape(-1, 6)
        return np.arange(number, number + len(rows)), rows
    numbers, found = [], []
    for index, line in enumerate(block.split(b"\n")[:-1]):
        words = line.split()
        if not words or words[0].startswith(b"#"):
            continue
        if row := _values(words):
            numbers.append(number + index)
            found.append(row)
        else:
            text = shown(line.decode("utf-8", "replace").strip())
            problems.add(f"line {number + index}", f"not RECTANGLE, camera, position and a box: {text}")
    return np.array(numbers, dtype=np.int64), np.array(found, dtype=np.int64).reshape(-1, 6)


def _values(words: Sequence[bytes]) -> tuple[int, ...] | None:
    """Camera, position and box; None when the words are no RECTANGLE line."""
    if words[0] != b"RECTANGLE" or not all(_ID.fullmatch(word) for word in words[1:3]):
        return None
    if len(words) == 4 and words[3] == b"notvisible":
        return int(words[1]), int(words[2]), *_NOT_VISIBLE
    if len(words) == 7 and all(_INTEGER.fullmatch(word) for word in words[3:]):
        return tuple(map(int, words[1:]))
    return None
