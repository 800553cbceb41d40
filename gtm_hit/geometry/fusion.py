"""Where people stand, told by their boxes in several views."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, back_project
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.table import RectangleTable

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
Flags = NDArray[np.bool_]
Costs = Callable[[Ids, Ids], Floats]  # people (N,) and positions (N, K) to what each would cost, (N, K)

PEOPLE_TOGETHER = 1024  # bounds the memory of a search
STRIDES = (16, 4, 1)  # positions between neighbours of a search, coarse to fine
MOST_MOVES = 12  # of a search, at each stride
REACH = 4  # positions around the best that may explain the boxes as well
NOT_SEEN = 1e5  # costs more than any difference in pixels
CLOSE = 0.03  # heights of a box that its feet may be away from those of an explaining rectangle
EDGE = 1.0  # metres: boxes are read in whole pixels, so feet on the grid can come out this far off it


@dataclass(frozen=True, eq=False)
class Fused:
    """One row per person.

    positions : (N,) ids; -1 where no box shows the ground, or what it shows is off the grid
    xy : (N, 2) metres, the weighted mean of what the views show; NaN where none shows the ground
    """

    positions: Ids
    xy: Floats


def feet(boxes: NDArray) -> Floats:
    """Pixels u and v, (..., 2), where people with boxes (..., 4) touch the ground: bottom centre."""
    sides = np.asarray(boxes, dtype=np.float64)
    return np.stack(((sides[..., 0] + sides[..., 2]) / 2, sides[..., 3]), axis=-1)


def ground_points(cameras: Sequence[Camera], boxes: Floats) -> tuple[Floats, Floats]:
    """What the feet of boxes (N, C, 4), NaN where not seen, show of the ground.

    Returns metres (N, C, 2) and weights (N, C), one over the squared viewing distance; NaN and 0 for boxes
    that show none.
    """
    points = np.full((*boxes.shape[:2], 2), np.nan)
    weights = np.zeros(boxes.shape[:2])
    for number, camera in enumerate(cameras):
        rows = np.flatnonzero(~np.isnan(boxes[:, number, 0]))
        if rows.size:
            points[rows, number] = back_project(camera, feet(boxes[rows, number]))
            away = points[rows, number] - camera.centre[:2]
            weights[rows, number] = np.nan_to_num(1 / ((away**2).sum(axis=1) + camera.centre[2] ** 2))
    return points, weights


def weighted_mean(points: Floats, weights: Floats) -> Floats:
    """(N, 2) of points (N, C, 2) and weights (N, C); NaN where all weights are 0."""
    total = weights.sum(axis=1)
    with np.errstate(invalid="ignore"):
        return (np.nan_to_num(points) * weights[..., None]).sum(axis=1) / total[:, None]


def fuse(table: RectangleTable, cameras: Sequence[Camera], boxes: Floats) -> Fused:
    """The positions of people with boxes (N, C, 4) in pixels, NaN in views that do not show them.

    Feet are taken back to the ground and averaged, near views counting more. From there the position is
    searched whose rectangles are the boxes; where none is, because people and boxes differ from the table's
    cylinder, the one whose rectangles stand where the boxes stand.
    """
    grid = table.grid
    xy = weighted_mean(*ground_points(cameras, boxes))
    positions = np.full(len(boxes), -1, dtype=np.int64)
    near = np.flatnonzero(_near(grid, xy))
    for start in range(0, near.size, PEOPLE_TOGETHER):
        rows = near[start : start + PEOPLE_TOGETHER]
        found, costs = _search(grid, grid.nearest(xy[rows]), _sides_cost(table, boxes[rows]))
        equal = costs == 0
        positions[rows[equal]] = _middle_of_equals(table, boxes[rows[equal]], found[equal])
        others = rows[~equal]
        positions[others] = _standing_alike(table, boxes[others], xy[others])
    return Fused(positions, xy)


def _standing_alike(table: RectangleTable, boxes: Floats, xy: Floats) -> Ids:
    """The positions whose rectangles stand where the boxes stand; the nearest ones where none is close by.

    -1 for what is off the grid and no position at its border explains.
    """
    grid = table.grid
    found, costs = _search(grid, grid.nearest(xy), _feet_cost(table, boxes))
    views = (~np.isnan(boxes[..., 0])).sum(axis=1)
    explained = costs <= CLOSE**2 * views
    # In views that see nothing around the start the search would run away.
    explained &= np.hypot(*(grid.metres(found) - xy).T) <= EDGE
    return np.where(explained, found, grid.position(xy))


def _near(grid: Grid, xy: Floats) -> Flags:
    last = grid.metres([grid.count - 1])[0]
    first = grid.metres([0])[0]
    return np.all((xy > first - EDGE) & (xy < last + EDGE), axis=1)  # NaN is not


def _sides_cost(table: RectangleTable, boxes: Floats) -> Costs:
    """Differences of all four sides, pixels."""

    def costs(people: Ids, positions: Ids) -> Floats:
        total = np.zeros(positions.shape)
        for camera in range(boxes.shape[1]):
            rows = np.flatnonzero(~np.isnan(boxes[people, camera, 0]))
            rectangles = table.boxes(camera)[positions[rows]]
            difference = np.abs(rectangles - boxes[people[rows], camera, None]).sum(axis=-1)
            total[rows] += np.where(rectangles[..., 2] > 0, difference, NOT_SEEN)
        return total

    return costs


def _feet_cost(table: RectangleTable, boxes: Floats) -> Costs:
    """Squared distances of the feet in heights of the box, so that a view counts by how near it is."""

    def costs(people: Ids, positions: Ids) -> Floats:
        total = np.zeros(positions.shape)
        for camera in range(boxes.shape[1]):
            rows = np.flatnonzero(~np.isnan(boxes[people, camera, 0]))
            given = boxes[people[rows], camera]
            rectangles = table.boxes(camera)[positions[rows]]
            away = ((feet(rectangles) - feet(given)[:, None]) ** 2).sum(axis=-1)
            tall = np.maximum(given[:, 3] - given[:, 1], 1.0)[:, None]
            total[rows] += np.where(rectangles[..., 2] > 0, away / tall**2, NOT_SEEN)
        return total

    return costs


def _search(grid: Grid, start: Ids, costs: Costs) -> tuple[Ids, Floats]:
    """The cheapest position around each start, (N,), and what it costs: downhill in ever smaller strides."""
    best = start.copy()
    least = np.full(len(start), np.inf)
    for stride in STRIDES:
        moving = np.arange(len(start))
        for _ in range(MOST_MOVES):
            if not moving.size:
                break
            around = _around(grid, best[moving], stride, 2)
            cost = costs(moving, around)
            place = cost.argmin(axis=1)
            cheapest = np.take_along_axis(cost, place[:, None], 1)[:, 0]
            better = cheapest < least[moving]
            best[moving[better]] = around[better, place[better]]
            least[moving[better]] = cheapest[better]
            moving = moving[better]
    return best, least


def _around(grid: Grid, positions: Ids, stride: int, reach: int) -> Ids:
    """Positions (N, K) of a square around each position, the middle first; clamped to the grid."""
    steps = np.arange(-reach, reach + 1) * stride
    rows, columns = (axis.ravel() for axis in np.meshgrid(steps, steps, indexing="ij"))
    order = np.argsort(rows**2 + columns**2, kind="stable")  # of equal costs the nearest is taken
    row, column = np.divmod(positions, grid.columns)
    row = np.clip(row[:, None] + rows[order], 0, grid.rows - 1)
    column = np.clip(column[:, None] + columns[order], 0, grid.columns - 1)
    return row * grid.columns + column


def _middle_of_equals(table: RectangleTable, boxes: Floats, found: Ids) -> Ids:
    """Of all positions with the same rectangles as `found`, far from all cameras, the one in their middle.

    Those that stay out of the views without a box come first.
    """
    grid = table.grid
    around = _around(grid, found, 1, REACH)
    equal = _sides_cost(table, boxes)(np.arange(len(found)), around) == 0
    several = np.flatnonzero((equal & (around != found[:, None])).any(axis=1))
    boxes, around, equal = boxes[several], around[several], equal[several]
    surplus = np.zeros(around.shape, dtype=np.int64)
    for camera in range(boxes.shape[1]):
        surplus += np.isnan(boxes[:, camera, :1]) & (table.boxes(camera)[around][..., 2] > 0)
    fewest = np.where(equal, surplus, boxes.shape[1] + 1).min(axis=1, keepdims=True)
    equal &= surplus == fewest
    xy = grid.metres(around.ravel()).reshape(*around.shape, 2)
    middle = (xy * equal[..., None]).sum(axis=1) / equal.sum(axis=1)[:, None]
    away = np.where(equal, ((xy - middle[:, None]) ** 2).sum(axis=-1), np.inf)
    result = found.copy()
    result[several] = np.take_along_axis(around, away.argmin(axis=1)[:, None], 1)[:, 0]
    return result
