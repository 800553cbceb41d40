"""What a picture's lens is, apart from where its camera stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Lens:
    """One camera's intrinsics in OpenCV's model, for pictures of one size."""

    width: int  # pixels
    height: int  # pixels
    matrix: Floats  # (3, 3) pixels, no skew
    distortion: Floats  # (5 | 8,) OpenCV's order k1 k2 p1 p2 k3 …

    def camera(self, name: str, rvec: Floats, tvec: Floats, index: int = 0) -> Camera:
        """A camera with this lens at a pose, world to camera, metres."""
        return Camera(index, name, self.width, self.height, self.matrix, rvec, tvec, self.distortion)


def lens_of(camera: Camera) -> Lens:
    """The lens of a camera that is there already."""
    return Lens(camera.width, camera.height, camera.matrix, camera.distortion)
