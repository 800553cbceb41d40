"""`manage.py calibrate ground`: where a camera stands, from measured points clicked in its picture."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from django.core.management.base import CommandError

from gtm_hit.calibration.ghosts import expected_pixels
from gtm_hit.calibration.ground_files import PointList, read_points
from gtm_hit.calibration.ground_points import METRES
from gtm_hit.calibration.lens_files import read_lens
from gtm_hit.calibration.pair_files import PairList, read_pairs
from gtm_hit.calibration.pose import PoseError, PoseSolution, solve_pose
from gtm_hit.formats.problems import FormatError

HELP = "Find where a camera stands from measured points clicked in its picture, and which of them are wrong."


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "pairs",
        type=Path,
        metavar="PAIRS.json",
        help="points with their pixels: pairs of name, point and pixel, or object_points and image_points",
    )
    parser.add_argument(
        "--lens",
        type=Path,
        required=True,
        metavar="FILE",
        help="what `calibrate lens --json` printed, a cameras.json, or OpenCV's intr_*.xml",
    )
    parser.add_argument(
        "--points",
        type=Path,
        metavar="FILE",
        help="the measured points by name, CSV or JSON; those not clicked yet are told where to expect",
    )
    parser.add_argument("--unit", choices=METRES, default="", help="of the points, where no file says it")
    parser.add_argument("--camera", default="", metavar="NAME", help="which one of a cameras.json")
    parser.add_argument(
        "--image-size", type=size, metavar="WIDTHxHEIGHT", help="where the lens's file does not tell it"
    )


def size(text: str) -> tuple[int, int]:
    """1920x1080 as two numbers."""
    width, sign, height = text.lower().replace("×", "x").partition("x")
    if not (sign and width.isdecimal() and height.isdecimal() and 0 < int(width) * int(height) < 10**9):
        raise ArgumentTypeError(f"{text!r} is not like 1920x1080")
    return int(width), int(height)


def run(options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
    try:
        points = read_points(options["points"], options["unit"]) if options["points"] else None
        # A unit said for the list of points is not one for pairs that have none.
        pairs = read_pairs(options["pairs"], points, "" if points else options["unit"])
        lens = read_lens(options["lens"], options["camera"] or pairs.camera, options["image_size"])
        solution = solve_pose(lens, pairs.pairs)
    except (FormatError, PoseError) as error:
        raise CommandError(str(error)) from error
    _tell(pairs, solution, say)
    return _content(pairs, solution, points)


def _tell(pairs: PairList, solution: PoseSolution, say: Callable[[str], object]) -> None:
    x, y, z = solution.centre.tolist()
    sigma = " ".join(f"{100 * each:.1f}" for each in solution.centre_sigma.tolist())
    say(f"{pairs.camera or 'camera'}: {len(solution.inliers)} of {len(pairs.pairs)} pairs agree")
    say(f"RMS {solution.rms:.3f} px")
    say(f"centre {x:.3f} {y:.3f} {z:.3f} m, ± {sigma} cm")
    say(f"{'pair':12}{'px':>9}{'cm':>9}")
    for each in solution.residuals:
        mark = "" if each.used else "  left out"
        say(f"{each.name:12}{each.px:9.2f}{each.cm:9.1f}{mark}")
    for text in (*pairs.doubts, *(finding.text for finding in solution.findings)):
        say(text)
    if not pairs.doubts and not solution.findings:
        say("Nothing looks wrong.")


def _content(pairs: PairList, solution: PoseSolution, points: PointList | None) -> dict[str, Any]:
    clicked = {pair.name for pair in pairs.pairs}
    left = [point for point in points.points if point.name not in clicked] if points else []
    return {
        "camera": pairs.camera,
        "rms": solution.rms,
        "rms_all": finite(solution.rms_all),
        "rvec": solution.rvec.tolist(),
        "tvec": solution.tvec.tolist(),
        "centre": solution.centre.tolist(),
        "centre_sigma": solution.centre_sigma.tolist(),
        "inliers": list(solution.inliers),
        "outliers": list(solution.outliers),
        "findings": [asdict(each) for each in solution.findings],
        "doubts": list(pairs.doubts),
        "pairs": [
            {"name": each.name, "px": finite(each.px), "cm": finite(each.cm), "used": each.used}
            for each in solution.residuals
        ],
        "expected": [asdict(each) for each in expected_pixels(solution, left) if each.visible],
    }


def finite(value: float) -> float | None:
    """JSON knows no NaN."""
    return value if np.isfinite(value) else None
