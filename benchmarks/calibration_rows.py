"""Lines of the table that `python -m benchmarks.calibration` prints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

MARKS = {True: "met", False: "MISSED", None: ""}


@dataclass(frozen=True)
class Row:
    name: str
    got: str
    bar: str
    met: bool | None  # None: nothing to compare with


def table(rows: Sequence[Row]) -> str:
    cells = [("", "measured", "bar", "")]
    cells += [(row.name, row.got, row.bar, MARKS[row.met]) for row in rows]
    widths = [max(len(line[column]) for line in cells) for column in range(3)]
    return "\n".join(_line(line, widths) for line in cells)


def _line(cells: tuple[str, str, str, str], widths: Sequence[int]) -> str:
    name, got, bar, mark = cells
    return f"{name.ljust(widths[0])}  {got.rjust(widths[1])}  {bar.rjust(widths[2])}  {mark}".rstrip()
