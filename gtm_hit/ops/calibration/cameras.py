"""Calibration files into cameras, and whether these cameras can be what was meant."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median
from typing import TypeVar

import numpy as np
from django.core.exceptions import ValidationError

from gtm_hit.formats.calibration.cameras_json import load_cameras, load_taken
from gtm_hit.formats.calibration.files import CalibrationFiles, match_names
from gtm_hit.formats.calibration.wildtrack_xml import (
    Extrinsic,
    Intrinsic,
    read_extrinsic,
    read_intrinsic,
)
from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.geometry.camera import CalibrationError, Camera, Floats, undistort_maps, undistorted
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.undistorting import kept_matrix
from gtm_hit.models import Camera as CameraRow
from gtm_hit.models.dataset import name_validator
from gtm_hit.ops.files.images import Undistort, remapper

UNITS = {"m": "metres", "cm": "centimetres", "mm": "millimetres"}
METRES_PER = {"m": 1.0, "cm": 0.01, "mm": 0.001}
USUAL_HEIGHT = 4.0  # metres; only to tell units apart, which are a factor of ten and more
LOWEST_CAMERA = 0.3
FARTHEST_CAMERA = 100.0  # metres from the grid, or five times its diagonal

Part = TypeVar("Part", Intrinsic, Extrinsic)


@dataclass(frozen=True, eq=False)
class View:
    """A camera as people are annotated in it; `undistort` brings images as they were taken there."""

    camera: Camera
    undistort: Undistort | None = None
    taken: Camera | None = None  # as it took them, where they are undistorted


def read_views(
    files: CalibrationFiles,
    names: Sequence[str],
    sizes: Mapping[str, tuple[int, int]],
    unit: str,
    undistort: bool,
    problems: ProblemList,
    alpha: float | None = None,
) -> list[View]:
    """The cameras `names` in order; those with problems, or of no known size, are left out.

    With `alpha`, undistorted pictures get a camera matrix by `kept_matrix` and not the one of the files.
    """
    for name in names:
        try:
            name_validator(name)
        except ValidationError as error:
            problems.add(f"camera {name}", " ".join(error.messages))
    if files.cameras_json is not None:
        views = _views_of_json(files.cameras_json, names, sizes, undistort, problems)
    else:
        read = (
            _read_view(files, index, name, sizes.get(name), unit, undistort, problems)
            for index, name in enumerate(names)
        )
        views = [view for view in read if view is not None]
    return views if alpha is None else [_kept(view, alpha, problems) for view in views]


def _kept(view: View, alpha: float, problems: ProblemList) -> View:
    if view.taken is None:
        return view
    try:
        return undistorting(view.taken, kept_matrix(view.taken, alpha))
    except CalibrationError as error:
        problems.add("options", str(error))
        return view


def tell_wrong_unit(cameras: Sequence[Camera], grid: Grid, unit: str, problems: ProblemList) -> None:
    """A tvec in another unit puts cameras under the ground's skin or a kilometre away."""
    if not cameras:
        return
    height = median(abs(float(camera.centre[2])) for camera in cameras)
    away = median(_distance(camera, grid) for camera in cameras)
    if height >= LOWEST_CAMERA and away <= max(FARTHEST_CAMERA, 5 * math.hypot(*grid.extent)):
        return
    raw_height = height / METRES_PER[unit]

    def unlikeliness(each: str) -> float:
        return abs(math.log(max(raw_height * METRES_PER[each], 1e-9) / USUAL_HEIGHT))

    likely = min(UNITS, key=unlikeliness)
    if likely != unit:
        problems.add(
            "calibrations",
            f"cameras stand {away:.4g} m from the grid and {height:.3g} m high; "
            f"tvec looks like {UNITS[likely]}: use --tvec-unit {likely}",
        )


def tell_differences(
    cameras: Sequence[Camera], rows: Sequence[CameraRow], unit: str, problems: ProblemList
) -> None:
    """Cameras that are not those the dataset was imported with."""
    names, known = [camera.name for camera in cameras], [row.name for row in rows]
    if names != known:
        problems.add(
            "calibrations",
            f"cameras are {', '.join(names)}; the dataset was imported with {', '.join(known)}",
        )
        return
    for camera, row in zip(cameras, rows, strict=True):
        there = row.calibrated
        different = [
            name
            for name in ("width", "height", "matrix", "rvec", "tvec", "distortion")
            if not _equal(getattr(camera, name), getattr(there, name))
        ]
        if camera.model != there.model:
            different.append("model")
        if different:
            hint = _unit_hint(camera, there, unit) if different == ["tvec"] else ""
            problems.add(
                f"camera {camera.name}",
                f"the dataset was imported with another calibration ({', '.join(different)} differ){hint}",
            )


