"""Bundle adjustment: `python -m benchmarks.calibration_adjust [--data FOLDER]`.

FOLDER holds `wildtrack_ba` (ba_problem.txt, reference_results.json): WILDTRACK's own problem, whose two-pass
result was published. The same is always done with a problem of that size made from the project's own cameras.
Each variant runs in a process of its own with one thread.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from benchmarks.calibration_holdout import DRAWS, POINTS
from benchmarks.calibration_rows import Bar, Row, absent, real_data, table, told
from benchmarks.calibration_solve import Solved, solved_of

REPOSITORY = Path(__file__).resolve().parent.parent
MOST_COSTS = {"fixed": 25_610.0, "two-pass": 17_705.0, "soft": 18_000.0}
MOST_CENTRE, MOST_HELD_OUT, MOST_OFF = 1.0, 5.0, 2.0  # cm, px, px
MOST_SECONDS = {"fixed": 3.0, "two-pass": 8.0, "soft": 8.0}
MOST_BYTES = 300e6
LENSES_MOVE = ("two-pass", "soft")
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


class Bars:
    """What is asked of both problems, in the same words."""

    def __init__(self, name: str, costs: dict[str, str], centre: str, monotone: str) -> None:
        self.costs = {each: Bar(f"{name}, {each}: cost", bar) for each, bar in costs.items()}
        self.centres = {
            each: Bar(
                f"{name}, {each}: farthest centre", centre if each == "two-pass" or "σ" in centre else ""
            )
            for each in LENSES_MOVE
        }
        self.monotone = Bar(f"{name}, soft: lenses that do not fold", monotone)
        left_out, drawn = "one view left out, median / p75 / p90", f"median of {POINTS} points, {DRAWS} draws"
        most = f"≤ {MOST_HELD_OUT} px, median"
        self.held_out = {each: Bar(f"{name}, {each}: {left_out}", most) for each in LENSES_MOVE}
        self.drawn = {each: Bar(f"{name}, {each}: … {drawn}") for each in LENSES_MOVE}
        self.feet = Bar(f"{name}, two-pass: feet off the ground")
        self.seconds = {
            each: Bar(f"{name}, {each}: one core", f"≤ {most:.0f} s") for each, most in MOST_SECONDS.items()
        }
        self.memory = Bar(f"{name}: memory of the process", f"≤ {MOST_BYTES / 1e6:.0f} MB")

    @property
    def every(self) -> list[Bar]:
        many = (self.costs, self.centres, self.held_out, self.drawn, self.seconds)
        return [*(bar for bars in many for bar in bars.values()), self.monotone, self.feet, self.memory]


REAL = Bars("WILDTRACK", {name: f"≤ {most:,.0f}" for name, most in MOST_COSTS.items()}, "≤ 1.0 cm", "7 of 7")
OWN = Bars(
    "own cameras", dict.fromkeys(MOST_COSTS, "≤ the true cameras'"), "≤ 3 σ", "those that truly do not"
)
OWN_PIXELS = Bar("own cameras, soft: off in the picture, worst camera's median", f"≤ {MOST_OFF:.1f} px")


def rows(data: Path | None) -> list[Row]:
    """Lines of the table; where FOLDER has no real problem its lines say so."""
    folder = real_data(data) / "wildtrack_ba"
    real = _real_rows(folder) if folder.is_dir() else absent(REAL.every, told(folder))
    return [*real, *_own_rows()]


def _real_rows(folder: Path) -> Iterator[Row]:
    solved = {name: _solved(name, folder) for name in MOST_SECONDS}
    for name, most in MOST_COSTS.items():
        cost = solved[name].told["cost"]
        yield REAL.costs[name].row(f"{cost:,.1f}", cost <= most)
    for name, bar in REAL.centres.items():
        off = solved[name].centres_off
        yield bar.row(f"{off:.2f} cm from the published", off <= MOST_CENTRE if bar.bar else None)
    monotone = solved["soft"].monotone
    yield REAL.monotone.row(f"{monotone} of 7", monotone == 7)
    yield from _common(REAL, solved, "published")


def _own_rows() -> Iterator[Row]:
    solved = {name: _solved(name, None) for name in MOST_SECONDS}
    for name, bar in OWN.costs.items():
        cost, true = solved[name].told["cost"], solved[name].truth.cost
        yield bar.row(f"{cost:,.1f} ({true:,.1f})", cost <= true)
    for name, bar in OWN.centres.items():
        each = solved[name]
        yield bar.row(f"{each.centres_off:.1f} cm, {each.sigmas_off:.1f} of its σ", each.sigmas_off <= 3)
    soft = solved["soft"]
    yield OWN.monotone.row(f"{soft.monotone} of {soft.truth.monotone}", soft.monotone == soft.truth.monotone)
    yield OWN_PIXELS.row(f"{soft.pixels_off:.2f} px", soft.pixels_off <= MOST_OFF)
    yield from _common(OWN, solved, "true")


def _common(bars: Bars, solved: dict[str, Solved], right: str) -> Iterator[Row]:
    """Beside what was held out stands what the cameras that are right get by the same measure."""
    for name, bar in bars.held_out.items():
        found, by_right = solved[name].held_out, solved[name].truth.held_out
        yield bar.row(f"{_pixels(found)} ({right} {_pixels(by_right)})", found[0] <= MOST_HELD_OUT)
    for name, bar in bars.drawn.items():
        here, there = solved[name].drawn, solved[name].truth.drawn
        spread = f"{here.low:.2f} … {here.high:.2f}"
        yield bar.row(f"{here.median:.2f} px, 95 of 100 in {spread} ({right} {there.median:.2f})")
    feet = solved["two-pass"].told["feet"]
    height = f"{100 * feet['median']:.1f} cm, spread {100 * feet['spread']:.1f} cm"
    yield bars.feet.row(f"{height}, median of {feet['count']}")
    for name, bar in bars.seconds.items():
        seconds = solved[name].seconds
        yield bar.row(f"{seconds:.1f} s", seconds <= MOST_SECONDS[name])
    peak = max(each.peak for each in solved.values())
    yield bars.memory.row(f"{peak / 1e6:.0f} MB", peak <= MOST_BYTES)


def _pixels(shares: tuple[float, ...]) -> str:
    median, *rest = shares
    return " / ".join([f"{median:.2f}", *(f"{each:.1f}" for each in rest)])


def _solved(variant: str, folder: Path | None) -> Solved:
    command = [sys.executable, "-m", "benchmarks.calibration_solve", variant]
    command += ["--data", str(folder.absolute())] if folder else []
    environment = os.environ | ONE_THREAD
    done = subprocess.run(
        command, check=True, capture_output=True, text=True, cwd=REPOSITORY, env=environment
    )
    return solved_of(done.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, help="folder that holds wildtrack_ba")
    print(table(rows(parser.parse_args().data)))


if __name__ == "__main__":
    main()
