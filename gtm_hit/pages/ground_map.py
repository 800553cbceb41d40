"""The ground from above as an SVG: where metres lie on the page."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gtm_hit.models import Camera, Dataset
from gtm_hit.ops.coverage import Coverage, shade

MARGIN = 0.09  # of the grid's longer side, for axis figures and cameras beside the ground
FARTHEST = 0.45  # of the grid's longer side; a camera farther away is drawn at this distance


@dataclass(frozen=True)
class Marker:
    name: str
    x: float
    y: float
    turn: float  # degrees, clockwise from "to the right"
    label_x: float
    label_y: float


@dataclass(frozen=True)
class Tick:
    x: float
    y: float
    text: str


@dataclass(frozen=True)
class Step:
    cameras: int
    colour: str
    positions: int
    percent: float


class GroundMap:
    """Units of the drawing are metres. The longer side of the grid runs to the right.

    A grid longer along Y is turned, not mirrored: Y then runs to the right and X downwards. Otherwise X runs
    to the right and Y upwards.
    """

    def __init__(self, dataset: Dataset, coverage: Coverage) -> None:
        self.dataset = dataset
        self.coverage = coverage
        self.grid = dataset.grid
        self.turned = self.grid.rows > self.grid.columns
        along_x, along_y = self.grid.columns * self.grid.step, self.grid.rows * self.grid.step
        self.width, self.height = (along_y, along_x) if self.turned else (along_x, along_y)
        self.unit = self.width / 100  # line widths and letters follow the size of the scene

    @cached_property
    def cameras(self) -> list[Marker]:
        return [
            self._marker(camera, middle)
            for camera, middle in zip(self.dataset.cameras.all(), self.coverage.middles, strict=True)
        ]

    @cached_property
    def view_box(self) -> str:
        margin = MARGIN * self.width
        left = min([0.0, *(marker.x for marker in self.cameras)]) - margin
        top = min([0.0, *(marker.y for marker in self.cameras)]) - margin
        right = max([self.width, *(marker.x for marker in self.cameras)]) + margin
        bottom = max([self.height, *(marker.y for marker in self.cameras)]) + margin
        return f"{left:.3f} {top:.3f} {right - left:.3f} {bottom - top:.3f}"

    @property
    def line(self) -> float:
        return 0.12 * self.unit

    @property
    def letters(self) -> float:
        return 1.5 * self.unit

    @property
    def arrow(self) -> str:
        """A camera looking to the right, its tip at the middle."""
        size = self.unit
        return f"M{size:.3f} 0L{-size:.3f} {-size:.3f}L{-0.5 * size:.3f} 0L{-size:.3f} {size:.3f}Z"

    def across_ticks(self) -> Iterator[Tick]:
        """Figures in metres below the ground."""
        start, name = (self.grid.origin_y, "Y") if self.turned else (self.grid.origin_x, "X")
        for value in self._round_values(start, self.width):
            yield Tick(value - start, self.height + 2.2 * self.unit, f"{value:g}")
        yield Tick(self.width + 2.5 * self.unit, self.height + 2.2 * self.unit, f"{name} m")

    def upright_ticks(self) -> Iterator[Tick]:
        """Figures in metres left of the ground."""
        start, name = (self.grid.origin_x, "X") if self.turned else (self.grid.origin_y, "Y")
        for value in self._round_values(start, self.height):
            down = value - start if self.turned else self.height - (value - start)
            yield Tick(-1.2 * self.unit, down + 0.5 * self.unit, f"{value:g}")
        yield Tick(-1.2 * self.unit, -1.6 * self.unit, f"{name} m")

    def _round_values(self, start: float, length: float) -> Iterator[float]:
        step = _round_step(self.width / 9)
        first = math.ceil(start / step - 1e-9)
        last = math.floor((start + length) / step + 1e-9)
        return (number * step for number in range(first, last + 1))

    def steps(self) -> Iterator[Step]:
        counts = self.coverage.counts
        for cameras, positions in enumerate(counts):
            red, green, blue = shade(cameras, len(counts) - 1)
            yield Step(cameras, f"#{red:02x}{green:02x}{blue:02x}", positions, 100 * positions / sum(counts))

    def _on_page(self, x: float, y: float) -> tuple[float, float]:
        east, north = x - self.grid.origin_x, y - self.grid.origin_y
        return (north, east) if self.turned else (east, self.height - north)

    def _marker(self, camera: Camera, middle: np.ndarray) -> Marker:
        centre = camera.calibrated.centre
        x, y = self._near(*self._on_page(float(centre[0]), float(centre[1])))
        turn = 0.0
        if np.isfinite(middle).all():
            to_x, to_y = self._on_page(float(middle[0]), float(middle[1]))
            turn = math.degrees(math.atan2(to_y - y, to_x - x))
        back = math.radians(turn) + math.pi
        label = 2.6 * self.unit
        return Marker(
            camera.name, x, y, turn, x + label * math.cos(back), y + label * math.sin(back) + 0.6 * self.unit
        )

    def _near(self, x: float, y: float) -> tuple[float, float]:
        far = FARTHEST * self.width
        return min(max(x, -far), self.width + far), min(max(y, -far), self.height + far)


def _round_step(rough: float) -> float:
    """1, 2 or 5 times a power of ten, at least `rough`."""
    power = 10.0 ** math.floor(math.log10(rough))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= rough)