def _views_of_json(
    path: Path,
    names: Sequence[str],
    sizes: Mapping[str, tuple[int, int]],
    undistort: bool,
    problems: ProblemList,
) -> list[View]:
    """The file is in metres whatever unit the import was told: its format knows no other."""
    try:
        ideals = {camera.name: camera for camera in load_cameras(path)}
        takens = {camera.name: camera for camera in load_taken(path)}
    except FormatError as error:
        problems.extend(error.problems)
        return []
    found = match_names(names, list(ideals))
    for name in set(ideals) - set(found.values()):
        problems.add(f"camera {name}", "belongs to no camera that has images", path)
    views = []
    for index, name in enumerate(names):
        if name not in found:
            problems.add("cameras", f"none is camera {name}", path)
            continue
        ideal, size = ideals[found[name]], sizes.get(name)
        if size is None:
            continue
        if (ideal.width, ideal.height) != size:
            reason = f"{ideal.width}×{ideal.height} pixels, but the images have {size[0]}×{size[1]}"
            problems.add(f"camera {ideal.name}", reason, path)
            continue
        taken = replace(takens[ideal.name] if undistort else ideal, index=index, name=name)
        try:
            views.append(undistorting(taken, ideal.matrix) if undistort else View(taken))
        except CalibrationError as error:
            problems.add("", str(error), path)
    return views


def undistorting(taken: Camera, matrix: Floats) -> View:
    """The view of images whose lens is taken out, with the camera matrix they get."""
    return View(undistorted(taken, matrix), remapper(*undistort_maps(taken, matrix)), taken)


def _read_view(
    files: CalibrationFiles,
    index: int,
    name: str,
    size: tuple[int, int] | None,
    unit: str,
    undistort: bool,
    problems: ProblemList,
) -> View | None:
    taken, target = files.intrinsic.get(name), None
    if undistort or taken is None:
        # Without --undistort, original intrinsics alone mean: annotate in the pictures as they were taken.
        taken, target = files.intrinsic_original.get(name, taken), taken
    extrinsic = _read(read_extrinsic, files.extrinsic.get(name), problems)
    intrinsic = _read(read_intrinsic, taken, problems)
    ideal = _read(read_intrinsic, target, problems) if undistort and target != taken else None
    if extrinsic is None or intrinsic is None or size is None:
        return None
    pose = extrinsic.in_metres(unit)
    try:
        camera = Camera(
            index,
            name,
            *size,
            intrinsic.matrix,
            pose.rvec,
            pose.tvec,
            intrinsic.distortion,
            intrinsic.model,
        )
        if not undistort:
            return View(camera)
        return undistorting(camera, camera.matrix if ideal is None else ideal.matrix)
    except CalibrationError as error:
        problems.add("", str(error), taken)
        return None


def _read(read: Callable[[Path], Part], path: Path | None, problems: ProblemList) -> Part | None:
    if path is None:
        return None
    try:
        return read(path)
    except FormatError as error:
        problems.extend(error.problems)
        return None


def _distance(camera: Camera, grid: Grid) -> float:
    """Metres from a camera to the nearest point of the grid's area."""
    low = np.array([grid.origin_x, grid.origin_y])
    nearest = np.clip(camera.centre[:2], low, low + grid.extent)
    return float(np.linalg.norm(camera.centre - [*nearest, 0.0]))


def _equal(first: object, second: object) -> bool:
    """Equal but for the last digits, which another way of writing the same number may change."""
    one, other = np.ravel(np.asarray(first, dtype=float)), np.ravel(np.asarray(second, dtype=float))
    return one.shape == other.shape and np.allclose(one, other, rtol=1e-9, atol=1e-12)


def _unit_hint(camera: Camera, there: Camera, unit: str) -> str:
    for likely, metres in METRES_PER.items():
        if _equal(camera.tvec / METRES_PER[unit] * metres, there.tvec):
            return f": tvec looks like {UNITS[likely]}, use --tvec-unit {likely}"
    return ""
