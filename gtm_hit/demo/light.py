"""Sunlight, skylight, and how a camera turns light into pixel values."""

from __future__ import annotations

import numpy as np

from gtm_hit.demo.arrays import Floats
from gtm_hit.demo.scene import Mood

SUN = np.array([3.55, 3.22, 2.66], dtype=np.float32)
SKY = np.array([0.44, 0.54, 0.70], dtype=np.float32)
BOUNCE = np.array([0.46, 0.41, 0.34], dtype=np.float32)  # light that the sunlit ground sends back up
HAZE = np.array([0.98, 1.02, 1.06], dtype=np.float32)
HAZE_DISTANCE = 1300.0  # metres after which 63 % of what one sees is haze

EXPOSURE = 0.70
SHOULDER = 0.42  # how softly highlights run into white


def linear(colour: str) -> Floats:
    """Linear light (3,) of an sRGB colour written `rrggbb`."""
    channels = np.array([int(colour[index : index + 2], 16) for index in (0, 2, 4)], dtype=np.float32)
    return (channels / 255) ** np.float32(2.2)


def skylight(normals: Floats) -> Floats:
    """Light (N, 3) from everywhere but the sun on surfaces with unit normals (N, 3)."""
    up = (0.5 + 0.5 * normals[..., 2:]).astype(np.float32)
    return SKY * up + BOUNCE * (1 - up)


def sunlight(normals: Floats, sun: tuple[float, float, float]) -> Floats:
    """Light (N, 3) from the sun on surfaces with unit normals (N, 3) that nothing shades."""
    facing = np.maximum(normals @ np.array(sun, dtype=np.float32), 0)
    return facing[..., None] * SUN


def develop(light: Floats, mood: Mood) -> Floats:
    """Pixel values 0…255 of linear light (…, 3), before noise and rounding."""
    gain = np.array(mood.balance, dtype=np.float32) * np.float32(mood.exposure * EXPOSURE)
    exposed = light * gain
    exposed *= (1 + exposed * np.float32(SHOULDER * 0.35)) / (1 + exposed * np.float32(SHOULDER))
    np.clip(exposed, 0, 1, out=exposed)
    shown = np.power(exposed, np.float32(1 / 2.2), out=exposed)
    # A little contrast around the middle, as cameras add it.
    shown += np.float32(0.16) * shown * (1 - shown) * (2 * shown - 1)
    return shown * np.float32(255)
