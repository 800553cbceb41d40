"""Pictures of a still street with passers-by, by a camera that may have moved."""

from __future__ import annotations

import cv2
import numpy as np

from gtm_hit.calibration.drift.marks import Grey

WIDTH, HEIGHT = 640, 480


def street(
    dx: float = 0.0,
    dy: float = 0.0,
    degrees: float = 0.0,
    people: int = 0,
    seed: int = 0,
    noise: float = 2.0,
    size: tuple[int, int] = (WIDTH, HEIGHT),
) -> Grey:
    """`seed` places the people and the noise; the street is always the same."""
    width, height = size
    stones = (
        np.random.default_rng(99).integers(40, 216, (height // 8 + 20, width // 8 + 20)).astype(np.float32)
    )
    wide = cv2.resize(stones, None, fx=8, fy=8, interpolation=cv2.INTER_CUBIC)
    turned = cv2.getRotationMatrix2D((width / 2 + 80, height / 2 + 80), -degrees, 1.0)
    turned[:, 2] += (dx - 80, dy - 80)
    seen = cv2.warpAffine(wide, turned, (width, height), flags=cv2.INTER_CUBIC)
    rng = np.random.default_rng(seed)
    for _ in range(people):
        middle = (int(rng.integers(0, width)), int(rng.integers(0, height)))
        cv2.ellipse(seen, middle, (18, 55), 0, 0, 360, float(rng.integers(0, 255)), -1)
    return np.clip(seen + rng.normal(0, noise, seen.shape), 0, 255).astype(np.uint8)
