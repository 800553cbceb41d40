"""`manage.py calibrate adjust`: bundle adjustment of a `ba_problem.txt`."""

from __future__ import annotations

import json
import time
from argparse import ArgumentParser, ArgumentTypeError
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError

from gtm_hit.calibration.adjustment import telling
from gtm_hit.calibration.adjustment.adjusting import Adjustment, Step, adjust
from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.problem import Problem, file_of, problem_of
from gtm_hit.calibration.adjustment.report import report_of
from gtm_hit.calibration.adjustment.settings import Settings, Variant
from gtm_hit.calibration.adjustment.state import State
from gtm_hit.formats.calibration.ba_problem import PER_METRE, read_ba_problem, write_ba_problem
from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.formats.files import write_bytes
from gtm_hit.formats.problems import FormatError
from gtm_hit.management.calibrating.interrupting import Interrupts

HELP = "Adjust all cameras and points of a ba_problem.txt at once."
SAID_EVERY = 20  # steps


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("problem", type=Path, help="a ba_problem.txt")
    parser.add_argument(
        "--variant",
        choices=[variant.value for variant in Variant],
        default=Variant.SOFT.value,
        help="what of the lenses may move (soft: held near those of the file)",
    )
    parser.add_argument("--unit", choices=sorted(PER_METRE), default="cm", help="of the file's lengths (cm)")
    parser.add_argument(
        "--image-size",
        type=image_size,
        default=(1920, 1080),
        metavar="W×H",
        help="of the pictures, which the file does not tell (1920x1080)",
    )
    parser.add_argument("--names", help="of the cameras, divided by commas (C1,C2,…)")
    parser.add_argument(
        "--hold",
        action="append",
        default=[],
        metavar="CAMERA:WHAT",
        help="what of a camera stays: pose, lens, or parameters such as fx,k3; may be given several times",
    )
    parser.add_argument(
        "--ground-weight", type=float, help="of a click on a measured point (other clicks / these)"
    )
    parser.add_argument(
        "--ground-sigma",
        type=float,
        default=0.0,
        metavar="METRES",
        help="how far measured points may be off (0)",
    )
    parser.add_argument(
        "--output",
        type=Path,
        help="a .txt (ba_problem.txt again), a .json (cameras.json), or a folder for both and the report",
    )
    parser.add_argument(
        "--state", type=Path, help="kept here when interrupted, and taken up from here when it is there"
    )


def run(options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
    try:
        problem = read_problem(options)
        started = time.process_time(), time.perf_counter()
        with Interrupts() as interrupts:
            result = _adjusted(problem, options, say, lambda: interrupts.asked)
        seconds = time.perf_counter() - started[1]
        processor_seconds = time.process_time() - started[0]
    except (FormatError, AdjustmentError) as error:
        raise CommandError(str(error)) from error
    if not result.finished:
        raise CommandError(_keep(result, options["state"]))
    report = report_of(result)
    for line in telling.lines(result, report):
        say(line)
    told = telling.content(result, report)
    told |= {"seconds": round(seconds, 3), "processor_seconds": round(processor_seconds, 3)}
    if options["output"]:
        _write(options["output"], result, told, options["unit"])
    if options["state"]:
        options["state"].unlink(missing_ok=True)
    return told


def image_size(text: str) -> tuple[int, int]:
    width, _, height = text.replace("×", "x").partition("x")
    if not (width.isdecimal() and height.isdecimal() and int(width) and int(height)):
        raise ArgumentTypeError(f"{text} is no size such as 1920x1080")
    return int(width), int(height)


def read_problem(options: dict[str, Any]) -> Problem:
    """FormatError, AdjustmentError."""
    file = read_ba_problem(options["problem"], options["unit"])
    names = tuple(name.strip() for name in options["names"].split(",")) if options["names"] else None
    if names and len(names) != len(file.cameras):
        raise AdjustmentError(f"The file has {len(file.cameras)} cameras; --names has {len(names)}.")
    problem = problem_of(file, options["image_size"], names)
    if not options["ground_sigma"] >= 0:
        raise AdjustmentError("--ground-sigma must be 0 or more metres.")
    return replace(_holding(problem, options["hold"]), measured_sigma=options["ground_sigma"])


def _holding(problem: Problem, held: list[str]) -> Problem:
    stays: dict[str, set[str]] = {}
    for text in held:
        name, _, what = text.partition(":")
        if name not in problem.names or not what:
            known = ", ".join(problem.names)
            raise AdjustmentError(f"--hold {text}: write CAMERA:WHAT with one of the cameras {known}.")
        stays.setdefault(name, set()).update(what.split(","))
    views = tuple(replace(view, stays=frozenset(stays.get(view.name, ()))) for view in problem.views)
    return replace(problem, views=views)


def _adjusted(
    problem: Problem, options: dict[str, Any], say: Callable[[str], object], stop: Callable[[], bool]
) -> Adjustment:
    def progress(step: Step) -> None:
        if step.number % SAID_EVERY == 0:
            say(f"pass {step.pass_number} of {step.passes}, step {step.number}: cost {step.cost:,.1f}")

    weight = options["ground_weight"]
    if weight is not None and not weight > 0:
        raise AdjustmentError("--ground-weight must be above 0.")
    settings = Settings(ground_weight=weight)
    return adjust(problem, Variant(options["variant"]), settings, progress, stop, _state(options["state"]))


def _state(path: Path | None) -> State | None:
    if path is None or not path.exists():
        return None
    try:
        return State.of_json(json.loads(path.read_bytes()))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise AdjustmentError(f"{path} holds no state of an adjustment.") from error


def _keep(result: Adjustment, path: Path | None) -> str:
    if path is None:
        return f"Stopped after {result.steps} steps; nothing was kept (--state FILE keeps it)."
    write_bytes(path, json.dumps(result.state.as_json()).encode())
    return f"Stopped after {result.steps} steps; the same command goes on from {path}."


def _write(path: Path, result: Adjustment, told: dict[str, Any], unit: str) -> None:
    cameras = [view.camera(number) for number, view in enumerate(result.views)]
    file = file_of(replace(result.problem, measured=result.measured), result.views, result.points)
    if path.suffix == ".txt":
        write_ba_problem(path, file, unit)
    elif path.suffix == ".json":
        save_cameras(path, cameras)
    else:
        write_ba_problem(path / "ba_problem.txt", file, unit)
        save_cameras(path / "cameras.json", cameras)
        write_bytes(path / "report.json", json.dumps(told, indent=2, allow_nan=False).encode() + b"\n")
