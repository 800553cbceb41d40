"""The ground from above as an SVG: where metres lie on the page."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from gtm_hit.models import Dataset
from gtm_hit.ops.ground.coverage import Coverage, shade

SHAPE = 1.9  # width by height of the place on the page
FARTHEST = 0.8  # of the grid's longer side; a camera farther away is drawn at this distance


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

    @cached_property
    def places(self) -> list[tuple[float, float]]:
        """Where the cameras stand on the page."""
        centres = [camera.calibrated.centre.tolist() for camera in self.dataset.cameras.all()]
        return [self._near(*self._on_page(x, y)) for x, y, _ in centres]

    @cached_property
    def cameras(self) -> list[Marker]:
        markers: list[Marker] = []
        names = [camera.name for camera in self.dataset.cameras.all()]
        for name, place, middle in zip(names, self.places, self.coverage.middles, strict=True):
            markers.append(self._apart(self._marker(name, *place, middle), markers))
        return markers

    @cached_property
    def unit(self) -> float:
        """A hundredth of the drawing's width: lines and letters look alike in every scene."""
        left, top, right, bottom = self._bounds()
        return max(right - left, (bottom - top) * SHAPE) / 84

    @property
    def view_box(self) -> str:
        left, top, right, bottom = self._bounds()
        margin = 4.5 * self.unit
        return (
            f"{left - margin:.3f} {top - margin:.3f} "
            f"{right - left + 2 * margin:.3f} {bottom - top + 2 * margin:.3f}"
        )

    def _bounds(self) -> tuple[float, float, float, float]:
        across = [0.0, self.width, *(x for x, _ in self.places)]
        down = [0.0, self.height, *(y for _, y in self.places)]
        return min(across), min(down), max(across), max(down)

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
        yield Tick(self.width - self.unit, self.height + 4.0 * self.unit, f"{name} m")

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

    def _marker(self, name: str, x: float, y: float, middle: np.ndarray) -> Marker:
        turn = 0.0
        if np.isfinite(middle).all():
            to_x, to_y = self._on_page(float(middle[0]), float(middle[1]))
            turn = math.degrees(math.atan2(to_y - y, to_x - x))
        back = math.radians(turn) + math.pi
        away = 2.6 * self.unit
        return Marker(
            name, x, y, turn, x + away * math.cos(back), y + away * math.sin(back) + 0.5 * self.unit
        )

    def _apart(self, marker: Marker, others: list[Marker]) -> Marker:
        """The same camera with its name moved down until it covers no other name."""
        width, height = 3 * self.unit, 1.7 * self.unit
        while any(
            abs(marker.label_x - other.label_x) < width and abs(marker.label_y - other.label_y) < height
            for other in others
        ):
            marker = replace(marker, label_y=marker.label_y + height / 2)
        return marker

    def _near(self, x: float, y: float) -> tuple[float, float]:
        far = FARTHEST * self.width
        return min(max(x, -far), self.width + far), min(max(y, -far), self.height + far)


def _round_step(rough: float) -> float:
    """1, 2 or 5 times a power of ten, at least `rough`."""
    power = 10.0 ** math.floor(math.log10(rough))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= rough)
