"""A calibrated static camera and the validity of its numbers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry import lens

Floats = NDArray[np.float64]

DISTORTION_LENGTHS = (4, 5, 8, 12, 14)  # the lengths OpenCV's model comes in


class CalibrationError(ValueError):
    """A calibration no camera can have; says which value."""


@dataclass(frozen=True, eq=False)
class Camera:
    """Calibration in OpenCV's model: depth is `(rotation @ point + tvec)[2]`; the matrix has no skew."""

    index: int  # viewNum in files
    name: str
    width: int  # pixels
    height: int  # pixels
    matrix: Floats  # (3, 3) pixels
    rvec: Floats  # (3,) radians, world to camera
    tvec: Floats  # (3,) metres, world to camera
    distortion: Floats  # (4 | 5 | 8 | 12 | 14,) OpenCV's order; zeros for undistorted images

    def __post_init__(self) -> None:
        for name, shape in (("matrix", (3, 3)), ("rvec", (3,)), ("tvec", (3,)), ("distortion", None)):
            object.__setattr__(self, name, self._numbers(name, shape))
        if self.width < 1 or self.height < 1:
            raise CalibrationError(f"{self.name}: image size {self.width}×{self.height} is empty")
        if self.distortion.size not in DISTORTION_LENGTHS:
            raise CalibrationError(
                f"{self.name}: distortion has {self.distortion.size} numbers, not one of {DISTORTION_LENGTHS}"
            )
        self._check_matrix()

    def _numbers(self, name: str, shape: tuple[int, ...] | None) -> Floats:
        try:
            values = np.array(getattr(self, name), dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise CalibrationError(f"{self.name}: {name} is not an array of numbers") from error
        if shape is None or shape == (3,):
            values = values.reshape(-1)
        if shape is not None and values.shape != shape:
            raise CalibrationError(f"{self.name}: {name} has shape {values.shape}, not {shape}")
        if not np.isfinite(values).all():
            raise CalibrationError(
                f"{self.name}: {name} holds a number that is not finite: {values.tolist()}"
            )
        values.setflags(write=False)
        return values

    def _check_matrix(self) -> None:
        (fx, skew, _), (low, fy, _), bottom = self.matrix.tolist()
        if fx <= 0 or fy <= 0:
            raise CalibrationError(f"{self.name}: focal lengths must be positive, not {fx} and {fy}")
        if skew or low or bottom != [0.0, 0.0, 1.0]:
            raise CalibrationError(
                f"{self.name}: matrix must read [fx 0 cx; 0 fy cy; 0 0 1], not {self.matrix.tolist()}"
            )

    @cached_property
    def rotation(self) -> Floats:
        """World to camera, (3, 3)."""
        rotation: Floats = cv2.Rodrigues(self.rvec)[0].astype(np.float64)
        rotation.setflags(write=False)
        return rotation

    @cached_property
    def centre(self) -> Floats:
        """Where the camera is in the world, (3,) metres."""
        return -self.rotation.T @ self.tvec

    @cached_property
    def has_lens(self) -> bool:
        return bool(np.any(self.distortion))

    @cached_property
    def tilt(self) -> Floats | None:
        return lens.tilt_matrix(self.distortion)

    def as_json(self) -> dict[str, Any]:
        """What the browser's `Camera` is made from."""
        return {
            "index": self.index,
            "name": self.name,
            "width": self.width,
            "height": self.height,
            "matrix": self.matrix.tolist(),
            "rotation": self.rotation.tolist(),
            "tvec": self.tvec.tolist(),
            "distortion": self.distortion.tolist(),
        }
