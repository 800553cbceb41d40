"""The rule that turns a cylinder into a rectangle, over a block of ground at once.

Two published data sets, two foot rules (see `FootRule`); each is reproduced to the pixel, so the precision,
the order of operations and the place of every truncation are part of the rule. static/geometry/rectangle.js
repeats them; change both or neither.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera

Array = NDArray[Any]  # float32 or float64, one shape throughout a block
Sides = tuple[Array, Array]  # the low and the high side of a box

INT16 = np.iinfo(np.int16)


def corners_rule(camera: Camera, radius: float, height: float, x: Array, y: Array, boxes: Array) -> None:
    """Rectangles as WILDTRACK's: float32, truncated corner by corner, foot = mean of the four lowest corners.

    `x` and `y` are float32 metres that broadcast against each other to the block's shape; `boxes` (..., 4)
    int16 receives xmin ymin xmax ymax, zeros where not visible.
    """
    reach, tall = np.float32(radius), float(np.float32(height))
    sides_x, sides_y = (x - reach, x + reach), (y - reach, y + reach)
    with np.errstate(all="ignore"):  # corners in the camera plane come out as NaN and fail every test
        visible = _in_front(camera, sides_x, sides_y, tall, x, y)
        if not visible.any():  # whole blocks of ground lie behind a camera
            boxes[...] = 0
            return
        u, v = _project_corners(camera, sides_x, sides_y, tall, np.float32)
        # Truncation keeps order, so extremes can be truncated instead of all eight corners.
        xmin, xmax, ymin = np.trunc(u.min(axis=0)), np.trunc(u.max(axis=0)), np.trunc(v.min(axis=0))
        ymax = np.floor(_sum_of_four_lowest(v) * np.float32(0.25))
        visible &= _acceptable(camera, xmin, ymin, xmax, ymax)
        visible &= xmax - xmin <= camera.width // 3
        _store(boxes, (xmin, ymin, xmax, ymax), visible)


def centre_rule(camera: Camera, radius: float, height: float, x: Array, y: Array, boxes: Array) -> None:
    """Rectangles as MultiviewX's: float64, truncated last, foot = the projected ground centre.

    Arguments as in `corners_rule`, with float64 metres.
    """
    sides_x, sides_y = (x - radius, x + radius), (y - radius, y + radius)
    with np.errstate(all="ignore"):
        visible = _in_front(camera, sides_x, sides_y, height, x, y)
        if not visible.any():
            boxes[...] = 0
            return
        u, v = _project_corners(camera, sides_x, sides_y, height, np.float64)
        xmin, xmax, ymin = u.min(axis=0), u.max(axis=0), v.min(axis=0)
        ymax = _project_axis(camera, x, y, 0.0)
        visible &= _acceptable(camera, xmin, ymin, xmax, ymax)
        visible &= (xmax - xmin <= camera.width / 3) & (ymax - ymin <= camera.height / 3)
        _store(boxes, [np.trunc(side) for side in (xmin, ymin, xmax, ymax)], visible)


def _project_corners(
    camera: Camera, sides_x: Sides, sides_y: Sides, height: float, precision: type
) -> tuple[Array, Array]:
    """u and v, (8, ...): the four feet corners, then the four heads."""
    shape = np.broadcast_shapes(sides_x[0].shape, sides_y[0].shape)
    u, v = _scratch.take("u", precision, (8, *shape)), _scratch.take("v", precision, (8, *shape))
    terms = _Terms(camera)
    columns, rows = [terms.along_x(x) for x in sides_x], [terms.along_y(y) for y in sides_y]
    rise = terms.along_z(height)
    here, spare = _scratch.take("here", np.float64, (3, *shape)), _scratch.take("spare", np.float64, shape)
    for corner in range(4):
        for axis in range(3):
            np.add(columns[corner % 2][axis], rows[corner // 2][axis], out=here[axis])
        terms.to_pixels(here, spare, u[corner], v[corner])
        for axis in range(3):
            here[axis] += rise[axis]
        terms.to_pixels(here, spare, u[corner + 4], v[corner + 4])
    return u, v


class _Scratch(threading.local):
    """The large arrays of a block, kept for the thread's next one.

    Asking the system for fresh pages block by block takes longer than the rule itself.
    """

    def __init__(self) -> None:
        self.arrays: dict[tuple[str, type], Array] = {}

    def take(self, name: str, precision: type, shape: tuple[int, ...]) -> Array:
        size = math.prod(shape)
        array = self.arrays.get((name, precision))
        if array is None or array.size < size:
            array = self.arrays[name, precision] = np.empty(size, precision)
        return array[:size].reshape(shape)


_scratch = _Scratch()


class _Terms:
    """A camera's projection as sums of one term per world axis.

    On a grid the terms are needed once per column and once per row only. Without a lens the focal
    lengths are multiplied into them.
    """

    def __init__(self, camera: Camera) -> None:
        self.camera = camera
        self.lens = camera.has_lens
        focal = (1.0, 1.0) if self.lens else (camera.matrix[0, 0], camera.matrix[1, 1])
        scale = np.array([[focal[0]], [focal[1]], [1.0]])
        self.rotation = scale * camera.rotation
        self.offset = scale[:, 0] * camera.tvec

    def along_x(self, x: Array) -> list[Array]:
        metres = x.astype(np.float64)
        return [self.rotation[axis, 0] * metres for axis in range(3)]

    def along_y(self, y: Array) -> list[Array]:
        metres = y.astype(np.float64)
        return [self.rotation[axis, 1] * metres + self.offset[axis] for axis in range(3)]

    def along_z(self, z: float) -> list[float]:
        return [float(self.rotation[axis, 2] * z) for axis in range(3)]

    def to_pixels(self, here: Array, spare: Array, u: Array, v: Array) -> None:
        """Divide `here` (3, ...) by its depth into pixels `u` and `v`; `spare` is scratch space."""
        (fx, _, cx), (_, fy, cy), _ = self.camera.matrix.tolist()
        inverse = np.divide(1.0, here[2], out=spare)
        x, y = here[0] * inverse, here[1] * inverse
        if self.lens:
            x, y = self.camera.distort(x, y)
            x *= fx
            y *= fy
        np.add(x, cx, out=u, casting="same_kind")
        np.add(y, cy, out=v, casting="same_kind")


def _project_axis(camera: Camera, x: Array, y: Array, z: float) -> Array:
    """v of the cylinder's axis at height `z`."""
    terms = _Terms(camera)
    columns, rows, rise = terms.along_x(x), terms.along_y(y), terms.along_z(z)
    shape = np.broadcast_shapes(x.shape, y.shape)
    here, spare = _scratch.take("here", np.float64, (3, *shape)), _scratch.take("spare", np.float64, shape)
    u, v = np.empty(shape), np.empty(shape)
    for axis in range(3):
        np.add(columns[axis], rows[axis], out=here[axis])
        here[axis] += rise[axis]
    terms.to_pixels(here, spare, u, v)
    return v


