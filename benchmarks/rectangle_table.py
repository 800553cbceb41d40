"""How long the rectangle table of the seven WILDTRACK cameras takes to build and to open, and its grid files.

python -m benchmarks.rectangle_table
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import numpy as np

from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.cylinder import Cylinder, FootRule
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.grid_file import encode
from gtm_hit.geometry.table import RectangleTable

CAMERAS = Path(__file__).resolve().parent.parent / "fixtures" / "wildtrack_cameras.json"
GRID = Grid(columns=480, rows=1440, step=0.025, origin_x=-3.0, origin_y=-9.0)
RUNS = 7


def build_seconds() -> float:
    cameras = load_cameras(CAMERAS)
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        RectangleTable.build(Path(folder), cameras, GRID, Cylinder(0.16, 1.80), FootRule.CORNERS)
        return time.perf_counter() - start


def open_in_fresh_process(path: Path) -> tuple[float, float, float]:
    """Milliseconds to open and look up one position; private megabytes of that, and of 1,000 look-ups."""
    command = [sys.executable, "-m", "benchmarks.rectangle_table", "--open", str(path)]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    milliseconds, opened, used = map(float, output.split())
    return milliseconds, opened, used


def measure_opening(path: Path) -> None:
    before, dirty_before = private_bytes(), private_bytes(("Private_Dirty",))
    start = time.perf_counter()
    table = RectangleTable.open(path)
    table.rectangles([345_678])
    seconds = time.perf_counter() - start
    opened = private_bytes() - before
    positions = np.random.default_rng(0).integers(0, table.grid.count, 1000)
    for position in positions:
        table.rectangles([position])
    used = private_bytes(("Private_Dirty",)) - dirty_before
    print(seconds * 1e3, opened / 1e6, used / 1e6)


def private_bytes(kinds: tuple[str, ...] = ("Private_Dirty", "Private_Clean")) -> int:
    """Memory no other process shares.

    Clean pages are the table's own, looked at by this process only: the system may drop them at any time.
    """
    lines = Path("/proc/self/smaps_rollup").read_text().splitlines()
    return sum(int(line.split()[1]) * 1024 for line in lines if line.startswith(kinds))


def grid_files(table: RectangleTable) -> tuple[list[float], list[int]]:
    """Seconds and bytes of each camera's grid file."""
    seconds, sizes = [], []
    for camera in load_cameras(CAMERAS):
        start = time.perf_counter()
        sizes.append(len(encode(table.boxes(camera.index), camera, GRID)))
        seconds.append(time.perf_counter() - start)
    return seconds, sizes


def main() -> None:
    if sys.argv[1:2] == ["--open"]:
        measure_opening(Path(sys.argv[2]))
        return
    builds = [build_seconds() for _ in range(RUNS)]
    with tempfile.TemporaryDirectory() as folder:
        cameras = load_cameras(CAMERAS)
        table = RectangleTable.build(Path(folder), cameras, GRID, Cylinder(0.16, 1.80), FootRule.CORNERS)
        openings = [open_in_fresh_process(table.path) for _ in range(RUNS)]
        size = table.path.stat().st_size
        seconds, sizes = grid_files(table)
    milliseconds, opened, used = (median(values) for values in zip(*openings, strict=True))
    cores = len(os.sched_getaffinity(0))
    print(f"rectangle table, 7 cameras × {GRID.count:,} positions, {size / 1e6:.1f} MB, {cores} cores")
    print(f"  build                    {median(builds):6.2f} s   (best {min(builds):.2f}, median of {RUNS})")
    print(f"  open, first look-up      {milliseconds:6.2f} ms  (fresh process)")
    print(f"  private memory, opened   {opened:6.2f} MB")
    print(f"  after 1,000 look-ups     {used:6.2f} MB  (without clean pages of the file)")
    print(f"  grid files, all          {sum(sizes) / 1e6:6.2f} MB  (largest {max(sizes) / 1e6:.2f})")
    print(f"  written, all             {sum(seconds):6.2f} s   (slowest {max(seconds):.2f})")


if __name__ == "__main__":
    main()
