"""People on the ground in metres, as CSV: `frame,person,x,y` and optionally `height`, one person per line."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gtm_hit.formats.annotations.delimited_text import real, records, short, whole
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, shown

MOST_BYTES = 512 * 2**20
NEEDED = ("frame", "x", "y")
OPTIONAL = ("person", "height")


@dataclass(frozen=True, eq=False)
class GroundPoints:
    """One row per person and frame.

    frames : (N,) int64
    xy : (N, 2) float64, metres
    persons : (N,) int64; None where nobody has an identity, as in detections
    heights : (N,) float64, metres, NaN where not known; None where none is
    lines : (N,) int64, where the rows stood in the file; None when they come from elsewhere
    """

    frames: NDArray[np.int64]
    xy: NDArray[np.float64]
    persons: NDArray[np.int64] | None = None
    heights: NDArray[np.float64] | None = None
    lines: NDArray[np.int64] | None = None


def read_csv(path: Path) -> GroundPoints:
    """Raises FormatError, as `parse_csv`."""
    return parse_csv(read_source(path, MOST_BYTES), str(path))


def parse_csv(data: bytes, path: str) -> GroundPoints:
    """The people of a CSV file; the first line names the columns, in any order.

    People twice in a frame are left to the caller.

    Raises FormatError naming every line that is wrong: columns missing or unknown, values that are not finite
    numbers, negative frames or persons, heights that are not positive.
    """
    problems = ProblemList(path)
    rows = records(data)
    number, names = next(rows, (1, []))
    names = [name.lower() for name in names]
    _check_names(names, number, problems)
    numbers, values = array("q"), array("d")
    for number, words in rows:
        if len(words) != len(names):
            problems.add(f"line {number}", f"{len(words)} values instead of {len(names)} ({','.join(names)})")
            continue
        numbers.append(number)
        values.extend(_record(dict(zip(names, words, strict=True)), number, problems))
    table = np.frombuffer(values, dtype=np.float64).reshape(-1, 5)
    frames, persons = table[:, 0].astype(np.int64), table[:, 1].astype(np.int64)
    problems.raise_if_any()
    return GroundPoints(
        frames,
        table[:, 2:4],
        persons if "person" in names else None,
        table[:, 4] if "height" in names else None,
        np.frombuffer(numbers, dtype=np.int64),
    )


def csv_header(heights: bool = False) -> bytes:
    names = ["frame", "person", "x", "y", *(["height"] if heights else [])]
    return (",".join(names) + "\n").encode()


def csv_lines(table: GroundPoints, heights: bool = False) -> bytes:
    columns = [list(map(str, ids.tolist())) for ids in (table.frames, _present(table.persons))]
    columns += [[short(value) for value in column] for column in table.xy.T.tolist()]
    if heights:
        # NaN is the only number that differs from itself.
        columns.append([short(each) if each == each else "" for each in _present(table.heights).tolist()])
    return "".join(",".join(row) + "\n" for row in zip(*columns, strict=True)).encode()


def _check_names(names: list[str], number: int, problems: ProblemList) -> None:
    missing = [name for name in NEEDED if name not in names]
    unknown = [name for name in names if name not in (*NEEDED, *OPTIONAL)]
    if missing:
        problems.add(f"line {number}", f"names no column {', '.join(missing)}")
    if unknown:
        problems.add(f"line {number}", f"names unknown columns {shown(unknown)}")
    if len(set(names)) < len(names):
        problems.add(f"line {number}", "names a column twice")
    problems.raise_if_any()


def _record(values: dict[str, str], number: int, problems: ProblemList) -> tuple[float, ...]:
    frame = whole(values["frame"], "frame", 0, number, problems)
    person = whole(values.get("person", "0"), "person", 0, number, problems)
    x, y = (real(values[name], name, number, problems) for name in ("x", "y"))
    text = values.get("height", "")
    height = real(text, "height", number, problems) if text else np.nan
    if height <= 0:
        problems.add(f"line {number}", f"height is {shown(text)} instead of a positive number of metres")
    return frame, person, x, y, height


def _present(column: NDArray | None) -> NDArray:
    if column is None:
        raise ValueError("a table lacks a column that is to be written")
    return column
