"""Finding where cameras stand: `python -m benchmarks.calibration_ground [--data FOLDER]`.

FOLDER holds `wildtrack_ba` (ground_points_C*.json, reference_results.json): the 150 published pairs with the
published lenses. The same is always done with pairs made from the project's own seven cameras: a grid of
2.5 m × 2 m, clicked with an error of 1 px (one standard deviation) along each axis.

Slips: in each trial one camera is drawn by its seed, and two of its pairs exchanged, or 1 m put on X or Y of
one point. The thresholds were chosen on seeds 1000 to 1199; the seeds told here are others.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.calibration_clicks import WANTED, corners, effort, some_four
from benchmarks.calibration_rows import Bar, Row, absent, real_data, table, told
from gtm_hit.calibration.ghosts import expected_pixels
from gtm_hit.calibration.ground_points import regular_grid
from gtm_hit.calibration.lens_numbers import Lens, lens_of
from gtm_hit.calibration.pair_files import read_pairs
from gtm_hit.calibration.pose import Pair, PoseSolution, Trouble, solve_pose
from gtm_hit.formats.calibration.cameras_json import load_taken
from gtm_hit.geometry.camera import Camera

FIXTURE = Path(__file__).resolve().parent.parent / "fixtures" / "wildtrack_cameras.json"
TRIALS = range(20)
CLICK = 1.0  # pixels
MOST_RMS, MOST_OFF, MOST_MS = 1.66, 1.2, 50.0  # px, cm, ms
MOST_CLICKS, DRAWS = 30, 20
ORDER = "XY"


@dataclass(frozen=True, eq=False)
class Clicked:
    """A camera whose place is known, and pairs clicked in it."""

    camera: Camera
    lens: Lens
    pairs: Sequence[Pair]


@dataclass(frozen=True)
class Solved:
    solution: PoseSolution
    ms: float  # of one processor


def rows(data: Path | None) -> list[Row]:
    """Lines of the table; where FOLDER has no real pairs theirs say so."""
    folder = real_data(data) / "wildtrack_ba"
    real = Bars("150 published pairs", f"≤ {MOST_OFF} cm")
    made = Bars("pairs of own cameras", "≤ 3 of its own σ")
    measured = _rows(real, published(folder)) if folder.is_dir() else absent(real.every, told(folder))
    return [*measured, *_rows(made, synthesised(seed=7))]


def published(folder: Path) -> list[Clicked]:
    reference = json.loads((folder / "reference_results.json").read_text())["published"]
    return [
        _published(folder / f"ground_points_C{index + 1}.json", index, np.array(numbers))
        for index, numbers in enumerate(reference)
    ]


def _published(path: Path, index: int, numbers: np.ndarray) -> Clicked:
    fx, fy, cx, cy, k1, k2, k3, p1, p2 = numbers[6:]
    matrix = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    lens = Lens(1920, 1080, matrix, np.array([k1, k2, p1, p2, k3]))
    camera = lens.camera(f"C{index + 1}", numbers[:3], numbers[3:6] / 100, index)
    return Clicked(camera, lens, read_pairs(path).pairs)


def synthesised(seed: int) -> list[Clicked]:
    rng = np.random.default_rng(seed)
    grid = regular_grid(4, 9, (2.5, 2.0), (-1.0, -3.0))
    found = []
    for camera in load_taken(FIXTURE):
        lens = lens_of(camera)
        exact = PoseSolution(camera.rvec, camera.tvec, np.zeros((6, 6)), (), (), lens)
        seen = zip(grid, expected_pixels(exact, grid), strict=True)
        pairs = [
            Pair(ghost.name, point.place, _clicked(ghost, rng)) for point, ghost in seen if ghost.visible
        ]
        found.append(Clicked(camera, lens, pairs))
    return found


def _clicked(ghost, rng: np.random.Generator) -> tuple[float, float]:
    x, y = np.round(np.array([ghost.x, ghost.y]) + rng.normal(0, CLICK, 2))
    return float(x), float(y)


class Bars:
    """What is asked of pairs, of the real ones and of those made here."""

    def __init__(self, name: str, most_off: str) -> None:
        count = f"{len(TRIALS)} of {len(TRIALS)}"
        self.rms = Bar(f"{name}: RMS", f"≤ {MOST_RMS} px")
        self.off = Bar(f"{name}: farthest centre", most_off)
        self.swaps = Bar(f"{name}: swapped pair named", count)
        self.slips = Bar(f"{name}: 1 m typed wrong named", count)
        self.clicks = Bar(f"{name}: clicks until {WANTED} are in, after the fourth", f"≤ {MOST_CLICKS}")
        self.any_four = Bar(f"{name}: the same after any four ({DRAWS} draws a camera)", f"≤ {MOST_CLICKS}")
        self.ms = Bar(f"{name}: slowest solve", f"≤ {MOST_MS:.0f} ms")
        self.every = (self.rms, self.off, self.swaps, self.slips, self.clicks, self.any_four, self.ms)


def _rows(bars: Bars, cameras: Sequence[Clicked]) -> Iterator[Row]:
    solved = [_solved(each.lens, each.pairs) for each in cameras]
    misses = np.array([miss.px for each in solved for miss in each.solution.residuals])
    rms = float(np.sqrt(np.mean(misses**2)))
    swaps, slips = _named(cameras, swapped), _named(cameras, mistyped)
    slowest = max([*(each.ms for each in solved), *(ms for _ok, ms in swaps + slips)])
    yield bars.rms.row(f"{rms:.3f} px of {len(misses)}", rms <= MOST_RMS)
    yield _off_row(bars.off, cameras, solved)
    yield _named_row(bars.swaps, swaps)
    yield _named_row(bars.slips, slips)
    yield from _click_rows(bars, cameras)
    yield bars.ms.row(f"{slowest:.0f} ms", slowest <= MOST_MS)


def _click_rows(bars: Bars, cameras: Sequence[Clicked]) -> Iterator[Row]:
    """Of the camera that takes most; then the same from fours that nobody would choose."""
    far = [effort(each.lens, each.pairs, corners(each.pairs)) for each in cameras]
    most = max(far, key=lambda each: each.actions)
    off = [
        100 * float(np.linalg.norm(done.solution.centre - each.camera.centre))
        for done, each in zip(far, cameras, strict=True)
    ]
    parts = f"{most.confirmed} confirmed, {most.clicked} clicked, {most.chosen} chosen by name"
    yield bars.clicks.row(f"{most.actions} ({parts}; centres {max(off):.1f} cm)", most.actions <= MOST_CLICKS)
    rng = np.random.default_rng(0)
    drawn = [
        effort(each.lens, each.pairs, some_four(each.lens, each.pairs, rng)).actions
        for each in cameras
        for _ in range(DRAWS)
    ]
    told_of = f"{max(drawn)} at most, {np.median(drawn):.0f} median"
    yield bars.any_four.row(told_of, max(drawn) <= MOST_CLICKS)


def _off_row(bar: Bar, cameras: Sequence[Clicked], solved: Sequence[Solved]) -> Row:
    """Published centres were found by the same clicks; synthesised ones are the truth, clicks are not."""
    off = [
        100 * float(np.linalg.norm(found.solution.centre - each.camera.centre))
        for each, found in zip(cameras, solved, strict=True)
    ]
    if "σ" not in bar.bar:
        return bar.row(f"{max(off):.2f} cm", max(off) <= MOST_OFF)
    spread = [100 * each.solution.centre_spread for each in solved]
    worst = max(miss / sigma for miss, sigma in zip(off, spread, strict=True))
    return bar.row(f"{max(off):.2f} cm, {worst:.1f} of its own σ", worst <= 3)


def _named_row(bar: Bar, trials: Sequence[tuple[bool, float]]) -> Row:
    count = sum(ok for ok, _ms in trials)
    return bar.row(f"{count} of {len(trials)}", count == len(trials))


def _named(cameras: Sequence[Clicked], slip) -> list[tuple[bool, float]]:
    found = []
    for seed in TRIALS:
        rng = np.random.default_rng(seed)
        each = cameras[int(rng.integers(len(cameras)))]
        pairs, trouble, names, text = slip(each.pairs, rng)
        solved = _solved(each.lens, pairs)
        told = [finding for finding in solved.solution.findings if finding.names]
        right = [(finding.trouble, finding.names) for finding in told] == [(trouble, names)]
        found.append((right and text in told[0].text, solved.ms))
    return found


def swapped(pairs: Sequence[Pair], rng: np.random.Generator):
    first, second = sorted(rng.choice(len(pairs), 2, replace=False).tolist())
    spoilt = list(pairs)
    spoilt[first] = replace(pairs[first], pixel=pairs[second].pixel)
    spoilt[second] = replace(pairs[second], pixel=pairs[first].pixel)
    return spoilt, Trouble.SWAPPED, (pairs[first].name, pairs[second].name), "look swapped"


def mistyped(pairs: Sequence[Pair], rng: np.random.Generator):
    index, axis, by = int(rng.integers(len(pairs))), int(rng.integers(2)), float(rng.choice([-1.0, 1.0]))
    point = list(pairs[index].point)
    point[axis] += by
    spoilt = list(pairs)
    spoilt[index] = replace(pairs[index], point=tuple(point))
    name = pairs[index].name
    return spoilt, Trouble.COORDINATE, (name,), f"{ORDER[axis]} of point {name} looks wrong by 1.00 m"


def _solved(lens: Lens, pairs: Sequence[Pair]) -> Solved:
    started = time.process_time()
    solution = solve_pose(lens, pairs)
    return Solved(solution, 1000 * (time.process_time() - started))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, help="folder with wildtrack_ba")
    print(table(rows(parser.parse_args().data)))


if __name__ == "__main__":
    main()
