"""A lens out of a file: cameras.json, what `calibrate lens --json` printed, or OpenCV's XML or YAML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.formats.calibration.cameras_json import FORMAT, load_taken
from gtm_hit.formats.calibration.wildtrack_xml import read_intrinsic
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import FormatError, Problem
from gtm_hit.formats.strict_json import parse_json
from gtm_hit.geometry.camera import CalibrationError, Camera, CameraModel

MOST_BYTES = 10_000_000
NOWHERE = np.zeros(3)
MATRIX_KEYS = ("camera_matrix", "matrix", "K")
DISTORTION_KEYS = ("distortion", "distortion_coefficients", "dist")
SIZE_KEYS = ("image_size", "size")

Size = tuple[int, int]  # width, height


def read_lens(path: Path, camera: str = "", size: Size | None = None) -> Lens:
    """The lens of pictures as they were taken; `camera` chooses where a file has several.

    `size` counts where the file tells none; without either it is guessed from the principal point.
    Raises FormatError.
    """
    try:
        if path.suffix.lower() == ".json":
            return _json_lens(path, camera, size)
        found = read_intrinsic(path)
        if found.model is CameraModel.FISHEYE:
            raise CalibrationError("a fisheye: this step knows OpenCV's usual lenses only")
        return checked_lens(found.matrix, found.distortion, size)
    except CalibrationError as error:
        raise FormatError([Problem(str(path), "", str(error))]) from error


def checked_lens(matrix: Any, distortion: Any, size: Size | None) -> Lens:
    """CalibrationError where these numbers are no lens."""
    width, height = size or (2, 2)
    made = Camera(0, "lens", width, height, matrix, NOWHERE, NOWHERE, distortion)
    if size is None:
        made = replace(made, width=_twice(made.matrix[0, 2]), height=_twice(made.matrix[1, 2]))
    return Lens(made.width, made.height, made.matrix, made.distortion)


def _twice(centre: float) -> int:
    return max(2, round(2 * centre))


def _json_lens(path: Path, camera: str, size: Size | None) -> Lens:
    content = parse_json(read_source(path, MOST_BYTES), str(path))
    if isinstance(content, dict) and content.get("format") == FORMAT:
        return _of_cameras(path, camera)
    if not isinstance(content, dict) or (matrix := _first(content, MATRIX_KEYS)) is None:
        known = ", ".join(MATRIX_KEYS)
        raise CalibrationError(f"neither a cameras.json nor an object with a camera's matrix ({known})")
    distortion = _first(content, DISTORTION_KEYS)
    return checked_lens(matrix, np.zeros(5) if distortion is None else distortion, _size(content) or size)


def _of_cameras(path: Path, name: str) -> Lens:
    cameras = load_taken(path)
    chosen = [each for each in cameras if each.name == name] if name or len(cameras) > 1 else cameras
    if not chosen:
        names = ", ".join(each.name for each in cameras)
        raise CalibrationError(f"has no camera {name or 'chosen'}; say which one: {names}")
    (found,) = chosen
    if found.model is CameraModel.FISHEYE:
        raise CalibrationError(f"{found.name}: a fisheye; this step knows OpenCV's usual lenses only")
    return Lens(found.width, found.height, found.matrix, found.distortion)


def _first(content: Mapping[str, Any], keys: tuple[str, ...]) -> Any:
    return next((content[key] for key in keys if key in content), None)


def _size(content: Mapping[str, Any]) -> Size | None:
    found = _first(content, SIZE_KEYS) or (content.get("width"), content.get("height"))
    if isinstance(found, list | tuple) and len(found) == 2 and all(type(each) is int for each in found):
        return found[0], found[1]
    return None
