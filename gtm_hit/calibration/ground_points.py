"""Points measured on the ground (or above it), and what looks wrong about a list of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.errors import GeometryError

Floats = NDArray[np.float64]

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}
UNIT_WORDS = {"m": "metres", "cm": "centimetres", "mm": "millimetres"}
LEAST_SPAN, MOST_SPAN = 0.5, 300.0  # metres from end to end of what people measure out for cameras
SLIP = 0.05  # metres off a line of the grid that count as a slip and not as another line
SAME = 1e-6  # metres
MOST_GRID = 10_000
ORDER = ("X", "Y", "Z")


@dataclass(frozen=True)
class GroundPoint:
    name: str
    x: float  # metres, world
    y: float
    z: float = 0.0

    @property
    def place(self) -> tuple[float, float, float]:
        return (self.x, self.y, self.z)


class GroundPointsError(GeometryError):
    """A grid nobody can have measured; says which number."""


def regular_grid(
    columns: int,
    rows: int,
    spacing: tuple[float, float],
    origin: tuple[float, float] = (0.0, 0.0),
    z: float = 0.0,
) -> list[GroundPoint]:
    """Points at `origin` + (column, row) · `spacing`, all metres, named A1, B1, … by column and row."""
    if columns < 1 or rows < 1 or not 4 <= columns * rows <= MOST_GRID:
        raise GroundPointsError(f"a grid of {columns} × {rows} points; 4 to {MOST_GRID:,} are sensible")
    numbers = (*spacing, *origin, z)
    if not np.isfinite(numbers).all() or 0 in spacing:
        raise GroundPointsError(f"spacing and origin must be finite, the spacing not 0: {numbers}")
    return [
        GroundPoint(
            f"{column_name(column)}{row + 1}",
            origin[0] + column * spacing[0],
            origin[1] + row * spacing[1],
            z,
        )
        for row in range(rows)
        for column in range(columns)
    ]


def column_name(column: int) -> str:
    """A, B, … Z, AA, … as in a spreadsheet."""
    letters = ""
    column += 1
    while column:
        column, rest = divmod(column - 1, 26)
        letters = chr(ord("A") + rest) + letters
    return letters


def likely_unit(span: float) -> str:
    """The unit in which a list that goes on for `span` has a sensible size."""
    return "m" if span <= 150 else "cm" if span <= 15_000 else "mm"


def span_of(places: Floats) -> float:
    """The longer side of the ground that points (N, 2 or 3) lie on."""
    return float(np.ptp(places[:, :2], axis=0).max()) if len(places) else 0.0


def same_places(points: Sequence[GroundPoint]) -> Iterator[tuple[int, int]]:
    """Indices of points that lie where an earlier one does: the earlier, then the later."""
    first: dict[tuple[float, ...], int] = {}
    for index, point in enumerate(points):
        key = tuple(np.round(np.array(point.place) / SAME).tolist())
        if key in first:
            yield first[key], index
        else:
            first[key] = index


def doubts(points: Sequence[GroundPoint], unit: str) -> list[str]:
    """Sentences about what looks wrong: the unit, a single point's unit, a point beside its grid."""
    places = np.array([point.place for point in points], dtype=np.float64).reshape(-1, 3)
    units = list(_strange_units(points, places)) or list(_whole_unit(places, unit))
    return [*units, *_beside_the_grid(points, places, unit)]


def _whole_unit(places: Floats, unit: str) -> Iterator[str]:
    span = span_of(places)
    if len(places) < 2 or LEAST_SPAN <= span <= MOST_SPAN:
        return
    likely = likely_unit(span / METRES[unit])
    if likely != unit:
        told = f"{span:,.0f} m" if span > 1 else f"{1000 * span:.3g} mm"
        yield f"The points span {told}: this looks like {UNIT_WORDS[likely]}, not {UNIT_WORDS[unit]}."


def _strange_units(points: Sequence[GroundPoint], places: Floats) -> Iterator[str]:
    """Points a hundred or a thousand times as far out as all the others."""
    sizes = np.abs(places[:, :2]).max(axis=1)
    for index, point in enumerate(points):
        others = np.delete(sizes, index)
        if len(others) < 3:
            return
        usual = float(np.sort(others)[-max(1, len(others) // 4) :].mean())
        for factor, word in ((100.0, "centimetres"), (1000.0, "millimetres")):
            if usual > 0 and sizes[index] > 10 * usual and sizes[index] / factor <= 2 * usual:
                yield f"Point {point.name} looks like {word} among points in larger units."
                break


def _beside_the_grid(points: Sequence[GroundPoint], places: Floats, unit: str) -> Iterator[str]:
    for axis in (0, 1):
        counts = Counter(np.round(places[:, axis] / SAME).astype(np.int64).tolist())
        lines = {value * SAME: count for value, count in counts.items() if count >= 2}
        if sum(lines.values()) < 0.6 * len(points):
            continue  # no grid
        for point, value in zip(points, places[:, axis].tolist(), strict=True):
            nearest = min(lines, key=lambda line: abs(line - value))
            off = abs(nearest - value)
            if 2 * SAME < off <= SLIP:
                yield _beside(point, ORDER[axis], value, nearest, lines[nearest], unit)


def _beside(point: GroundPoint, axis: str, value: float, line: float, count: int, unit: str) -> str:
    here, there = (f"{each / METRES[unit]:g} {unit}" for each in (value, line))
    off = 100 * abs(value - line)
    return f"{axis} of point {point.name} is {here}, {off:.3g} cm off the {count} others at {there}."
