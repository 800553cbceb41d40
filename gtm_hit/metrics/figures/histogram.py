"""How often each value occurs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from gtm_hit.metrics.annotations import Floats
from gtm_hit.metrics.figures import svg
from gtm_hit.metrics.figures.axes import Plot, nice_step, ticks

WIDTH, HEIGHT = 480, 300
LEFT, RIGHT, TOP, BOTTOM = 74, 16, 30, 52
BINS = 32  # at most about so many, between round numbers
MOST_SINGLE = 40  # whole numbers up to so many different ones get a bar each
FEWEST = 6  # whole numbers on the axis
DASHES = "4 3"
TILT = math.radians(40)  # of names too long for their bars


def histogram(
    values: ArrayLike, *, title: str, x_label: str, y_label: str, whole: bool = False, decimals: int = 0
) -> str:
    """Bars over round intervals, a line at the median; `whole` for counts, which get bars of their own.

    `decimals` are those of the median as it is told.
    """
    array = np.asarray(values, dtype=np.float64).ravel()
    array = array[np.isfinite(array)]
    if not array.size:
        return _nothing(title)
    edges = _whole_edges(array) if whole else _edges(array)
    counts, _ = np.histogram(array, edges)
    plot = _plot((float(edges[0]), float(edges[-1])), int(counts.max()))
    x_ticks = ticks(*plot.x_range, about=8, whole=whole)
    middle = float(np.median(array))
    told = f"median {middle:,.{decimals}f}"
    parts = [
        *_heading(title),
        *_backdrop(plot, y_label),
        *_bars(plot, edges, counts, gap=1.0),
        *plot.x_axis(x_ticks, x_label),
        svg.line(plot.x(middle), plot.top - 6, plot.x(middle), plot.bottom, stroke_dasharray=DASHES),
        svg.text(plot.right, 14, told, text_anchor="end"),
        svg.line(
            plot.right - svg.text_width(told) - 34,
            10,
            plot.right - svg.text_width(told) - 8,
            10,
            stroke_dasharray=DASHES,
        ),
    ]
    description = f"{array.size:,} values from {array.min():.4g} to {array.max():.4g}, {told}."
    return svg.document(WIDTH, HEIGHT, title, description, parts)


def bars(names: Sequence[str], counts: ArrayLike, *, title: str, x_label: str, y_label: str) -> str:
    """One bar per name with its count above, for a handful of kinds such as the views."""
    heights = np.asarray(counts, dtype=np.int64).ravel()
    if not heights.any():
        return _nothing(title)
    plot = _plot((-0.5, len(names) - 0.5), int(heights.max()) * 1.08)
    slot = plot.width / len(names)
    edges = np.arange(len(names) + 1, dtype=np.float64) - 0.5
    parts = [*_heading(title), *_backdrop(plot, y_label), *_bars(plot, edges, heights, gap=0.22 * slot)]
    told = [f"{height:,}" for height in heights.tolist()]
    if max(svg.text_width(words, svg.SMALL) for words in told) <= slot:
        for place, words in enumerate(told):
            y = plot.y(int(heights[place])) - 5
            parts.append(svg.text(plot.x(place), y, words, text_anchor="middle", font_size=svg.SMALL))
    longest = max(svg.text_width(name) for name in names)
    tilted = longest > slot - 4
    parts += [_name(plot.x(place), plot.bottom, name, tilted) for place, name in enumerate(names)]
    extra = longest * math.sin(TILT) if tilted else 0.0
    parts += plot.x_axis([], x_label, lower=extra)
    description = ", ".join(f"{name}: {words}" for name, words in zip(names, told, strict=True))
    return svg.document(WIDTH, HEIGHT + extra, title, f"{description}.", parts)


def _name(x: float, bottom: float, words: str, tilted: bool) -> str:
    if not tilted:
        return svg.text(x, bottom + 18, words, text_anchor="middle")
    place = f"translate({svg.number(x + 4)} {svg.number(bottom + 14)}) rotate({-math.degrees(TILT):.0f})"
    return svg.element("g", svg.text(0, 0, words, text_anchor="end"), transform=place)


def _plot(x_range: tuple[float, float], most: float) -> Plot:
    step = nice_step(max(most, 1), 5)
    top = max(most, 1) if most % step else most
    return Plot(LEFT, TOP, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM, x_range, (0.0, float(top)))


def _heading(title: str) -> list[str]:
    return [svg.text(LEFT, 14, title, font_weight="bold")]


def _backdrop(plot: Plot, y_label: str) -> list[str]:
    values = ticks(0.0, plot.y_range[1], about=5, whole=True)
    return [*plot.grid_lines(values), *plot.y_axis(values, y_label)]


def _bars(plot: Plot, edges: Floats, counts: np.ndarray, gap: float) -> list[str]:
    drawn = []
    for low, high, count in zip(edges[:-1].tolist(), edges[1:].tolist(), counts.tolist(), strict=True):
        if count:
            left, right, top = plot.x(low) + gap / 2, plot.x(high) - gap / 2, plot.y(count)
            drawn.append(
                svg.element(
                    "rect", x=left, y=top, width=right - left, height=plot.bottom - top, fill=svg.BLUE
                )
            )
    return drawn


def _edges(array: Floats) -> Floats:
    low, high = float(array.min()), float(array.max())
    if high - low <= 1e-9 * max(abs(low), abs(high), 1.0):
        # One value alone has no spread: a narrow bar with some room around it.
        step = nice_step(max(abs(low), 1.0), BINS)
        return low + step * (np.arange(10, dtype=np.float64) - 4.5)
    step = nice_step(high - low, BINS)
    first, last = math.floor(low / step + 1e-9), math.floor(high / step + 1e-9) + 1
    return np.arange(first, last + 1, dtype=np.float64) * step


def _whole_edges(array: Floats) -> Floats:
    low, high = math.floor(array.min()), math.ceil(array.max())
    if high - low < FEWEST:
        # One or two bars alone would fill the plot; counts are never negative.
        low, high = max(low - FEWEST // 2, min(low, 0)), high + FEWEST // 2
    count = high - low + 1
    step = 1 if count <= MOST_SINGLE else int(max(1.0, nice_step(count, BINS)))
    first = low // step * step
    last = first + math.ceil((high - first + 1) / step) * step
    return np.arange(first, last + 1, step, dtype=np.float64) - 0.5


def _nothing(title: str) -> str:
    words = svg.text(WIDTH / 2, HEIGHT / 2, "nothing to show", text_anchor="middle", fill_opacity=0.65)
    return svg.document(WIDTH, HEIGHT, title, "Nothing to show.", [*_heading(title), words])
