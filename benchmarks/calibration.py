"""Every bar of calibration in one table: `python -m benchmarks.calibration [--data FOLDER] [--json]`.

FOLDER holds the real data; without it their rows say so. The same is shown on data that the project makes.
The program ends with 1 where a bar is missed.
"""

from __future__ import annotations

import argparse
import importlib
import json
import sys
from pathlib import Path

from benchmarks.calibration_rows import Row, content, in_part, summary, table

PARTS = ("lens", "ground", "adjust", "check", "drift", "export", "sync")


def rows_of(part: str, data: Path | None) -> list[Row]:
    found: list[Row] = importlib.import_module(f"benchmarks.calibration_{part}").rows(data)
    return in_part(part, found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="a folder with the real calibration data")
    parser.add_argument("--part", choices=PARTS, action="append", help="only this part; may be repeated")
    parser.add_argument("--json", action="store_true", help="print rows and counts as one JSON object")
    options = parser.parse_args()
    if options.data and not options.data.is_dir():
        parser.error(f"{options.data} is no folder")
    rows: list[Row] = []
    for part in [part for part in PARTS if not options.part or part in options.part]:
        print(f"measuring {part}", file=sys.stderr, flush=True)
        rows += rows_of(part, options.data)
    if options.json:
        print(json.dumps(content(rows), ensure_ascii=False, indent=1))
    else:
        print(f"{table(rows)}\n\n{summary(rows)}")
    sys.exit(any(row.met is False for row in rows))


if __name__ == "__main__":
    main()