def _in_front(camera: Camera, sides_x: Sides, sides_y: Sides, height: float, x: Array, y: Array) -> Array:
    """All eight corners on one side of the camera plane, and the head above the feet.

    Not "depth > 0": poses of left-handed worlds give everything one sees a negative depth.
    """
    terms = _Terms(camera)
    along_x = [terms.along_x(side)[2] for side in sides_x]
    along_y = [terms.along_y(side)[2] for side in sides_y]
    rise = terms.along_z(height)[2]
    # Depth is a sum of one term per axis, so the sums of the extremes are the extremes of the sums.
    nearest = np.minimum(*along_x) + np.minimum(*along_y)
    farthest = np.maximum(*along_x) + np.maximum(*along_y)
    one_side = (nearest + min(rise, 0.0) > 0) | (farthest + max(rise, 0.0) < 0)
    upright = _project_axis(camera, x, y, height) < _project_axis(camera, x, y, 0.0)
    return one_side & upright


def _acceptable(camera: Camera, xmin: Array, ymin: Array, xmax: Array, ymax: Array) -> Array:
    """The tests both foot rules share."""
    visible = (xmin < camera.width - 2) & (ymin < camera.height - 2) & (xmax > 1) & (ymax > 1)
    visible &= xmax - xmin <= ymax - ymin
    # Files and tables hold int16; a rectangle that does not fit must never wrap around into the picture.
    visible &= (xmin > INT16.min - 1) & (ymin > INT16.min - 1)
    return visible & (xmax < INT16.max + 1) & (ymax < INT16.max + 1)


def _sum_of_four_lowest(v: Array) -> Array:
    """Sum of the four largest of eight truncated y, (8, ...) to (...); reorders `v`.

    Two groups of four sorted by a network, then the upper half of one step of a bitonic merge.
    """
    feet, heads = _sorted_four(list(v[:4])), _sorted_four(list(v[4:]))
    lowest = [np.trunc(np.maximum(foot, head)) for foot, head in zip(feet, reversed(heads), strict=True)]
    return lowest[0] + lowest[1] + lowest[2] + lowest[3]


def _sorted_four(values: list[Array]) -> list[Array]:
    for low, high in ((0, 1), (2, 3), (0, 2), (1, 3), (1, 2)):
        smaller = np.minimum(values[low], values[high])
        np.maximum(values[low], values[high], out=values[high])
        values[low] = smaller
    return values


def _store(boxes: Array, sides: Sequence[Array], visible: Array) -> None:
    for number, side in enumerate(sides):
        boxes[..., number] = np.where(visible, side, 0)
