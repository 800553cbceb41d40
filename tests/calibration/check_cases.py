"""Makes fixtures/check_cases.json, which the tests of Python and of the browser both read.

    python -m tests.calibration.check_cases

What is expected comes from scipy's least squares and OpenCV's projection, not from the code under test.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
from scipy.optimize import least_squares

from gtm_hit.geometry.camera import Camera
from tests.geometry.scenes import FIXTURES, mirrored, wildtrack_cameras

PATH = FIXTURES / "check_cases.json"
SIGMA = 2.0
ALONG = (0.02, 0.2, 0.4, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.99)


def pixel(camera: Camera, point: np.ndarray) -> np.ndarray:
    """OpenCV's, NaN outside the picture with its surroundings, and behind the camera."""
    depth = camera.rotation[2] @ point + camera.tvec[2]
    if depth * camera.facing <= 0.05:
        return np.full(2, np.nan)
    plane = (camera.rotation[:2] @ point + camera.tvec[:2]) / depth
    found = cv2.projectPoints(point, camera.rvec, camera.tvec, camera.matrix, camera.distortion)[0].ravel()
    inside = (found > 0).all() and found[0] < camera.width and found[1] < camera.height
    return found if inside and np.hypot(*plane) < 0.62 else np.full(2, np.nan)


def best(cameras: list[Camera], clicks: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The point of least squares and the slopes of the misses there."""

    def misses(point: np.ndarray) -> np.ndarray:
        shown = [
            cv2.projectPoints(point, each.rvec, each.tvec, each.matrix, each.distortion)[0].ravel()
            for each in cameras
        ]
        return (np.array(shown) - clicks).ravel()

    found = least_squares(misses, start, xtol=1e-15, ftol=1e-15, gtol=1e-15, jac="3-point", x_scale="jac")
    return found.x, found.jac


def meetings(cameras: list[Camera], rng: np.random.Generator, first: int) -> Iterator[dict[str, Any]]:
    """Points that several views show, clicked with some noise; some with one click that is far off."""
    sign = -1 if cameras[0].facing < 0 else 1
    made = 0
    while made < 8:
        point = np.array([rng.uniform(-2, 8), sign * rng.uniform(-7, 18), rng.uniform(0, 2)])
        shown = [(place, pixel(camera, point)) for place, camera in enumerate(cameras)]
        seen = [(place, where) for place, where in shown if not np.isnan(where).any()]
        if len(seen) < 2 + made % 3:
            continue
        seen = seen[: 2 + made % 3]
        clicks = np.array([where for _, where in seen]) + rng.normal(0, 1, (len(seen), 2))
        spoiled = made % 3 == 2 and made > 2
        if spoiled:
            clicks[made % len(seen)] += (90, -70)
        clicks = clicks.round(3)
        places = [place for place, _ in seen]
        found, slopes = best([cameras[place] for place in places], clicks, point)
        misses = (
            np.array(
                [
                    cv2.projectPoints(found, each.rvec, each.tvec, each.matrix, each.distortion)[0].ravel()
                    for each in (cameras[place] for place in places)
                ]
            )
            - clicks
        )
        variance = max(SIGMA**2, (misses**2).sum() / max(2 * len(seen) - 3, 1))
        yield {
            "cameras": [first + place for place in places],
            "clicks": clicks.tolist(),
            "point": found.tolist(),
            "sigmas": np.sqrt(np.diag(variance * np.linalg.inv(slopes.T @ slopes))).tolist(),
            "residuals": np.hypot(*misses.T).tolist(),
            "spoiled": made % len(seen) if spoiled else None,
        }
        made += 1


def lines(cameras: list[Camera], rng: np.random.Generator, first: int) -> Iterator[dict[str, Any]]:
    """A click on something on the ground, and pixels of what lies on its ray in another view."""
    sign = -1 if cameras[0].facing < 0 else 1
    for place, camera in enumerate(cameras):
        while True:
            ground = np.array([rng.uniform(-2, 8), sign * rng.uniform(-7, 18), 0.0])
            if not np.isnan(pixel(camera, ground)).any():
                break
        for other in range(len(cameras)):
            points = [camera.centre + share * (ground - camera.centre) for share in ALONG]
            shown = [pixel(cameras[other], point) for point in points]
            seen = [where.tolist() for where in shown if not np.isnan(where).any()]
            if other == place or (place + other) % 3 or not seen:
                continue
            yield {
                "camera": first + place,
                "click": pixel(camera, ground).tolist(),
                "other": first + other,
                "through": seen,
            }


def main() -> None:
    rng = np.random.default_rng(20170509)
    originals, turned = wildtrack_cameras(original=True), [mirrored(each) for each in wildtrack_cameras()[:4]]
    content = {
        "sigma": SIGMA,
        "cameras": [camera.as_json() for camera in (*originals, *turned)],
        "meetings": [*meetings(originals, rng, 0), *meetings(turned, rng, len(originals))],
        "lines": [*lines(originals, rng, 0), *lines(turned, rng, len(originals))],
    }
    parts = []
    for name, value in content.items():
        text = json.dumps(value)
        if isinstance(value, list):
            text = "[\n" + ",\n".join(json.dumps(each) for each in value) + "\n]"
        parts.append(f'"{name}": {text}')
    PATH.write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
