"""A calibrated static camera: world to pixels, and back to the ground."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from gtm_hit.geometry import fisheye, lens
from gtm_hit.geometry.errors import GeometryError

Floats = NDArray[np.float64]

DISTORTION_LENGTHS = (4, 5, 8, 12, 14)  # the lengths OpenCV's model comes in
OUTSIDE = -100  # pixels; where a map of cv2.remap leads out of every picture
STEEP = 0.1  # below this share of "up" in the image, a camera counts as looking straight down or up


class CalibrationError(GeometryError):
    """A calibration no camera can have; says which value."""


class CameraModel(StrEnum):
    """How a direction becomes a pixel. The browser's geometry knows the first; the others it looks up."""

    PINHOLE = "pinhole"  # with OpenCV's usual distortion, see `lens`
    FISHEYE = "fisheye"  # cv2.fisheye, see `fisheye`


@dataclass(frozen=True, eq=False)
class Camera:
    """Calibration in an OpenCV model: depth is `(rotation @ point + tvec)[2]`; the matrix has no skew."""

    index: int  # viewNum in files
    name: str
    width: int  # pixels
    height: int  # pixels
    matrix: Floats  # (3, 3) pixels
    rvec: Floats  # (3,) radians, world to camera
    tvec: Floats  # (3,) metres, world to camera
    distortion: Floats  # (4 | 5 | 8 | 12 | 14,) OpenCV's order; zeros for undistorted images
    model: CameraModel = CameraModel.PINHOLE  # fisheye: 4 numbers of distortion

    def __post_init__(self) -> None:
        for name, shape in (("matrix", (3, 3)), ("rvec", (3,)), ("tvec", (3,)), ("distortion", None)):
            object.__setattr__(self, name, self._numbers(name, shape))
        if self.width < 1 or self.height < 1:
            raise CalibrationError(f"{self.name}: image size {self.width}×{self.height} is empty")
        self._check_model()
        self._check_matrix()

    def _numbers(self, name: str, shape: tuple[int, ...] | None) -> Floats:
        try:
            values = np.array(getattr(self, name), dtype=np.float64)
        except (TypeError, ValueError, OverflowError) as error:
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

    def _check_model(self) -> None:
        if self.model not in set(CameraModel):
            known = ", ".join(CameraModel)
            raise CalibrationError(f"{self.name}: model is {self.model!r}, not one of {known}")
        object.__setattr__(self, "model", CameraModel(self.model))
        is_fisheye = self.model is CameraModel.FISHEYE
        lengths = (fisheye.COEFFICIENTS,) if is_fisheye else DISTORTION_LENGTHS
        if self.distortion.size not in lengths:
            wanted = "the 4 of the fisheye model" if is_fisheye else f"one of {lengths}"
            raise CalibrationError(
                f"{self.name}: distortion has {self.distortion.size} numbers, not {wanted}"
            )

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
        return self.model is CameraModel.FISHEYE or bool(np.any(self.distortion))

    @cached_property
    def tilt(self) -> Floats | None:
        return lens.tilt_matrix(self.distortion)

    def distort(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Where the camera's lens moves normalised points x/z, y/z to."""
        if self.model is CameraModel.FISHEYE:
            return fisheye.distort(x, y, self.distortion)
        return lens.distort(x, y, self.distortion, self.tilt)

    def undistort(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Inverse of `distort`; NaN where nothing lands."""
        if self.model is CameraModel.FISHEYE:
            return fisheye.undistort(x, y, self.distortion)
        return lens.undistort(x, y, self.distortion, self.tilt)

    @cached_property
    def facing(self) -> int:
        """Sign of the depth of what the camera sees: -1 for the poses of left-handed worlds.

        Told by the world's up pointing up in the image; where a camera looks straight down, by that.
        """
        down, away = self.rotation[1, 2], self.rotation[2, 2]
        return -1 if (down if abs(down) > STEEP else away) > 0 else 1

    def as_json(self) -> dict[str, Any]:
        """All its numbers, to the last bit; the browser's `Camera` is made from them."""
        return {
            "index": self.index,
            "name": self.name,
            "width": self.width,
            "height": self.height,
            "matrix": self.matrix.tolist(),
            "rvec": self.rvec.tolist(),
            "rotation": self.rotation.tolist(),
            "tvec": self.tvec.tolist(),
            "distortion": self.distortion.tolist(),
            "model": self.model.value,
        }


def project(camera: Camera, points: ArrayLike) -> Floats:
    """Pixels u and v, (N, 2), of world points (N, 3) in metres, as the model's projectPoints has them.

    Points behind the camera are projected too; NaN for points in the camera plane or past a fisheye's limit.
    """
    (fx, _, cx), (_, fy, cy), _ = camera.matrix.tolist()
    x, y, z = (np.asarray(points, dtype=np.float64).reshape(-1, 3) @ camera.rotation.T + camera.tvec).T
    with np.errstate(all="ignore"):
        scale = np.where(z == 0, np.nan, 1 / z)
        x, y = x * scale, y * scale
        if camera.has_lens:
            x, y = camera.distort(x, y)
    return np.column_stack((x * fx + cx, y * fy + cy))


def normalise(camera: Camera, pixels: ArrayLike) -> Floats:
    """Directions x/z and y/z, (N, 2), of pixels (N, 2) with the lens taken out.

    NaN for pixels nothing lands on: outside the picture a strong lens folds back.
    """
    (fx, _, cx), (_, fy, cy), _ = camera.matrix.tolist()
    u, v = np.asarray(pixels, dtype=np.float64).reshape(-1, 2).T
    x, y = (u - cx) / fx, (v - cy) / fy
    if camera.has_lens:
        x, y = camera.undistort(x, y)
    return np.column_stack((x, y))


def back_project(camera: Camera, pixels: ArrayLike, z: float = 0.0) -> Floats:
    """Ground X and Y, (N, 2) metres, at height `z` of what pixels (N, 2) show: the inverse of `project`.

    NaN above the horizon, where the ray meets that height behind the camera, and outside the lens's limit.
    """
    directions = normalise(camera, pixels)
    rays = np.column_stack((directions, np.ones(len(directions)))) @ camera.rotation
    with np.errstate(all="ignore"):
        depth = (z - camera.centre[2]) / rays[:, 2]
        ground = camera.centre[:2] + depth[:, None] * rays[:, :2]
    seen = np.isfinite(depth) & (depth * camera.facing > 0)
    return np.where(seen[:, None], ground, np.nan)


def undistorted(camera: Camera, target_matrix: ArrayLike | None = None) -> Camera:
    """The camera of the images that `undistort_maps` makes; the same matrix unless another is given."""
    matrix = camera.matrix if target_matrix is None else np.asarray(target_matrix, dtype=np.float64)
    return replace(camera, matrix=matrix, distortion=np.zeros(5), model=CameraModel.PINHOLE)


def undistort_maps(camera: Camera, target_matrix: ArrayLike | None = None) -> tuple[NDArray, NDArray]:
    """The two maps with which cv2.remap takes the lens out of the camera's images.

    Pixels beyond the lens's fold become black: OpenCV would repeat there what is seen elsewhere.
    """
    target = undistorted(camera, target_matrix).matrix
    size = (camera.width, camera.height)
    if camera.model is CameraModel.FISHEYE:
        turn = np.eye(3)
        return cv2.fisheye.initUndistortRectifyMap(
            camera.matrix, camera.distortion, turn, target, size, cv2.CV_16SC2
        )
    coarse, fine = cv2.initUndistortRectifyMap(
        camera.matrix, camera.distortion, None, target, size, cv2.CV_16SC2
    )
    coarse[beyond_fold(camera, target)] = OUTSIDE
    return coarse, fine


def beyond_fold(camera: Camera, target_matrix: ArrayLike | None = None) -> NDArray[np.bool_]:
    """(H, W): pixels of the undistorted picture that look where the lens has no answer."""
    (fx, _, cx), (_, fy, cy), _ = undistorted(camera, target_matrix).matrix.tolist()
    x, y = (np.arange(camera.width) - cx) / fx, (np.arange(camera.height) - cy) / fy
    return np.hypot(x, y[:, None]) >= fold(camera)


def fold(camera: Camera) -> float:
    """Tangent of the angle off the optical axis from which on the lens has no answer; may be infinite."""
    if camera.model is CameraModel.FISHEYE:
        return float(np.tan(fisheye.limit(camera.distortion)))
    return lens.limit(camera.distortion)
