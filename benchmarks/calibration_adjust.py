"""Bundle adjustment: `python -m benchmarks.calibration_adjust [--data FOLDER]`.

FOLDER holds `wildtrack_ba` (ba_problem.txt, reference_results.json): WILDTRACK's own problem, whose two-pass
result was published. The same is always done with a problem of that size made from the project's own cameras.
Each variant runs in a process of its own with one thread; seconds are of one processor and with
nothing but the solution: reading, checks and steps.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from benchmarks.calibration_problem import pixels_off, synthesised, view_of
from benchmarks.calibration_rows import Row, table
from gtm_hit.calibration.adjustment.adjusting import Adjustment, adjust
from gtm_hit.calibration.adjustment.holdout import leave_one_view_out
from gtm_hit.calibration.adjustment.parameters import unpacked
from gtm_hit.calibration.adjustment.problem import Problem, View, problem_of
from gtm_hit.calibration.adjustment.report import report_of
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.calibration.adjustment.telling import content
from gtm_hit.formats.calibration.ba_problem import read_ba_problem
from gtm_hit.geometry.camera import Camera

REPOSITORY = Path(__file__).resolve().parent.parent
SIZE = (1920, 1080)
MOST_FIXED, MOST_TWO_PASS, MOST_SOFT = 25_610.0, 17_705.0, 18_000.0
MOST_CENTRE, MOST_HELD_OUT = 1.0, 5.0  # cm, px
MOST_SECONDS = {"fixed": 3.0, "two-pass": 8.0, "soft": 8.0}
MOST_BYTES = 300e6
LEFT_OUT = "one view left out, median of all that three saw"
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


@dataclass(frozen=True)
class Solved:
    """What a process told of one variant."""

    told: dict[str, Any]
    seconds: float  # of one processor
    peak: float  # bytes
    centres_off: float  # cm, the camera that is farthest from where it should be
    sigmas_off: float  # the same in σ of the result, the camera that is worst
    pixels_off: float  # median over the picture, the camera that is worst
    truth_held_out: float  # pixels: one view left out, median, by the cameras that are right


def rows(data: Path | None) -> list[Row]:
    """Lines of the table; those of the real problem only where FOLDER has it."""
    found = []
    if data is not None and (data / "wildtrack_ba").is_dir():
        solved = {name: _solved(name, data) for name in MOST_SECONDS}
        found += _costs(solved) + _worth("WILDTRACK", solved) + _speed("WILDTRACK", solved)
    solved = {name: _solved(name, None) for name in MOST_SECONDS}
    return found + _truth(solved) + _speed("own cameras", solved)


def _costs(solved: dict[str, Solved]) -> list[Row]:
    fixed, two_pass, soft = (solved[name].told["cost"] for name in ("fixed", "two-pass", "soft"))
    off = solved["two-pass"].centres_off
    return [
        Row("WILDTRACK, fixed: cost", f"{fixed:,.1f}", f"≤ {MOST_FIXED:,.0f}", fixed <= MOST_FIXED),
        Row(
            "WILDTRACK, two-pass: cost",
            f"{two_pass:,.1f}",
            f"≤ {MOST_TWO_PASS:,.0f}",
            two_pass <= MOST_TWO_PASS,
        ),
        Row(
            "WILDTRACK, two-pass: farthest centre from the published",
            f"{off:.2f} cm",
            f"≤ {MOST_CENTRE:.1f} cm",
            off <= MOST_CENTRE,
        ),
        Row("WILDTRACK, soft: cost with priors", f"{soft:,.1f}", f"≤ {MOST_SOFT:,.0f}", soft <= MOST_SOFT),
    ]


def _worth(name: str, solved: dict[str, Solved]) -> list[Row]:
    soft, lines = solved["soft"].told, []
    monotone = sum(camera["folding"]["monotone"] for camera in soft["cameras"])
    lines.append(Row(f"{name}, soft: lenses that do not fold", f"{monotone} of 7", "7 of 7", monotone == 7))
    for variant in ("two-pass", "soft"):
        each = solved[variant]
        median = each.told["hold_out"]["median_px"]
        beside = f"{median:.2f} px ({each.truth_held_out:.2f} by the published)"
        bar = f"≤ {MOST_HELD_OUT:.1f} px"
        lines.append(Row(f"{name}, {variant}: {LEFT_OUT}", beside, bar, median <= MOST_HELD_OUT))
    feet = solved["two-pass"].told["feet"]
    height = f"{100 * feet['median']:.1f} cm, spread {100 * feet['spread']:.1f} cm"
    lines.append(Row(f"{name}, two-pass: feet off the ground, median of {feet['count']}", height, "–", None))
    return lines


def _truth(solved: dict[str, Solved]) -> list[Row]:
    lines = []
    for variant in ("two-pass", "soft"):
        each, name = solved[variant], f"own cameras, {variant}"
        off = f"{each.centres_off:.1f} cm, {each.sigmas_off:.1f} of its σ"
        lines.append(Row(f"{name}: farthest centre from the true", off, "≤ 3 σ", each.sigmas_off <= 3))
    soft = solved["soft"]
    pixels, held_out, most = soft.pixels_off, soft.told["hold_out"]["median_px"], MOST_HELD_OUT
    name = "own cameras, soft"
    shown = f"{pixels:.2f} px"
    lines.append(Row(f"{name}: off in the picture, worst camera's median", shown, "≤ 2.0 px", pixels <= 2))
    beside = f"{held_out:.2f} px ({soft.truth_held_out:.2f} by the true cameras)"
    return [*lines, Row(f"{name}: {LEFT_OUT}", beside, f"≤ {most:.1f} px", held_out <= most)]


def _speed(name: str, solved: dict[str, Solved]) -> list[Row]:
    lines = [
        Row(
            f"{name}, {variant}: one core",
            f"{solved[variant].seconds:.1f} s",
            f"≤ {most:.0f} s",
            solved[variant].seconds <= most,
        )
        for variant, most in MOST_SECONDS.items()
    ]
    peak = max(each.peak for each in solved.values())
    return [
        *lines,
        Row(f"{name}: memory of the process", f"{peak / 1e6:.0f} MB", "≤ 300 MB", peak <= MOST_BYTES),
    ]


def _solved(variant: str, data: Path | None) -> Solved:
    command = [sys.executable, "-m", "benchmarks.calibration_adjust", "--solve", variant]
    command += ["--data", str(data)] if data else []
    environment = os.environ | ONE_THREAD
    told = subprocess.run(
        command, check=True, capture_output=True, text=True, cwd=REPOSITORY, env=environment
    )
    return Solved(**json.loads(told.stdout))


def solve(variant: str, data: Path | None) -> dict[str, Any]:
    """In this process; what `Solved` is made of."""
    cv2.setNumThreads(1)
    made = synthesised() if data is None else None
    start = time.process_time()
    problem = made[0] if made else _real(data)
    result = adjust(problem, Variant(variant))
    seconds = time.process_time() - start
    report = report_of(result)
    truth = tuple(view_of(camera) for camera in made[1]) if made else _published(data, problem)
    held_out = leave_one_view_out(truth, result.seen, len(problem.points), result.settings.turn)
    off = np.linalg.norm(_centres(result.views) - _centres(truth), axis=1)
    return {
        "told": content(result, report),
        "seconds": seconds,
        "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024,
        "centres_off": 100 * float(off.max()),
        "sigmas_off": float((off / np.linalg.norm(result.uncertainty.centres, axis=1)).max()),
        "pixels_off": _pixels_off(result, made[1]) if made else 0.0,
        "truth_held_out": held_out.share(50),
    }


def _centres(views: tuple[View, ...]) -> np.ndarray:
    return np.array([view.camera().centre for view in views])


def _pixels_off(result: Adjustment, cameras: list[Camera]) -> float:
    return max(pixels_off(view, camera) for view, camera in zip(result.views, cameras, strict=True))


def _real(data: Path) -> Problem:
    return problem_of(read_ba_problem(data / "wildtrack_ba" / "ba_problem.txt"), SIZE)


def _published(data: Path, problem: Problem) -> tuple[View, ...]:
    """The seven cameras as WILDTRACK published them."""
    told = json.loads((data / "wildtrack_ba" / "reference_results.json").read_text())
    rows = np.array(told["published"])[:, [*range(12), 13, 14, 12]]  # k1 k2 k3 p1 p2 into OpenCV's order
    rows[:, 3:6] /= 100
    return unpacked(rows, problem.views)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, help="folder that holds wildtrack_ba")
    parser.add_argument("--solve", choices=list(MOST_SECONDS), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.solve:
        print(json.dumps(solve(options.solve, options.data)))
        return
    print(table(rows(options.data)))


if __name__ == "__main__":
    main()
