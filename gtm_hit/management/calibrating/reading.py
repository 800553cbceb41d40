"""A calibration from whatever file or folder it is in."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError
from pathlib import Path
from typing import Any

from gtm_hit.calibration.adjustment.problem import Problem, problem_of
from gtm_hit.formats.calibration.ba_problem import PER_METRE, read_ba_problem
from gtm_hit.formats.calibration.cameras_json import load_taken
from gtm_hit.formats.calibration.published_folder import read_folder
from gtm_hit.geometry.camera import Camera

USUAL_SIZE = (1920, 1080)


def add_calibration(parser: ArgumentParser) -> None:
    parser.add_argument(
        "calibration", type=Path, help="a cameras.json, a folder laid out as WILDTRACK's, or a ba_problem.txt"
    )
    parser.add_argument(
        "--from-unit",
        choices=sorted(PER_METRE),
        help="of the folder's or the ba_problem.txt's lengths (what the files say; cm for ba_problem.txt)",
    )
    add_image_size(parser)


def add_image_size(parser: ArgumentParser) -> None:
    width, height = USUAL_SIZE
    parser.add_argument(
        "--image-size",
        type=image_size,
        default=USUAL_SIZE,
        metavar="WxH",
        help=f"of the pictures, where no file tells it ({width}x{height})",
    )


def image_size(text: str) -> tuple[int, int]:
    width, _, height = text.replace("×", "x").partition("x")
    if not (width.isdecimal() and height.isdecimal() and int(width) and int(height)):
        raise ArgumentTypeError(f"{text} is no size such as 1920x1080")
    return int(width), int(height)


def read_cameras(options: dict[str, Any]) -> list[Camera]:
    """The cameras of the pictures as taken. FormatError."""
    path, unit, size = options["calibration"], options["from_unit"], options["image_size"]
    if path.is_dir():
        return read_folder(path, size, unit)
    if path.suffix == ".txt":
        return [view.camera(number) for number, view in enumerate(_problem(path, unit, size).views)]
    return load_taken(path)


def read_as_problem(options: dict[str, Any]) -> Problem | None:
    """The whole problem where the calibration is a ba_problem.txt. FormatError."""
    path = options["calibration"]
    return _problem(path, options["from_unit"], options["image_size"]) if path.suffix == ".txt" else None


def _problem(path: Path, unit: str | None, size: tuple[int, int]) -> Problem:
    return problem_of(read_ba_problem(path, unit or "cm"), size)
