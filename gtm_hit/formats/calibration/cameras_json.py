"""Cameras in one plain JSON file, the project's own calibration format.

    {
      "format": "gtm-cameras",
      "version": 1,
      "cameras": [
        {
          "name": "C1",
          "width": 1920, "height": 1080,               pixels
          "matrix": [[fx,0,cx],[0,fy,cy],[0,0,1]],     pixels
          "rvec": [3 numbers],                         radians, world to camera, OpenCV
          "tvec": [3 numbers],                         metres, world to camera, OpenCV
          "distortion": [4, 5, 8, 12 or 14 numbers],   OpenCV's order; may be left out: no lens
          "model": "pinhole",                          or "fisheye": cv2.fisheye's, whose distortion has
                                                       4 numbers; may be left out: pinhole
          "original": {"matrix": …,                    may be left out: as the camera saw it, where the
                       "distortion": …, "model": …}    above describes undistorted images
        }
      ]
    }

Cameras are numbered in the order of the list. Keys not named here are ignored.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gtm_hit.formats.files import read_source, write_bytes
from gtm_hit.formats.problems import FormatError, Problem, ProblemList, shown
from gtm_hit.geometry.camera import CalibrationError, Camera, CameraModel

FORMAT, VERSION = "gtm-cameras", 1
FACTS = ("name", "width", "height", "matrix", "rvec", "tvec", "distortion")
MOST_BYTES = 10_000_000
NUMBERS = ("matrix", "rvec", "tvec", "distortion")
NO_LENS = [0.0] * 5


def load_cameras(path: Path, original: bool = False) -> list[Camera]:
    """Cameras of the images as annotated or, if `original`, of the images as the cameras saw them.

    FormatError with everything that is wrong; with `original`, that includes a camera without such numbers.
    """
    return _load(path, lambda _facts: original)


def load_taken(path: Path) -> list[Camera]:
    """Cameras of the images as they were taken: `original` where a camera has it, else its only numbers."""
    return _load(path, lambda facts: isinstance(facts, dict) and "original" in facts)


def _load(path: Path, wants_original: Callable[[Any], bool]) -> list[Camera]:
    problems = ProblemList(path)
    cameras: list[Camera] = []
    for index, facts in enumerate(_entries(path)):
        place = f"cameras[{index}]"
        try:
            cameras.append(_camera(index, facts, wants_original(facts)))
        except KeyError as error:
            problems.add(place, f"{error.args[0]} is missing")
        except (CalibrationError, TypeError) as error:
            problems.add(place, str(error))
    names = [camera.name for camera in cameras]
    for name in sorted({name for name in names if names.count(name) > 1}):
        problems.add("cameras", f"more than one is named {shown(name)}")
    problems.raise_if_any()
    return cameras


def save_cameras(path: Path, cameras: Sequence[Camera]) -> None:
    """Write cameras so that `load_cameras` gives the same numbers back."""
    write_bytes(path, json.dumps(cameras_content(cameras), indent=2).encode() + b"\n")


def cameras_content(cameras: Sequence[Camera]) -> dict[str, Any]:
    """What such a file holds."""
    return {"format": FORMAT, "version": VERSION, "cameras": [camera_facts(camera) for camera in cameras]}


def cameras_of(content: dict[str, Any]) -> list[Camera]:
    """The cameras of what `cameras_content` made."""
    return [_camera(index, facts, original=False) for index, facts in enumerate(content["cameras"])]


def content_digest(content: dict[str, Any]) -> str:
    """SHA-256, hex, of the names and numbers in what `cameras_content` made, however it was stored since."""
    told = [
        [facts["name"], facts["width"], facts["height"]]
        # + 0.0 makes -0.0, which not every database keeps, and 0.0 one number.
        + [(np.ravel(facts[name]).astype(np.float64) + 0.0).tolist() for name in NUMBERS]
        for facts in content["cameras"]
    ]
    return hashlib.sha256(json.dumps(told).encode()).hexdigest()


def camera_facts(camera: Camera) -> dict[str, Any]:
    """One entry of the file; with an index, the arguments of `Camera` again."""
    facts = camera.as_json()
    pinhole = camera.model is CameraModel.PINHOLE
    return {name: facts[name] for name in (FACTS if pinhole else (*FACTS, "model"))}


def _entries(path: Path) -> list[Any]:
    try:
        content = json.loads(read_source(path, MOST_BYTES))
    except (ValueError, RecursionError) as error:
        raise FormatError([Problem(str(path), "", f"not JSON: {error}")]) from error
    if not isinstance(content, dict) or (content.get("format"), content.get("version")) != (FORMAT, VERSION):
        reason = f'no object with "format": "{FORMAT}" and "version": {VERSION}'
        raise FormatError([Problem(str(path), "", reason)])
    entries = content.get("cameras")
    if not isinstance(entries, list) or not entries:
        raise FormatError([Problem(str(path), "cameras", "not a list of at least one camera")])
    return entries


def _camera(index: int, facts: Any, original: bool) -> Camera:
    """KeyError, TypeError or CalibrationError when the facts make no camera."""
    name = _of_type(facts, "name", str)
    lens = _of_type(facts, "original", dict) if original else facts
    model = _model(lens)
    no_lens = [0.0] * 4 if model is CameraModel.FISHEYE else NO_LENS
    return Camera(
        index=index,
        name=name,
        width=_of_type(facts, "width", int),
        height=_of_type(facts, "height", int),
        matrix=lens["matrix"],
        rvec=facts["rvec"],
        tvec=facts["tvec"],
        distortion=lens.get("distortion", no_lens),
        model=model,
    )


def _model(lens: dict[str, Any]) -> CameraModel:
    value = lens.get("model", CameraModel.PINHOLE.value)
    if not isinstance(value, str) or value not in set(CameraModel):
        raise TypeError(f"model is {shown(value)}, not one of {', '.join(CameraModel)}")
    return CameraModel(value)


def _of_type(facts: Any, key: str, wanted: type) -> Any:
    if not isinstance(facts, dict):
        raise TypeError(f"not an object: {shown(facts)}")
    value = facts[key]
    if not isinstance(value, wanted) or isinstance(value, bool):
        raise TypeError(f"{key} is {shown(value)}, not {wanted.__name__}")
    return value
