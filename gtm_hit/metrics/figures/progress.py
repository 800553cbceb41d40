"""Frames by state over time, one band on the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from gtm_hit.metrics.figures import svg
from gtm_hit.metrics.figures.axes import Plot, ticks

WIDTH, HEIGHT = 760, 320
LEFT, RIGHT, TOP, BOTTOM = 74, 150, 18, 46
MOST_TICKS = 7
STEPS = [timedelta(minutes=minutes) for minutes in (1, 5, 15, 30, 60, 180, 360, 720)]


@dataclass(frozen=True)
class Band:
    """Its values are its own; what lies below it is added when it is drawn. Told apart by pattern too."""

    name: str
    colour: str
    opacity: float
    values: Sequence[int]


def frames_over_time(times: Sequence[datetime], bands: Sequence[Band], total: int, *, title: str) -> str:
    """`times`: ascending, two or more; `bands` from below; `total`: the line everything ends at."""
    span = max((times[-1] - times[0]).total_seconds(), 1.0)
    top = max(total, 1)
    plot = Plot(LEFT, TOP, WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM, (0.0, span), (0.0, top * 1.04))
    seconds = [(time - times[0]).total_seconds() for time in times]
    y_ticks = ticks(0.0, top * 1.04, about=5, whole=True)
    parts = [*plot.grid_lines(y_ticks), *plot.y_axis(y_ticks, "frames, every copy counted")]
    below = [0] * len(times)
    for band in bands:
        above = [low + value for low, value in zip(below, band.values, strict=True)]
        parts += _band(plot, seconds, below, above, band)
        below = above
    parts += _total(plot, total)
    parts += _time_axis(plot, times[0], times[-1])
    parts += _legend(plot, bands)
    return svg.document(WIDTH, HEIGHT, title, _told(times, bands, total), parts)


def _band(
    plot: Plot, seconds: Sequence[float], below: Sequence[int], above: Sequence[int], band: Band
) -> list[str]:
    upper = [f"{svg.number(plot.x(x))},{svg.number(plot.y(y))}" for x, y in zip(seconds, above, strict=True)]
    lower = [f"{svg.number(plot.x(x))},{svg.number(plot.y(y))}" for x, y in zip(seconds, below, strict=True)]
    area = svg.element(
        "polygon", points=" ".join(upper + lower[::-1]), fill=band.colour, fill_opacity=band.opacity
    )
    edge = svg.element("polyline", points=" ".join(upper), fill="none", stroke=band.colour, stroke_width=1.6)
    return [area, edge]


def _total(plot: Plot, total: int) -> list[str]:
    y = plot.y(total)
    rule = svg.line(plot.left, y, plot.right, y, stroke_dasharray="4 4", stroke_opacity=0.7)
    return [rule, svg.text(plot.right + 8, y + 4, f"{total:,} in all")]


def _legend(plot: Plot, bands: Sequence[Band]) -> list[str]:
    parts, x = [], plot.right + 8
    for place, band in enumerate(reversed(bands)):
        y = plot.bottom - 18 * (len(bands) - place) + 8
        parts.append(
            svg.element(
                "rect",
                x=x,
                y=y - 10,
                width=14,
                height=12,
                fill=band.colour,
                fill_opacity=band.opacity,
                stroke=band.colour,
            )
        )
        parts.append(svg.text(x + 20, y, f"{band.name} {band.values[-1]:,}"))
    return parts


def _time_axis(plot: Plot, first: datetime, last: datetime) -> list[str]:
    parts = [svg.line(plot.left, plot.bottom, plot.right, plot.bottom)]
    step = _step(last - first)
    words = "%H:%M" if step < timedelta(days=1) else "%d %b"
    at = _first_tick(first, step)
    while at <= last:
        x = plot.x((at - first).total_seconds())
        parts.append(svg.line(x, plot.bottom, x, plot.bottom + 4))
        told = at.strftime("%d %b") if at.hour == at.minute == 0 else at.strftime(words)
        parts.append(svg.text(x, plot.bottom + 18, told, text_anchor="middle"))
        at += step
    label = f"UTC, since {first:%Y-%m-%d %H:%M}"
    parts.append(svg.text(plot.left + plot.width / 2, plot.bottom + 38, label, text_anchor="middle"))
    return parts


def _step(span: timedelta) -> timedelta:
    fits = (step for step in STEPS if span / step <= MOST_TICKS)
    days = max(1, -(-span // timedelta(days=MOST_TICKS)))
    return next(fits, timedelta(days=days))


def _first_tick(first: datetime, step: timedelta) -> datetime:
    """The first round moment at or after `first`."""
    midnight = first.replace(hour=0, minute=0, second=0, microsecond=0)
    return midnight + step * -(-(first - midnight) // step)


def _told(times: Sequence[datetime], bands: Sequence[Band], total: int) -> str:
    told = ", ".join(f"{band.name} {band.values[-1]}" for band in bands)
    return f"Of {total} frames, on {times[-1]:%Y-%m-%d}: {told}."
