"""Every bar of calibration as one table: `python -m benchmarks.calibration [--data FOLDER]`.

FOLDER holds the real data where there are any; without it the same is shown on data that the project makes.
`--part` measures one part alone.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from pathlib import Path

from benchmarks.calibration_rows import Row, table

PARTS = ("lens", "ground", "adjust", "drift", "sync")


def rows_of(part: str, data: Path | None) -> list[Row]:
    found: list[Row] = importlib.import_module(f"benchmarks.calibration_{part}").rows(data)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="a folder with the real calibration data")
    parser.add_argument("--part", choices=PARTS, action="append", help="only this part; may be repeated")
    options = parser.parse_args()
    if options.data and not options.data.is_dir():
        parser.error(f"{options.data} is no folder")
    every: list[Row] = []
    for part in [part for part in PARTS if not options.part or part in options.part]:
        rows = rows_of(part, options.data)
        every += rows
        print(f"\n{part.upper()}\n{table(rows)}", flush=True)
    missed = sum(row.met is False for row in every)
    print(f"\n{sum(row.met is True for row in every)} bars met, {missed} missed")
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
