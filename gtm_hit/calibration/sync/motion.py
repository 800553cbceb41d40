"""What moves in a video: on the whole picture, or on cells of the ground that several cameras see."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.sync.series import Flags, Floats, Series, steady

Grey = NDArray[np.uint8]

WIDTH = 400  # pixels; people are looked for, not faces
APART = 0.2  # seconds between two pictures that are compared, whatever the video's rate
SMALLEST_GAP = 1 / 32  # seconds; of faster videos some pictures are left out
STEP = 0.04  # seconds
FEET = 0.15  # of somebody's height
LEAST_CHANGE = 6.0  # grey values
NOISE = 4.0  # deviations of the camera's noise that are no motion yet


class Meter(Protocol):
    """Where motion is measured."""

    @property
    def known(self) -> Flags: ...

    def measure(self, moving: Grey) -> Floats:
        """Share of moving pixels, by channel, in a mask (H, W) of 0 and 1."""
        ...


@dataclass(frozen=True, eq=False)
class WholePicture:
    @property
    def known(self) -> Flags:
        return np.ones(1, bool)

    def measure(self, moving: Grey) -> Floats:
        return np.array([moving.mean()], np.float32)


@dataclass(frozen=True, eq=False)
class Boxes:
    """Channels are boxes of somebody standing somewhere, in the small picture; empty ones are not seen.

    A low camera sees people in front of ground that is far behind them. Who stands there, and nowhere else
    on this line, fills the box, leaves its surroundings still, and ends where the box ends.
    """

    boxes: NDArray[np.int64]  # (channels, 4) x0 y0 x1 y1, the last ones excluded
    size: tuple[int, int]  # width and height of the small picture

    @cached_property
    def known(self) -> Flags:
        return (self._inside[1] > 0) & (self._below[1] > 0)

    @cached_property
    def _inside(self) -> _Parts:
        return _parts(self.boxes)

    @cached_property
    def _around(self) -> _Parts:
        """The boxes, and half a width more on every side."""
        reach = np.maximum((self.boxes[:, 2] - self.boxes[:, 0] + 1) // 2, 1)[:, None]
        return _parts(np.clip(self.boxes + reach * [-1, -1, 1, 1], 0, [*self.size, *self.size]))

    @cached_property
    def _foot(self) -> NDArray[np.int64]:
        """Height of what feet take, pixels."""
        return np.maximum(np.round((self.boxes[:, 3] - self.boxes[:, 1]) * FEET), 1).astype(np.int64)

    @cached_property
    def _feet(self) -> _Parts:
        x0, _, x1, y1 = self.boxes.T
        return _parts(np.stack((x0, y1 - self._foot, x1, y1), axis=1))

    @cached_property
    def _below(self) -> _Parts:
        x0, _, x1, y1 = self.boxes.T
        return _parts(np.stack((x0, y1, x1, np.minimum(y1 + self._foot, self.size[1])), axis=1))

    def measure(self, moving: Grey) -> Floats:
        sums = cv2.integral(moving)
        inside, wide = _sum(sums, self._inside), _sum(sums, self._around)
        area, wide_area = self._inside[1], self._around[1]
        body = inside / np.maximum(area, 1) - (wide - inside) / np.maximum(wide_area - area, 1)
        feet, below = (_sum(sums, part) / np.maximum(part[1], 1) for part in (self._feet, self._below))
        found = np.maximum(body, 0) * np.maximum(feet - below, 0)
        return np.where(self.known, found, 0).astype(np.float32)


_Parts = tuple[NDArray[np.int64], NDArray[np.int64]]  # boxes and their areas


def _parts(boxes: NDArray[np.int64]) -> _Parts:
    x0, y0, x1, y1 = boxes.T
    return boxes, np.asarray(np.maximum(x1 - x0, 0) * np.maximum(y1 - y0, 0))


def _sum(sums: NDArray[Any], parts: _Parts) -> NDArray[np.int64]:
    x0, y0, x1, y1 = parts[0].T
    return np.asarray(sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0])


def small(picture: NDArray[Any]) -> Grey:
    """A picture, grey or BGR, as motion is looked for in it."""
    grey = picture if picture.ndim == 2 else cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    size = small_size(grey.shape[1], grey.shape[0])
    return np.asarray(cv2.resize(grey, size, interpolation=cv2.INTER_AREA), np.uint8)


def small_size(width: int, height: int) -> tuple[int, int]:
    """Never larger than it is."""
    return (width, height) if width <= WIDTH else (WIDTH, max(round(height * WIDTH / width), 1))


class MotionReader:
    """Fed with small pictures in their order."""

    def __init__(self, meter: Meter) -> None:
        self.meter = meter
        self.recent: deque[tuple[float, Grey]] = deque()
        self.times: list[float] = []
        self.values: list[Floats] = []

    def wants(self, time: float) -> bool:
        return not self.recent or time - self.recent[-1][0] >= SMALLEST_GAP

    def add(self, time: float, picture: Grey) -> None:
        while len(self.recent) > 1 and time - self.recent[1][0] >= APART - SMALLEST_GAP / 2:
            self.recent.popleft()
        if self.recent and abs(time - self.recent[0][0] - APART) <= APART / 2:
            before, earlier = self.recent[0]
            # Half way between the two is when this motion was, at any rate and over any gap.
            self.times.append((time + before) / 2)
            self.values.append(self.meter.measure(_moving(earlier, picture)))
        self.recent.append((time, picture))

    def series(self, step: float = STEP) -> Series:
        return steady(self.times, self.values or np.zeros((0, 1)), step, self.meter.known)


def read_motion(pictures: Iterable[tuple[float, NDArray[Any]]], meter: Meter) -> Series:
    reader = MotionReader(meter)
    for time, picture in pictures:
        if reader.wants(time):
            reader.add(time, small(picture))
    return reader.series()


def _moving(first: Grey, second: Grey) -> Grey:
    change = cv2.absdiff(first, second)
    level = max(LEAST_CHANGE, NOISE * 1.48 * float(np.median(change)))
    return (np.asarray(change) > level).astype(np.uint8)
