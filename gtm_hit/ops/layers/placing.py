"""Boxes in views into people on the ground."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.fusion import feet, fuse, ground_points
from gtm_hit.geometry.grouping import group_by_place, link, same_ids_same_people
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.ops.jobs.progress import Progress
from gtm_hit.ops.layers.tables import NOBODY, Boxes, Floats, Ids, People, people

PLACING = "finding positions"
PEOPLE_AT_ONCE = 4096
SAME_FEET = 2.0  # pixels: a position the file states is believed when its rectangle stands where the box does
LEAN = 0.2  # sideways, for every pixel that the box of somebody taller or smaller is higher or lower


def place(
    boxes: Boxes,
    table: RectangleTable,
    cameras: Sequence[Camera],
    report: Progress,
) -> People:
    """One person for the boxes of one person in several views of a frame.

    Who is who is told by the ids where they mean the same person in every view, else by places on the ground.
    A row's source is the first box of its person.
    """
    groups, persons = _groups(boxes, cameras)
    order = np.lexsort((np.arange(len(boxes)), groups))
    first = order[np.searchsorted(groups[order], np.arange(len(persons)))]
    positions = np.full(len(persons), NOBODY)
    for start in range(0, len(persons), PEOPLE_AT_ONCE):
        stop = min(start + PEOPLE_AT_ONCE, len(persons))
        rows = order[slice(*np.searchsorted(groups[order], (start, stop)))]
        seen = np.full((stop - start, len(cameras), 4), np.nan)
        stated = np.full((stop - start, len(cameras)), NOBODY)
        seen[groups[rows] - start, boxes.cameras[rows]] = boxes.boxes[rows]
        stated[groups[rows] - start, boxes.cameras[rows]] = boxes.positions[rows]
        positions[start:stop] = _positions(seen, stated, table, cameras)
        report(PLACING, stop, len(persons))
    return people(boxes.frames[first], persons, positions, boxes.sources.take(first))


def _groups(boxes: Boxes, cameras: Sequence[Camera]) -> tuple[Ids, Ids]:
    """The group of each box, (N,) counted from 0, and the person of each group."""
    points, weights = _on_the_ground(boxes, cameras)
    named = bool(len(boxes)) and bool((boxes.persons != NOBODY).all())
    if named:
        pairs = np.column_stack((boxes.frames, boxes.persons))
        if (boxes.cameras == boxes.cameras[0]).all() or same_ids_same_people(
            points, [tuple(pair) for pair in pairs.tolist()]
        ):
            found, groups = np.unique(pairs, axis=0, return_inverse=True)
            return groups.ravel(), found[:, 1]
    groups = np.full(len(boxes), NOBODY)
    members: list[tuple[int, list[tuple[int, int]]]] = []
    for frame, rows in _by_frame(boxes.frames):
        ours = group_by_place(points[rows], weights[rows], boxes.cameras[rows])
        groups[rows] = ours + len(members)
        tracks: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for row, group in zip(rows.tolist(), ours.tolist(), strict=True):
            track = (int(boxes.cameras[row]), int(boxes.persons[row]))
            tracks[group] += [track] if named else []
        members += [(frame, tracks[group]) for group in range(int(ours.max()) + 1)]
    return groups, np.array(link(members), dtype=np.int64)


def _by_frame(frames: Ids) -> list[tuple[int, Ids]]:
    numbers = np.unique(frames)
    order = np.argsort(frames, kind="stable")
    ends = np.searchsorted(frames[order], numbers, side="right")[:-1]
    return list(zip(numbers.tolist(), np.split(order, ends), strict=True)) if len(numbers) else []


def _on_the_ground(boxes: Boxes, cameras: Sequence[Camera]) -> tuple[Floats, Floats]:
    points, weights = np.full((len(boxes), 2), np.nan), np.zeros(len(boxes))
    for number, camera in enumerate(cameras):
        rows = np.flatnonzero(boxes.cameras == number)
        ground, weight = ground_points([camera], boxes.boxes[rows, None])
        points[rows], weights[rows] = ground[:, 0], weight[:, 0]
    return points, weights


def _positions(seen: Floats, stated: Ids, table: RectangleTable, cameras: Sequence[Camera]) -> Ids:
    """Those the file states where the boxes agree, all others from the boxes."""
    positions = stated.max(axis=1)
    believed = ((stated == positions[:, None]) | np.isnan(seen[..., 0])).all(axis=1)
    believed &= (positions >= 0) & (positions < table.grid.count)
    believed[believed] = _stand_there(seen[believed], positions[believed], table)
    others = np.flatnonzero(~believed)
    positions[others] = fuse(table, cameras, seen[others]).positions
    return positions


def _stand_there(seen: Floats, positions: Ids, table: RectangleTable) -> NDArray[np.bool_]:
    rectangles = table.rectangles(positions)[0].astype(np.float64)
    away = np.abs(feet(rectangles) - feet(seen))
    taller = np.abs((seen[..., 3] - seen[..., 1]) - (rectangles[..., 3] - rectangles[..., 1]))
    there = (away[..., 0] <= SAME_FEET + LEAN * taller) & (away[..., 1] <= SAME_FEET)
    return np.logical_and.reduce(there | np.isnan(taller), axis=1)
