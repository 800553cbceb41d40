"""Lines of the table that `python -m benchmarks.calibration` prints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

HEADING = ("part", "what", "bar", "measured", "")


@dataclass(frozen=True)
class Row:
    what: str
    measured: str
    bar: str  # empty: nothing to compare with
    met: bool | None
    part: str = ""
    absent: bool = False  # not measured: `measured` tells which data are not there

    @property
    def mark(self) -> str:
        if self.absent:
            return "no data"
        return "" if self.met is None else "met" if self.met else "MISSED"


@dataclass(frozen=True)
class Bar:
    """What is asked of something that is measured only where its data are."""

    what: str
    bar: str = ""

    def row(self, measured: str, met: bool | None = None) -> Row:
        return Row(self.what, measured, self.bar, met)


def absent(bars: Sequence[Bar], missing: str) -> Iterator[Row]:
    """Their rows where the data are not there."""
    return (Row(bar.what, f"{missing} is not there", bar.bar, None, absent=True) for bar in bars)


def in_part(part: str, rows: Sequence[Row]) -> list[Row]:
    return [replace(row, part=part) for row in rows]


def real_data(data: Path | None) -> Path:
    """The folder that has `wildtrack_ba` and the others; DATA itself or `calibration` in it."""
    if data is None:
        return Path("FOLDER")
    return data / "calibration" if (data / "calibration").is_dir() else data


def told(path: Path) -> str:
    """The last parts of a path, without what is the reader's own."""
    return "/".join(path.parts[-2:])


def table(rows: Sequence[Row]) -> str:
    cells = [(row.part, row.what, row.bar, row.measured, row.mark) for row in rows]
    widths = [max(len(line[column]) for line in [HEADING, *cells]) for column in range(len(HEADING))]
    rule = tuple("-" * width for width in widths)
    return "\n".join(_line(line, widths) for line in [HEADING, rule, *cells])


def summary(rows: Sequence[Row]) -> str:
    met, missed = (sum(row.met is met for row in rows) for met in (True, False))
    text = f"{met} bars met, {missed} missed"
    left = sum(row.absent for row in rows)
    return f"{text}, {left} not measured for want of data" if left else text


def content(rows: Sequence[Row]) -> dict[str, Any]:
    """All of it as JSON has it; `met` is null where there is no bar or no data."""
    return {
        "rows": [
            {
                "part": row.part,
                "what": row.what,
                "bar": row.bar or None,
                "measured": None if row.absent else row.measured,
                "met": row.met,
                "missing": row.measured if row.absent else None,
            }
            for row in rows
        ],
        "met": sum(row.met is True for row in rows),
        "missed": sum(row.met is False for row in rows),
        "not_measured": sum(row.absent for row in rows),
    }


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    return "  ".join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True)).rstrip()
