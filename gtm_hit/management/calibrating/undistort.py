"""`manage.py calibrate undistort`: take the lens out of pictures."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError

from gtm_hit.calibration.lens_files import read_lens
from gtm_hit.calibration.undistorted_pictures import pictures_in, size_of, undistort
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import CalibrationError

HELP = "Take the lens out of pictures; what it has no answer for becomes black and is counted."


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("pictures", type=Path, metavar="PICTURES", help="a picture, or a folder of them")
    parser.add_argument("out", type=Path, metavar="OUT", help="folder for the new pictures")
    parser.add_argument(
        "--lens",
        type=Path,
        required=True,
        metavar="FILE",
        help="what `calibrate lens --json` printed, a cameras.json, or OpenCV's intr_*.xml",
    )
    parser.add_argument("--camera", default="", metavar="NAME", help="which one of a cameras.json")
    parser.add_argument(
        "--alpha",
        type=float,
        metavar="0…1",
        help="0: no pixel stays black; 1: nothing that was seen is lost. Left out: the camera matrix stays",
    )


def run(options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
    try:
        pictures = pictures_in(options["pictures"])
        lens = read_lens(options["lens"], options["camera"], size_of(pictures[0]))
        last = None
        for last in undistort(pictures, lens, options["out"], options["alpha"]):
            say(f"{last.pictures} of {len(pictures)}")
    except (FormatError, CalibrationError, OSError) as error:
        raise CommandError(str(error)) from error
    assert last is not None
    share = 100 * last.black / (lens.width * lens.height)
    fx, fy, cx, cy = (float(last.matrix[at]) for at in ((0, 0), (1, 1), (0, 2), (1, 2)))
    say(f"new camera matrix: fx {fx:.3f} fy {fy:.3f} cx {cx:.3f} cy {cy:.3f}, no distortion")
    say(f"{last.black:,} pixels of each picture are black ({share:.1f} %)")
    if last.folded:
        say(f"{last.folded:,} of them because the lens folds before them and has no answer there")
    return {
        "pictures": last.pictures,
        "camera_matrix": last.matrix.tolist(),
        "distortion": [0.0] * 5,
        "image_size": [lens.width, lens.height],
        "black_pixels": last.black,
        "folded_pixels": last.folded,
    }
