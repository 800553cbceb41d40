"""Every bar of calibration as one table: `python -m benchmarks.calibration [--data FOLDER]`.

FOLDER holds the real data where there are any; without it the same is shown on data that the project makes.
`--part` measures one part alone.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks.calibration_rows import Row

PARTS = ("lens", "ground", "adjust", "sync")
MARKS = {True: "met", False: "MISSED", None: ""}


def rows_of(part: str, data: Path | None) -> list[Row]:
    found: list[Row] = importlib.import_module(f"benchmarks.calibration_{part}").rows(data)
    return found


def table(rows: Sequence[Row]) -> str:
    cells = [("", "measured", "bar", "")]
    cells += [(row.name, row.got, row.bar, MARKS[row.met]) for row in rows]
    widths = [max(len(line[column]) for line in cells) for column in range(4)]
    return "\n".join(
        "  ".join(
            (line[0].ljust(widths[0]), line[1].rjust(widths[1]), line[2].rjust(widths[2]), line[3])
        ).rstrip()
        for line in cells
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="a folder with the real calibration data")
    parser.add_argument("--part", choices=PARTS, action="append", help="only this part; may be repeated")
    options = parser.parse_args()
    if options.data and not options.data.is_dir():
        parser.error(f"{options.data} is no folder")
    there = [part for part in PARTS if importlib.util.find_spec(f"benchmarks.calibration_{part}")]
    every: list[Row] = []
    for part in there if not options.part else [part for part in there if part in options.part]:
        rows = rows_of(part, options.data)
        every += rows
        print(f"\n{part.upper()}\n{table(rows)}", flush=True)
    missed = sum(row.met is False for row in every)
    print(f"\n{sum(row.met is True for row in every)} bars met, {missed} missed")
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
