"""`manage.py calibrate drift`: whether a camera still stands where it stood, by its pictures alone."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from django.core.management.base import CommandError

from gtm_hit.calibration.drift.checking import MOVED, check
from gtm_hit.calibration.drift.marks import DriftError, Grey, choose
from gtm_hit.calibration.undistorted_pictures import pictures_in
from gtm_hit.formats.calibration.cameras_json import load_taken
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import CalibrationError, Camera

HELP = "Tell by how much a camera has moved between two sets of its pictures, in pixels and on the ground."


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "remembered", type=Path, metavar="REMEMBERED", help="a picture or folder, of when it was calibrated"
    )
    parser.add_argument("later", type=Path, metavar="LATER", help="a picture or folder, of afterwards")
    parser.add_argument(
        "--cameras", type=Path, metavar="FILE", help="a cameras.json, which tells centimetres"
    )
    parser.add_argument(
        "--camera", default="", metavar="NAME", help="which one of it (REMEMBERED's name without a suffix)"
    )


def run(options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
    name = options["camera"] or options["remembered"].stem
    try:
        camera = _camera(options["cameras"], name)
        before = pictures_in(options["remembered"])
        marks = choose([_grey(path) for path in before])
        found = []
        for path in pictures_in(options["later"]):
            drift = check(name, marks, _grey(path), camera)
            say(f"{path.name}: {drift.verdict}")
            found.append({"picture": path.name, **drift.as_json()})
    except (FormatError, CalibrationError, DriftError, OSError) as error:
        raise CommandError(f"{str(error).rstrip('.')}.") from error
    return {
        "marks": len(marks.marks),
        "pictures": found,
        "warns": any(each["state"] == MOVED for each in found),
    }


def _camera(path: Path | None, name: str) -> Camera | None:
    if path is None:
        return None
    known = {camera.name: camera for camera in load_taken(path)}
    if name not in known:
        raise CommandError(
            f"{path.name} has no camera {name}; there are {', '.join(known)}. Name one: --camera."
        )
    return known[name]


def _grey(path: Path) -> Grey:
    data = np.frombuffer(path.read_bytes(), np.uint8)
    pixels = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION) if data.size else None
    if pixels is None:
        raise DriftError(f"{path.name} is no picture that can be read")
    return np.asarray(pixels, dtype=np.uint8)
