"""The grid from above: the darker, the more cameras see a position."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.coverage import Coverage
from gtm_hit.metrics.figures import svg
from gtm_hit.metrics.figures.axes import TICK, Scale, labels, ticks
from gtm_hit.metrics.figures.camera_marks import DARK, CameraMark, camera_marks

LONG_SIDE = 640  # pixels of the longer side of the map
LEFT, RIGHT, TOP, AXIS = 52, 12, 24, 46
SWATCH, PER_ROW, LEGEND_ROW = 58, 8, 54
FARTHEST = 0.25  # of the grid's longer side; a camera beyond is left out rather than shrinking the map

# ColorBrewer's YlGnBu: growing darkness, also in print and to the colour-blind.
SHADES = ("#f4fbc4", "#c7e9b4", "#7fcdbb", "#41b6c4", "#1d91c0", "#225ea8", "#253494", "#081d58")


@dataclass(frozen=True)
class _View:
    """From metres to pixels, seen from above: X right and Y up, or that turned clockwise by a quarter."""

    turned: bool
    along: Scale  # the horizontal axis: X, or Y when turned
    across: Scale  # the vertical axis: Y growing upwards, or X growing downwards when turned

    def pixels(self, x: float, y: float) -> tuple[float, float]:
        return (self.along(y), self.across(x)) if self.turned else (self.along(x), self.across(y))

    @property
    def bottom(self) -> float:
        return max(self.across.start, self.across.end)


def coverage_map(coverage: Coverage, cameras: Sequence[CameraMark] = (), *, title: str) -> str:
    near = [mark for mark in cameras if _is_near(mark, coverage.grid)]
    view = _view(coverage.grid, near)
    width = view.along.end + RIGHT
    height = view.bottom + AXIS + LEGEND_ROW * len(_legend_rows(coverage))
    parts = [
        svg.text(LEFT, 14, title, font_weight="bold"),
        *_cells(coverage, view),
        *_axes(view),
        *camera_marks(near, view.pixels, (LEFT, TOP, view.along.end, view.bottom)),
        *_legend(coverage, view.bottom + AXIS),
    ]
    counts = ", ".join(
        f"{count:,} seen by {seen}" for seen, count in enumerate(coverage.counts.tolist()) if count
    )
    description = f"{coverage.seen_by.size:,} positions: {counts}; mean {coverage.mean:.2f} cameras."
    return svg.document(width, height, title, description, parts)


def _is_near(mark: CameraMark, grid: Grid) -> bool:
    (width, length), reach = grid.extent, max(grid.extent) * FARTHEST
    return (
        -reach <= mark.x - grid.origin_x <= width + reach
        and -reach <= mark.y - grid.origin_y <= length + reach
    )


def _view(grid: Grid, cameras: Sequence[CameraMark]) -> _View:
    """The grid and all cameras with some room, the longer side horizontal."""
    width, length = grid.extent
    room = 0.03 * max(width, length)
    x_range = _range(grid.origin_x, width, [mark.x for mark in cameras], room)
    y_range = _range(grid.origin_y, length, [mark.y for mark in cameras], room)
    turned = length > width
    horizontal, vertical = (y_range, x_range) if turned else (x_range, y_range)
    spans = horizontal[1] - horizontal[0], vertical[1] - vertical[0]
    scale = LONG_SIDE / max(spans)
    bottom = TOP + spans[1] * scale
    return _View(
        turned,
        Scale(*horizontal, LEFT, LEFT + spans[0] * scale),
        Scale(*vertical, *((TOP, bottom) if turned else (bottom, TOP))),
    )


def _range(origin: float, side: float, places: list[float], room: float) -> tuple[float, float]:
    return min([origin, *places]) - room, max([origin + side, *places]) + room


def _cells(coverage: Coverage, view: _View) -> list[str]:
    """Every shade covers all that is at least as dark: neighbours overlap and no gap shows between them."""
    # Row 0 on top: there X begins when turned, else Y ends.
    rows = coverage.seen_by.T if view.turned else coverage.seen_by[::-1]
    x, y = coverage.grid.origin_x, coverage.grid.origin_y
    (left, right), (top, bottom) = (
        sorted(pair)
        for pair in zip(
            view.pixels(x, y),
            view.pixels(x + coverage.grid.extent[0], y + coverage.grid.extent[1]),
            strict=True,
        )
    )
    scale = f"{(right - left) / rows.shape[1]:.6g} {(bottom - top) / rows.shape[0]:.6g}"
    shades = [
        svg.element("path", d=_outline(rows >= seen), fill=_shade(seen, coverage.cameras))
        for seen in range(1, coverage.cameras + 1)
        if (rows >= seen).any()
    ]
    place = f"translate({svg.number(left)} {svg.number(top)}) scale({scale})"
    frame: dict[str, Any] = {"x": left, "y": top, "width": right - left, "height": bottom - top}
    return [
        svg.element("rect", **frame, fill="#fff"),
        svg.element("g", "".join(shades), transform=place, shape_rendering="crispEdges"),
        svg.element("rect", **frame, fill="none", stroke="currentColor"),
    ]


def _outline(mask: np.ndarray) -> str:
    """Path over the true cells: rectangles of equal runs in consecutive rows, in units of cells."""
    parts: list[str] = []
    open_runs: dict[tuple[int, int], int] = {}  # run -> the row it began in
    for row in range(mask.shape[0] + 1):
        runs = _runs(mask[row]) if row < mask.shape[0] else set()
        for start, end in sorted(open_runs.keys() - runs):
            began = open_runs.pop((start, end))
            parts.append(f"M{start} {began}h{end - start}v{row - began}h{start - end}z")
        for run in runs - open_runs.keys():
            open_runs[run] = row
    return "".join(parts)


def _runs(cells: np.ndarray) -> set[tuple[int, int]]:
    changes = np.flatnonzero(np.diff(np.concatenate(([0], cells.astype(np.int8), [0]))))
    return {(int(start), int(end)) for start, end in changes.reshape(-1, 2)}


def _shade(seen: int, cameras: int) -> str:
    """Colour of a position seen by `seen` of `cameras`: the first shade for one, the darkest for all."""
    place = (seen - 1) / max(cameras - 1, 1) * (len(SHADES) - 1) if cameras > 1 else len(SHADES) - 1
    low = min(int(place), len(SHADES) - 2)
    share = place - low
    mixed = [
        round(int(SHADES[low][i : i + 2], 16) * (1 - share) + int(SHADES[low + 1][i : i + 2], 16) * share)
        for i in (1, 3, 5)
    ]
    return "#{:02x}{:02x}{:02x}".format(*mixed)


def _axes(view: _View) -> list[str]:
    along, across, bottom = view.along, view.across, view.bottom
    frame: dict[str, Any] = {"x": LEFT, "y": TOP, "width": along.end - LEFT, "height": bottom - TOP}
    parts = [svg.element("rect", **frame, fill="none", stroke="currentColor", stroke_opacity=0.35)]
    horizontal = ticks(along.low, along.high, about=8)
    for value, words in zip(horizontal, labels(horizontal), strict=True):
        parts.append(svg.line(along(value), bottom, along(value), bottom + TICK))
        parts.append(svg.text(along(value), bottom + 17, words, text_anchor="middle"))
    vertical = ticks(across.low, across.high, about=5)
    for value, words in zip(vertical, labels(vertical), strict=True):
        parts.append(svg.line(LEFT - TICK, across(value), LEFT, across(value)))
        parts.append(svg.text(LEFT - 8, across(value) + 4, words, text_anchor="end"))
    x, y = LEFT - 38, (TOP + bottom) / 2
    turn = f"rotate(-90 {svg.number(x)} {svg.number(y)})"
    names = ("Y (m)", "X (m)") if view.turned else ("X (m)", "Y (m)")
    parts.append(svg.text((LEFT + along.end) / 2, bottom + 35, names[0], text_anchor="middle"))
    parts.append(svg.text(x, y, names[1], text_anchor="middle", transform=turn))
    return parts


def _legend(coverage: Coverage, top: float) -> list[str]:
    """One swatch per number of cameras with how many positions it has below, and the mean behind the last."""
    parts = []
    for row, seen_by in enumerate(_legend_rows(coverage)):
        y = top + row * LEGEND_ROW
        parts += [svg.text(LEFT, y + 18, "cameras"), svg.text(LEFT, y + 40, "positions")]
        for place, seen in enumerate(seen_by):
            parts += _swatch(coverage, seen, LEFT + 68 + place * SWATCH, y)
    x = LEFT + 68 + len(seen_by) * SWATCH + 16
    parts.append(svg.text(x, y + 18, f"mean {coverage.mean:.2f}", font_weight="bold"))
    parts.append(svg.text(x, y + 40, f"of {coverage.seen_by.size:,}"))
    return parts


def _swatch(coverage: Coverage, seen: int, left: float, top: float) -> list[str]:
    fill = _shade(seen, coverage.cameras) if seen else "#fff"
    # Dark figures on the lighter half of the shades, white ones on the darker.
    ink = "#fff" if seen > (coverage.cameras + 1) / 2 else DARK
    middle, count = left + SWATCH / 2, int(coverage.counts[seen])
    return [
        svg.element("rect", x=left, y=top + 4, width=SWATCH, height=20, fill=fill, stroke="currentColor"),
        svg.text(middle, top + 18, str(seen), text_anchor="middle", fill=ink),
        svg.text(middle, top + 40, f"{count:,}", text_anchor="middle"),
    ]


def _legend_rows(coverage: Coverage) -> list[range]:
    first = 0 if coverage.counts[0] else 1
    stop = coverage.cameras + 1
    return [range(low, min(low + PER_ROW, stop)) for low in range(first, stop, PER_ROW)] or [range(0)]
