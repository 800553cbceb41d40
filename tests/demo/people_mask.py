"""Who is where in a picture of the demo scene, by the order its people are painted in."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gtm_hit.demo.people import Cast, Moment
from gtm_hit.demo.view import far_to_near
from gtm_hit.geometry.camera import Camera


def people_mask(camera: Camera, cast: Cast, now: Moment, frame: int) -> NDArray[np.int16]:
    """Who is seen in each pixel (H, W); -1 where nobody is."""
    mask = np.full((camera.height, camera.width), -1, dtype=np.int16)
    for person, sprite in far_to_near(camera, cast, now, frame).items():
        height, width = sprite.cover.shape
        part = mask[sprite.top : sprite.top + height, sprite.left : sprite.left + width]
        part[sprite.cover > 0.5] = person
    return mask
