"""Scales, ticks at round numbers, and the two axes of a plot."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gtm_hit.metrics.figures import svg

TICK = 4  # pixels


@dataclass(frozen=True)
class Scale:
    """Values from `low` to `high` on pixels from `start` to `end`; `end` may be the smaller one."""

    low: float
    high: float
    start: float
    end: float

    def __call__(self, value: float) -> float:
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)


@dataclass(frozen=True)
class Plot:
    """The rectangle data is drawn in, pixels, with its two scales."""

    left: float
    top: float
    width: float
    height: float
    x_range: tuple[float, float]
    y_range: tuple[float, float]

    @property
    def x(self) -> Scale:
        return Scale(*self.x_range, self.left, self.left + self.width)

    @property
    def y(self) -> Scale:
        return Scale(*self.y_range, self.top + self.height, self.top)

    @property
    def right(self) -> float:
        return self.left + self.width

    @property
    def bottom(self) -> float:
        return self.top + self.height

    def grid_lines(self, values: list[float]) -> list[str]:
        return [
            svg.line(self.left, self.y(value), self.right, self.y(value), stroke_opacity=0.14)
            for value in values
        ]

    def y_axis(self, values: list[float], label: str) -> list[str]:
        marks = [
            svg.text(self.left - 8, self.y(value) + 4, words, text_anchor="end")
            for value, words in zip(values, labels(values), strict=True)
        ]
        x, y = self.left - 58, self.top + self.height / 2
        turned = f"rotate(-90 {svg.number(x)} {svg.number(y)})"
        return [*marks, svg.text(x, y, label, text_anchor="middle", transform=turned)]

    def x_axis(self, values: list[float], label: str, lower: float = 0.0) -> list[str]:
        """`lower`: pixels by which the label makes room for something else."""
        parts = [svg.line(self.left, self.bottom, self.right, self.bottom)]
        for value, words in zip(values, labels(values), strict=True):
            parts.append(svg.line(self.x(value), self.bottom, self.x(value), self.bottom + TICK))
            parts.append(svg.text(self.x(value), self.bottom + 18, words, text_anchor="middle"))
        middle = self.left + self.width / 2
        return [*parts, svg.text(middle, self.bottom + 38 + lower, label, text_anchor="middle")]


def nice_step(span: float, about: int) -> float:
    """1, 2 or 5 times a power of ten, so that about `about` of them make up the span."""
    raw = span / about
    power = 10.0 ** math.floor(math.log10(raw))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw * 0.999)


def ticks(low: float, high: float, about: int = 6, whole: bool = False) -> list[float]:
    """Round values within the range; with `whole` only whole numbers."""
    step = nice_step(high - low, about)
    step = max(1.0, step) if whole else step
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [round(index * step, 10) for index in range(first, last + 1)]


def labels(values: list[float]) -> list[str]:
    """With the decimals that tell neighbours apart, thousands separated, and a real minus sign."""
    decimals = max((_decimals(value) for value in values), default=0)
    return [f"{value:,.{decimals}f}".replace("-", "−") for value in values]


def _decimals(value: float) -> int:
    return len(f"{value:.6f}".rstrip("0").partition(".")[2])
