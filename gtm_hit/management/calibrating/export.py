"""`manage.py calibrate export`: a calibration in the formats that others read."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from django.core.management.base import CommandError

from gtm_hit.calibration.adjustment.problem import NOBODY, Problem, View, file_of
from gtm_hit.calibration.lens_numbers import lens_of
from gtm_hit.formats.calibration.ba_problem import PER_METRE, write_ba_problem
from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.formats.calibration.published_folder import folder_files
from gtm_hit.formats.files import write_bytes
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import CalibrationError, Camera, CameraModel
from gtm_hit.management.calibrating.reading import add_calibration, read_as_problem, read_cameras

HELP = "Write a calibration as WILDTRACK lays it out, as cameras.json, or as ba_problem.txt."
FORMATS = ("wildtrack", "cameras-json", "ba-problem")


def add_arguments(parser: ArgumentParser) -> None:
    add_calibration(parser)
    parser.add_argument("out", type=Path, help="the folder (wildtrack) or file to write")
    parser.add_argument("--format", choices=FORMATS, required=True, help="what to write")
    parser.add_argument(
        "--unit", choices=sorted(PER_METRE), default="cm", help="of lengths; cameras-json has metres (cm)"
    )


def run(options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
    out, unit = options["out"], options["unit"]
    try:
        cameras = read_cameras(options)
        written = _write(cameras, options)
    except (FormatError, CalibrationError, ValueError) as error:
        raise CommandError(str(error)) from error
    except OSError as error:
        raise CommandError(f"{out}: {error.strerror}") from error
    unit = "m" if options["format"] == "cameras-json" else unit
    say(f"{len(cameras)} cameras in {len(written)} files below {out}, lengths in {unit}")
    names = [camera.name for camera in cameras]
    return {"format": options["format"], "unit": unit, "cameras": names, "files": written}


def _write(cameras: list[Camera], options: dict[str, Any]) -> list[str]:
    out, unit = options["out"], options["unit"]
    if options["format"] == "cameras-json":
        save_cameras(out, cameras)
        return [out.name]
    if options["format"] == "ba-problem":
        problem = read_as_problem(options) or _cameras_alone(cameras)
        write_ba_problem(out, file_of(problem, problem.views, problem.points), unit)
        return [out.name]
    files = dict(folder_files(cameras, unit))
    for name, data in files.items():
        write_bytes(out / name, data)
    return list(files)


def _cameras_alone(cameras: list[Camera]) -> Problem:
    """A problem without points. ValueError for lenses that such a file has no room for."""
    views = []
    for camera in cameras:
        if camera.model is not CameraModel.PINHOLE:
            raise ValueError(f"{camera.name}: ba_problem.txt has no fisheyes")
        lens = lens_of(camera)
        if lens.distortion.size == 4:
            lens = replace(lens, distortion=np.append(lens.distortion, 0.0))
        views.append(View(camera.name, lens, camera.rvec, camera.tvec))
    return Problem(tuple(views), np.zeros((0, 3)), NOBODY)
