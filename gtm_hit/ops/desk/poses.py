"""Where each camera stands by what is known now: solved again after every edit it depends on."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from gtm_hit.calibration.ghosts import expected_pixels
from gtm_hit.calibration.ground_points import GroundPoint
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.pose import Pair, PoseError, PoseSolution, solve_pose
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Desk, DeskCamera
from gtm_hit.ops.desk.things import CLICK, LENS, POINT

NO_LENS = "The camera has no lens yet."
NO_POINTS = "There are no measured points yet."


def follow(desk: Desk, changes: Iterable[list[Any]]) -> None:
    """Solve the poses that depend on what has changed."""
    names: set[str] = set()
    for kind, key, _before, _after in changes:
        if kind in {CLICK, LENS}:
            names.add(key[0])
        elif kind == POINT:
            names.update(desk.cameras.values_list("name", flat=True))
    for camera in desk.cameras.filter(name__in=names):
        solve(camera)


def solve(camera: DeskCamera) -> None:
    """Write down the pose, or why there is none."""
    camera.pose, camera.pose_report = _solved(camera)
    camera.save(update_fields=["pose", "pose_report"])


def lens_of(camera: DeskCamera) -> Lens | None:
    if camera.lens is None:
        return None
    matrix, distortion = (np.array(camera.lens[name], dtype=np.float64) for name in ("matrix", "distortion"))
    return Lens(camera.width, camera.height, matrix, distortion)


def calibrated(camera: DeskCamera) -> Camera | None:
    """The camera as it would be put in place; None as long as something is missing."""
    found = adjusted_of(camera)
    return _camera(camera, found["lens"], found["pose"]) if found else from_ground(camera)


def from_ground(camera: DeskCamera) -> Camera | None:
    """The camera by its own lens and its own clicks alone: what an adjustment begins with."""
    if camera.lens is None or camera.pose is None:
        return None
    return _camera(camera, camera.lens, camera.pose)


def adjusted_of(camera: DeskCamera) -> dict[str, Any] | None:
    """What an adjustment found, as long as the camera's lens and pose are those it began from.

    So a click or a lens that comes later counts, and taking it back brings the adjusted camera back.
    """
    adjusted: dict[str, Any] | None = camera.adjusted
    return adjusted if adjusted and adjusted["from"] == beginning(camera) else None


def beginning(camera: DeskCamera) -> dict[str, Any]:
    """What tells whether an adjustment began from the camera as it is."""
    lens = camera.lens or {}
    return {
        "size": [camera.width, camera.height],
        "matrix": lens.get("matrix"),
        "distortion": lens.get("distortion"),
        "pose": camera.pose,
    }


def _camera(row: DeskCamera, lens: dict[str, Any], pose: dict[str, Any]) -> Camera:
    matrix, distortion = (np.array(lens[name], dtype=np.float64) for name in ("matrix", "distortion"))
    rvec, tvec = (np.array(pose[name], dtype=np.float64) for name in ("rvec", "tvec"))
    return Lens(row.width, row.height, matrix, distortion).camera(row.name, rvec, tvec, row.index)


def _solved(camera: DeskCamera) -> tuple[dict[str, Any] | None, dict[str, Any]]:
    lens = lens_of(camera)
    if lens is None:
        return None, {"problem": NO_LENS}
    clicks = list(camera.clicks.select_related("point").order_by("point__number"))
    pairs = [
        Pair(each.point.name, (each.point.x, each.point.y, each.point.z), (each.x, each.y)) for each in clicks
    ]
    try:
        found = solve_pose(lens, pairs)
    except PoseError as error:
        return None, {"problem": _sentence(str(error))}
    points = [GroundPoint(each.name, each.x, each.y, each.z) for each in camera.desk.points.all()]
    pose = {"rvec": found.rvec.tolist(), "tvec": found.tvec.tolist()}
    return pose, {**_report(found), "ghosts": _ghosts(found, points)}


def _report(found: PoseSolution) -> dict[str, Any]:
    return {
        "problem": "",
        "rms": number(found.rms),
        "centre": found.centre.tolist(),
        "centre_sigma": [number(each) for each in found.centre_sigma.tolist()],
        "residuals": [
            {
                "name": each.name,
                "dx": number(each.dx),
                "dy": number(each.dy),
                "px": number(each.px),
                "cm": number(each.cm),
                "used": each.used,
            }
            for each in found.residuals
        ],
        "findings": [
            {"trouble": each.trouble.value, "text": each.text, "names": list(each.names)}
            for each in found.findings
        ],
    }


def _ghosts(found: PoseSolution, points: list[GroundPoint]) -> list[dict[str, Any]]:
    """Those that can be seen."""
    return [
        {"name": each.name, "x": round(each.x, 3), "y": round(each.y, 3), "sigma": round(each.sigma, 3)}
        for each in expected_pixels(found, points)
        if each.visible
    ]


def number(value: float) -> float | None:
    """As JSON can hold it."""
    return float(value) if math.isfinite(value) else None


def _sentence(text: str) -> str:
    """What `calibration` says in the middle of a line, as a line of its own."""
    return text[:1].upper() + text[1:].rstrip(".") + "."
