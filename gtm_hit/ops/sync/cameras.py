"""The cameras of videos as their pictures were taken, where there is a calibration."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from statistics import median

from gtm_hit.formats.calibration.cameras_json import load_taken
from gtm_hit.formats.calibration.files import CalibrationFiles, find_calibrations, match_names
from gtm_hit.formats.dataset_folder import DatasetFolder
from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.geometry.camera import Camera
from gtm_hit.ops.calibration.cameras import METRES_PER, USUAL_HEIGHT, read_views


def cameras_as_taken(calibrations: Path, sizes: Mapping[str, tuple[int, int]]) -> list[Camera]:
    """In the order of `sizes`, in metres whatever unit the files are in. Raises FormatError."""
    problems = ProblemList("")
    files = find_calibrations(DatasetFolder(calibrations.parent, problems), list(sizes), calibrations)
    problems.raise_if_any()
    cameras = _cameras(files, sizes, problems)
    problems.raise_if_any()
    return cameras if files.cameras_json is not None else _in_metres(cameras)


def _cameras(
    files: CalibrationFiles, sizes: Mapping[str, tuple[int, int]], problems: ProblemList
) -> list[Camera]:
    names = list(sizes)
    if files.cameras_json is None:
        taken = {**files.intrinsic, **files.intrinsic_original}
        files = replace(files, intrinsic=taken, intrinsic_original={})
        return [view.camera for view in read_views(files, names, sizes, "m", False, problems)]
    known = {camera.name: camera for camera in load_taken(files.cameras_json)}
    found = match_names(names, list(known))
    for name in names:
        if name not in found:
            problems.add("cameras", f"none is camera {name}", files.cameras_json)
        elif (size := (known[found[name]].width, known[found[name]].height)) != sizes[name]:
            there = "{}×{} pixels, but the video has {}×{}".format(*size, *sizes[name])
            problems.add(f"camera {name}", there, files.cameras_json)
    return [known[found[name]] for name in names if name in found]


def _in_metres(cameras: list[Camera]) -> list[Camera]:
    """Units are a factor of ten and more apart, and cameras hang at a few metres."""
    height = median(abs(float(camera.centre[2])) for camera in cameras)
    scale = min(METRES_PER.values(), key=lambda each: abs(math.log(max(height * each, 1e-9) / USUAL_HEIGHT)))
    return [replace(camera, tvec=camera.tvec * scale) for camera in cameras]


def why_none(error: FormatError) -> str:
    """The first reason, which tells enough."""
    return error.problems[0].reason if error.problems else "it cannot be read"
