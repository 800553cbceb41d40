"""Detectors at an address: the body that CVAT's serverless detectors read, or one body for all views.

`GET /health` tells which: `{"multi_view": true, "model_version": "…"}` of whoever takes all views at once.
CVAT's containers know no such question; whatever they answer to it, they are alive, and get one picture at a
time.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from typing import Any

import cv2

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.boxes import Box, Picture
from gtm_hit.vision.detectors.checking import as_list, checked_box, checked_place
from gtm_hit.vision.detectors.errors import DetectorError
from gtm_hit.vision.detectors.exchange import Limits, as_json, exchange
from gtm_hit.vision.detectors.labels import is_person
from gtm_hit.vision.located import Located

LOWEST = 0.25  # boxes below are not asked for
QUALITY = 95  # of the JPEG that is sent
LONGEST = 190  # characters of a version that can be kept


class HttpDetector:
    """One picture at a time: `{image, threshold}` → `[{confidence, label, type: "rectangle", points}]`."""

    def __init__(self, address: str, version: str, limits: Limits) -> None:
        self.address, self.version, self._limits = address, version, limits

    def detect(self, image: Picture) -> list[Box]:
        body = {"image": encoded(image), "threshold": LOWEST}
        answer = as_json(exchange("POST", self.address, body, self._limits))
        size = (image.shape[1], image.shape[0])
        found = (_box(each, size) for each in as_list(answer, "boxes"))
        return [box for box in found if box is not None]


class HttpLocator:
    """All views at once: `{frame, cameras, images, grid}` → `{model_version, ground: [{x, y, score}]}`."""

    def __init__(self, address: str, version: str, limits: Limits) -> None:
        self.address, self.version, self._limits = address, version, limits

    def locate(
        self, pictures: Mapping[str, Picture], cameras: Mapping[str, Camera], grid: Grid, frame: int
    ) -> list[Located]:
        body = {
            "frame": frame,
            "cameras": [_camera(cameras[name], picture) for name, picture in pictures.items()],
            "images": {name: encoded(picture) for name, picture in pictures.items()},
            "grid": vars(grid),
        }
        answer = as_json(exchange("POST", self.address, body, self._limits))
        if not isinstance(answer, dict) or "ground" not in answer:
            raise DetectorError("the detector's answer has no ground")
        return [_place(each) for each in as_list(answer["ground"], "people")]


def at_address(address: str, limits: Limits | None = None) -> HttpDetector | HttpLocator:
    """Whoever is there; DetectorError if nobody is."""
    limits = limits or Limits()
    told = _health(address, limits)
    version = f"{address} {told.get('model_version', '')}".strip()[:LONGEST]
    kind = HttpLocator if told.get("multi_view") is True else HttpDetector
    return kind(address, version, limits)


def _health(address: str, limits: Limits) -> dict[str, Any]:
    answer = exchange("GET", address, None, limits.for_health(), "/health")
    try:
        told = as_json(answer)
    except DetectorError:
        return {}  # alive, but knows no such question
    return told if isinstance(told, dict) else {}


def encoded(picture: Picture) -> str:
    done, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    if not done:
        raise DetectorError("a picture cannot be encoded")
    return base64.b64encode(data.tobytes()).decode()


def _box(each: Any, size: tuple[int, int]) -> Box | None:
    """None for what is no person."""
    if not isinstance(each, dict):
        raise DetectorError(f"the detector answers {type(each).__name__} where a box belongs")
    if not is_person(str(each.get("label", ""))):
        return None
    if each.get("type", "rectangle") != "rectangle" or not isinstance(each.get("points"), list):
        raise DetectorError("the detector answers something other than rectangles")
    return checked_box(each["points"], each.get("confidence"), size)


def _place(each: Any) -> Located:
    if not isinstance(each, dict):
        raise DetectorError(
            f"the detector answers {type(each).__name__} where somebody on the ground belongs"
        )
    return checked_place(each.get("x"), each.get("y"), each.get("score"))


def _camera(camera: Camera, picture: Picture) -> dict[str, Any]:
    """In pixels of the calibrated picture, whose size may differ from that of the one sent."""
    return {
        "name": camera.name,
        "width": camera.width,
        "height": camera.height,
        "sent_width": picture.shape[1],
        "sent_height": picture.shape[0],
        "model": camera.model.value,
        "matrix": camera.matrix.tolist(),
        "rvec": camera.rvec.ravel().tolist(),
        "tvec": camera.tvec.ravel().tolist(),
        "distortion": camera.distortion.ravel().tolist(),
    }
