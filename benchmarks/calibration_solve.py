"""One bundle adjustment and what it is worth: `python -m benchmarks.calibration_solve VARIANT`.

Prints JSON. With `--data FOLDER` it is WILDTRACK's own problem, else one of that size with a known truth.
Seconds are of one processor and of nothing but the solution: reading, checks and steps.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from benchmarks.calibration_holdout import Drawn, drawn
from benchmarks.calibration_problem import pixels_off, synthesised, view_of
from gtm_hit.calibration.adjustment.adjusting import PASSES, Adjustment, adjust
from gtm_hit.calibration.adjustment.holdout import leave_one_view_out
from gtm_hit.calibration.adjustment.parameters import packed, unpacked
from gtm_hit.calibration.adjustment.problem import Problem, View, problem_of
from gtm_hit.calibration.adjustment.report import report_of
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.calibration.adjustment.settling import settled
from gtm_hit.calibration.adjustment.system import all_points, system_of
from gtm_hit.calibration.adjustment.telling import content
from gtm_hit.calibration.folding import folding
from gtm_hit.formats.calibration.ba_problem import read_ba_problem

SIZE = (1920, 1080)
SHARES = (50, 75, 90)


@dataclass(frozen=True)
class Truth:
    """The cameras that are right, the published ones of the real problem, judged as the result is."""

    cost: float  # with the points where they cost least
    monotone: int  # lenses that do not fold
    held_out: tuple[float, ...]  # pixels: one view left out; median, 75 and 90 of 100
    drawn: Drawn


@dataclass(frozen=True)
class Solved:
    """What a process told of one variant."""

    told: dict[str, Any]
    truth: Truth
    drawn: Drawn
    seconds: float  # of one processor
    peak: float  # bytes
    centres_off: float  # cm, the camera that is farthest from where it should be
    sigmas_off: float  # the same in σ of the result, the camera that is worst
    pixels_off: float  # median over the picture, the camera that is worst

    @property
    def monotone(self) -> int:
        return sum(camera["folding"]["monotone"] for camera in self.told["cameras"])

    @property
    def held_out(self) -> tuple[float, ...]:
        told = self.told["hold_out"]
        return told["median_px"], told["p75_px"], told["p90_px"]


def solved_of(text: str) -> Solved:
    """What `main` printed."""
    told = json.loads(text)
    truth = told.pop("truth")
    by_truth = Truth(**(truth | {"drawn": Drawn(**truth["drawn"])}))
    return Solved(**(told | {"truth": by_truth, "drawn": Drawn(**told["drawn"])}))


def solve(variant: Variant, folder: Path | None) -> Solved:
    made = synthesised() if folder is None else None
    start = time.process_time()
    problem = made[0] if made else _real(folder)
    result = adjust(problem, variant)
    seconds = time.process_time() - start
    told = content(result, report_of(result))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    views = tuple(view_of(camera) for camera in made[1]) if made else _published(folder, problem)
    off = np.linalg.norm(_centres(result.views) - _centres(views), axis=1)
    return Solved(
        told=told,
        truth=_truth(result, views),
        drawn=drawn(result.views, result.seen, len(problem.points)),
        seconds=seconds,
        peak=peak,
        centres_off=100 * float(off.max()),
        sigmas_off=float((off / np.linalg.norm(result.uncertainty.centres, axis=1)).max()),
        pixels_off=_pixels_off(result, made[1]) if made else 0.0,
    )


def _truth(result: Adjustment, views: tuple[View, ...]) -> Truth:
    free, turn = len(result.problem.points), result.settings.turn
    held_out = leave_one_view_out(views, result.seen, free, turn)
    return Truth(
        _cost(result, views),
        sum(folding(view.lens).monotone for view in views),
        tuple(held_out.share(share) for share in SHARES),
        drawn(views, result.seen, free),
    )


def _cost(result: Adjustment, views: tuple[View, ...]) -> float:
    """Of the right cameras, as far as the variant may reach them: where lenses stay they stay."""
    problem, last = result.problem, PASSES[result.variant][-1]
    if not last.lenses:
        started = zip(problem.views, views, strict=True)
        views = tuple(replace(start, rvec=view.rvec, tvec=view.tvec) for start, view in started)
    rows = packed(views)
    held = np.zeros(rows.shape, dtype=bool)
    system = system_of(problem, result.settings, result.seen, held, last.lenses, last.soft)
    points = settled(rows, all_points(problem), result.seen, system.movable, result.settings.turn)
    return system.cost(rows, points).total


def _centres(views: tuple[View, ...]) -> np.ndarray:
    return np.array([view.camera().centre for view in views])


def _pixels_off(result: Adjustment, cameras: list) -> float:
    return max(pixels_off(view, camera) for view, camera in zip(result.views, cameras, strict=True))


def _real(folder: Path) -> Problem:
    return problem_of(read_ba_problem(folder / "ba_problem.txt"), SIZE)


def _published(folder: Path, problem: Problem) -> tuple[View, ...]:
    """The seven cameras as WILDTRACK published them."""
    told = json.loads((folder / "reference_results.json").read_text())
    rows = np.array(told["published"])[:, [*range(12), 13, 14, 12]]  # k1 k2 k3 p1 p2 into OpenCV's order
    rows[:, 3:6] /= 100
    return unpacked(rows, problem.views)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("variant", choices=[variant.value for variant in Variant])
    parser.add_argument("--data", type=Path, help="the folder wildtrack_ba")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    print(json.dumps(asdict(solve(Variant(options.variant), options.data))))


if __name__ == "__main__":
    main()
