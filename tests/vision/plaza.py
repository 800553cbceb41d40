"""Four cameras around a small plaza, with perfect boxes and plain pictures of bodies standing on it."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.bodies import body_boxes
from gtm_hit.vision.boxes import Box, Picture

GRID = Grid(240, 240, 0.025, -3.0, -3.0)
SIZE = (960, 540)


def camera(index: int, degrees: float, turned: float = 0.0) -> Camera:
    """Looking at the middle from 9 m, 3 m up; `turned` aside by degrees."""
    angle = np.radians(degrees)
    centre = np.array([9 * np.cos(angle), 9 * np.sin(angle), 3.0])
    forward = np.array([0.0, 0.0, 0.8]) - centre
    forward /= np.linalg.norm(forward)
    side = np.cross(forward, [0, 0, 1.0])
    side /= np.linalg.norm(side)
    rotation = cv2.Rodrigues(np.array([0.0, np.radians(turned), 0.0]))[0] @ np.array(
        [side, np.cross(forward, side), forward]
    )
    matrix = np.array([[800.0, 0, 480], [0, 800.0, 270], [0, 0, 1]])
    return Camera(
        index, f"C{index + 1}", *SIZE, matrix, cv2.Rodrigues(rotation)[0], -rotation @ centre, np.zeros(5)
    )


CAMERAS = {each.name: each for each in (camera(i, 90 * i + 20) for i in range(4))}


def boxes_of(people: Sequence[tuple[float, float, float]], name: str) -> list[Box]:
    """Of people x, y, height, as a perfect detector draws them in one view."""
    found = []
    for x, y, height in people:
        seen = body_boxes(CAMERAS[name], np.array([[x, y]]), 0.22, height)
        if seen.share[0] > 0.3:
            found.append(Box(*seen.boxes[0].tolist(), 0.9))
    return found


def all_boxes(people: Sequence[tuple[float, float, float]]) -> dict[str, list[Box]]:
    return {name: boxes_of(people, name) for name in CAMERAS}


def pictures(people: Sequence[tuple[float, float, float]], seed: int = 0) -> dict[str, Picture]:
    """Grey ground with noise; bodies are dark upright ellipses."""
    rng = np.random.default_rng(seed)
    made = {}
    for name, each in CAMERAS.items():
        image = np.full((SIZE[1], SIZE[0], 3), 140, np.float64)
        for x, y, height in people:
            box = body_boxes(each, np.array([[x, y]]), 0.22, height).whole[0]
            if np.isfinite(box).all():
                middle, half = (box[:2] + box[2:]) / 2, (box[2:] - box[:2]) / 2
                cv2.ellipse(
                    image,
                    (*middle.round().astype(int).tolist(),),
                    (*half.round().astype(int).tolist(),),
                    0,
                    0,
                    360,
                    (30, 40, 50),
                    -1,
                )
        made[name] = np.clip(image + rng.normal(0, 2, image.shape), 0, 255).astype(np.uint8)
    return made
