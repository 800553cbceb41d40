"""Detection scores over the radius."""

from __future__ import annotations

import math
from collections.abc import Sequence

from gtm_hit.metrics.detection import DetectionScore
from gtm_hit.metrics.figures import svg
from gtm_hit.metrics.figures.axes import Plot, ticks
from gtm_hit.metrics.matching import RADIUS

WIDTH, HEIGHT = 480, 320
LEFT, RIGHT, TOP, BOTTOM = 74, 104, 30, 52
LABEL_HEIGHT = 14  # pixels two labels at the end of the curves keep apart

# Told apart by dashes as well as by colour.
STYLES = (
    ("moda", "MODA", svg.BLUE, None, 2.4),
    ("modp", "MODP", svg.RED, "7 3", 1.6),
    ("precision", "precision", svg.GREEN, "2 3", 1.6),
    ("recall", "recall", svg.AMBER, "8 3 2 3", 1.6),
)


def score_curve(scores: Sequence[DetectionScore], *, title: str, marked: float = RADIUS) -> str:
    """`scores` in ascending order of radius, two or more; a line marks the radius scores are quoted at."""
    radii = [score.radius for score in scores]
    values = {name: [float(getattr(score, name)) for score in scores] for name, *_ in STYLES}
    lowest = min([0.0, *(value for value in values["moda"] if not math.isnan(value))])
    # A detector far below zero would press everything else into a line.
    low = max(-1.0, math.floor(lowest * 5) / 5)
    plot = Plot(LEFT, TOP, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM, (0.0, max(radii)), (low, 1.0))
    y_ticks = ticks(low, 1.0, about=6)
    parts = [*plot.grid_lines(y_ticks), *plot.y_axis(y_ticks, "score")]
    parts += plot.x_axis(ticks(0.0, max(radii), about=6), "radius r (m)")
    if marked <= max(radii):
        parts.append(_marker(plot, marked))
    for name, _, colour, dashes, width in reversed(STYLES):
        parts += _curve(plot, radii, values[name], colour, dashes, width)
    parts += _end_labels(plot, values)
    return svg.document(WIDTH, HEIGHT, title, _told(scores, marked), [_heading(title), *parts])


def _heading(title: str) -> str:
    return svg.text(LEFT, 14, title, font_weight="bold")


def _marker(plot: Plot, radius: float) -> str:
    x = plot.x(radius)
    rule = svg.line(x, plot.top, x, plot.bottom, stroke_dasharray="2 3", stroke_opacity=0.7)
    words = f"r = {svg.number(radius)} m"
    return rule + svg.text(x + 5, plot.bottom - 8, words, font_size=svg.SMALL)


def _curve(
    plot: Plot, radii: list[float], values: list[float], colour: str, dashes: str | None, width: float
) -> list[str]:
    """One polyline per stretch of defined scores."""
    stretches: list[list[str]] = [[]]
    for radius, value in zip(radii, values, strict=True):
        if math.isnan(value):
            stretches.append([])
        else:
            y = plot.y(max(value, plot.y_range[0]))
            stretches[-1].append(f"{svg.number(plot.x(radius))},{svg.number(y)}")
    return [
        svg.element(
            "polyline",
            points=" ".join(points),
            fill="none",
            stroke=colour,
            stroke_width=width,
            stroke_dasharray=dashes,
            stroke_linejoin="round",
        )
        for points in stretches
        if len(points) > 1
    ]


def _end_labels(plot: Plot, values: dict[str, list[float]]) -> list[str]:
    """Each curve's name where it ends, moved apart where they would touch."""
    ends = sorted(
        (plot.y(max(values[name][-1], plot.y_range[0])), words, colour, dashes or "", width)
        for name, words, colour, dashes, width in STYLES
        if not math.isnan(values[name][-1])
    )
    parts = []
    for place, (_, words, colour, dashes, width) in zip(
        _apart([y for y, *_ in ends], plot.bottom - 4), ends, strict=True
    ):
        x, style = plot.right + 6, {"stroke_width": width, "stroke_dasharray": dashes or None}
        parts.append(svg.line(x, place, x + 24, place, stroke=colour, **style))
        parts.append(svg.text(x + 30, place + 4, words))
    return parts


def _apart(places: list[float], limit: float) -> list[float]:
    """Ascending places, pushed down until none touches the one above, and up again from the limit."""
    moved: list[float] = []
    for place in places:
        moved.append(max(place, moved[-1] + LABEL_HEIGHT) if moved else place)
    for index in reversed(range(len(moved))):
        moved[index] = min(moved[index], limit)
        limit = moved[index] - LABEL_HEIGHT
    return moved


def _told(scores: Sequence[DetectionScore], marked: float) -> str:
    nearest = min(scores, key=lambda score: abs(score.radius - marked))
    told = ", ".join(f"{words} {getattr(nearest, name):.3f}" for name, words, *_ in STYLES)
    return f"Scores over the radius. At {svg.number(nearest.radius)} m: {told}."
