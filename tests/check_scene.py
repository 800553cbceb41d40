"""A desk of the demo plaza's seven cameras, lenses and all, standing where they truly stand."""

from __future__ import annotations

import numpy as np

from gtm_hit.calibration.checking import shown
from gtm_hit.calibration.kept_points import SeenAt
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Desk
from gtm_hit.ops.desk import desks
from tests.geometry.scenes import wildtrack_cameras
from tests.work_scene import digest

Place = tuple[float, float, float]

LAMP: Place = (3.0, 3.0, 1.2)  # metres; C1, C3, C4 and others see it
BENCH: Place = (2.0, 6.0, 0.8)


def truth() -> dict[str, Camera]:
    return {camera.name: camera for camera in wildtrack_cameras(original=True)}


def calibrated_desk(slug: str = "plaza") -> Desk:
    cameras = truth()
    desk = desks.make(slug, "The plaza", cameras=list(cameras))
    for row in desk.cameras.all():
        camera = cameras[row.name]
        row.width, row.height = camera.width, camera.height
        row.lens = {
            "matrix": camera.matrix.tolist(),
            "distortion": camera.distortion.tolist(),
            "source": "the demo",
        }
        row.pose = {"rvec": camera.rvec.tolist(), "tvec": camera.tvec.tolist()}
        row.pose_report = {
            "problem": "",
            "rms": 0.5,
            "centre_sigma": [0, 0, 0],
            "residuals": [],
            "findings": [],
        }
        row.light_digest = row.full_digest = digest(row.name.encode())
        row.save()
    return desk


def true_clicks(place: Place, *cameras: str) -> list[SeenAt]:
    """Where those cameras see it; without names, all whose pictures show it."""
    pixels = {name: shown(camera, np.array(place)).tolist() for name, camera in truth().items()}
    seen = [
        SeenAt(name, x, y)
        for name, (x, y) in pixels.items()
        if 0 <= x < truth()[name].width and 0 <= y < truth()[name].height
    ]
    return [each for each in seen if not cameras or each.camera in cameras]


def beside(seen: SeenAt, pixels: float) -> SeenAt:
    """A click that is off, to the right."""
    return SeenAt(seen.camera, seen.x + pixels, seen.y)
