"""Seamless random textures."""

from __future__ import annotations

import cv2
import numpy as np

from gtm_hit.demo.arrays import Floats


def cloudy(
    rng: np.random.Generator, shape: tuple[int, int], roughness: float, stretch: float = 1.0
) -> Floats:
    """A periodic texture of mean 0 and deviation 1 whose spectrum falls with frequency ** -roughness.

    `stretch` > 1 draws the pattern out along the rows' direction (down the image).
    """
    rows, columns = shape
    down = np.fft.fftfreq(rows)[:, None] * rows * stretch
    across = np.fft.rfftfreq(columns)[None, :] * columns
    frequency = np.hypot(down, across)
    frequency[0, 0] = 1
    spectrum = np.fft.rfft2(rng.standard_normal(shape)) * frequency**-roughness
    spectrum[0, 0] = 0
    texture = np.fft.irfft2(spectrum, s=shape)
    return (texture / texture.std()).astype(np.float32)


def looked_up(texture: Floats, columns: Floats, rows: Floats, border: int) -> Floats:
    """Interpolated values of a texture at many places; `border` is OpenCV's name for what is outside."""
    count = columns.size
    # OpenCV takes pictures of places, and none with a side of 32767 or more.
    shape = (-(-count // 4096), 4096)
    placed = [np.resize(np.ascontiguousarray(places).ravel(), shape) for places in (columns, rows)]
    found = cv2.remap(texture, placed[0], placed[1], cv2.INTER_LINEAR, borderMode=border, borderValue=0)
    return np.asarray(found, np.float32).ravel()[:count].reshape(columns.shape)
