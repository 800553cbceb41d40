"""Positions out of boxes: exact where the boxes are the table's, near where they only resemble them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.fusion import feet, fuse, ground_points
from gtm_hit.geometry.table import RectangleTable
from tests.dataset_folder import CYLINDER, GRID, cameras

CAMERAS = cameras()


@pytest.fixture(scope="module", params=list(FootRule))
def table(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> RectangleTable:
    folder: Path = tmp_path_factory.mktemp("tables")
    return RectangleTable.build(folder, CAMERAS, GRID, CYLINDER, request.param)


def boxes_of(table: RectangleTable, positions: np.ndarray) -> np.ndarray:
    boxes, visible = table.rectangles(positions)
    return np.where(visible[..., None], boxes.astype(float), np.nan)


def everywhere(table: RectangleTable, least_views: int) -> np.ndarray:
    positions = np.arange(GRID.count)
    return positions[table.rectangles(positions)[1].sum(axis=1) >= least_views]


def inside(table: RectangleTable, least_views: int) -> np.ndarray:
    """Not at the border, where a pixel decides who is on the grid."""
    positions = everywhere(table, least_views)
    rows, columns = np.divmod(positions, GRID.columns)
    near = np.minimum(np.minimum(rows, GRID.rows - 1 - rows), np.minimum(columns, GRID.columns - 1 - columns))
    return positions[near >= 6]


def test_exact_boxes_in_two_views_give_every_position_back(table: RectangleTable) -> None:
    positions = everywhere(table, 2)
    assert len(positions) > 1000
    found = fuse(table, CAMERAS, boxes_of(table, positions))
    away = np.hypot(*(GRID.metres(found.positions) - GRID.metres(positions)).T)
    assert (away == 0).mean() > 0.99
    # The others have the very same rectangles as their neighbour.
    equal = boxes_of(table, found.positions[away > 0]), boxes_of(table, positions[away > 0])
    seen = ~np.isnan(equal[1])
    assert np.array_equal(equal[0][seen], equal[1][seen])


def test_one_view_is_enough_to_find_rectangles_that_are_the_box(table: RectangleTable) -> None:
    positions = everywhere(table, 1)[::7]
    boxes = boxes_of(table, positions)
    first = np.argmin(np.isnan(boxes[..., 0]), axis=1)
    others = np.arange(len(CAMERAS)) != first[:, None]
    boxes[others] = np.nan
    found = fuse(table, CAMERAS, boxes)
    again, _ = table.rectangles(found.positions)
    rows = np.arange(len(positions))
    assert (again[rows, first] == boxes[rows, first]).all(axis=1).mean() > 0.99


def test_people_of_another_height_are_found_where_they_stand() -> None:
    positions = inside(corners(), 2)[::5]
    boxes = np.full((len(positions), len(CAMERAS), 4), np.nan)
    for number, camera in enumerate(CAMERAS):
        sides, visible = rectangles(camera, GRID, Cylinder(0.16, 1.3), FootRule.CORNERS, positions)
        boxes[visible, number] = sides[visible]
    known = (~np.isnan(boxes[..., 0])).sum(axis=1) >= 2
    found = fuse(corners(), CAMERAS, boxes[known])
    away = np.hypot(*(GRID.metres(found.positions) - GRID.metres(positions[known])).T)
    assert known.sum() > 100
    assert away.max() <= GRID.step + 1e-9


@given(noise=st.floats(0, 2), seed=st.integers(0, 2**16))
@settings(max_examples=20)
def test_noise_of_pixels_moves_people_by_centimetres(noise: float, seed: int) -> None:
    table = corners()
    positions = inside(table, 3)[::20]
    rng = np.random.default_rng(seed)
    boxes = boxes_of(table, positions)
    boxes += rng.uniform(-noise, noise, boxes.shape)
    found = fuse(table, CAMERAS, boxes)
    away = np.hypot(*(GRID.metres(found.positions) - GRID.metres(positions)).T)
    assert away.max() <= 0.1 + 0.15 * noise


_KEPT: list[RectangleTable] = []


@pytest.fixture(autouse=True, scope="module")
def kept_table(tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("corners")
    _KEPT.append(RectangleTable.build(folder, CAMERAS, GRID, CYLINDER, FootRule.CORNERS))


def corners() -> RectangleTable:
    return _KEPT[-1]


def test_what_shows_no_ground_has_no_position() -> None:
    boxes = np.full((2, len(CAMERAS), 4), np.nan)
    boxes[1, 0] = (100, -400, 120, -300)  # above the horizon
    assert fuse(corners(), CAMERAS, boxes).positions.tolist() == [-1, -1]


def test_what_stands_far_off_the_grid_has_no_position() -> None:
    boxes = np.full((1, len(CAMERAS), 4), np.nan)
    boxes[0, 0] = (150, 60, 154, 71)
    found = fuse(corners(), CAMERAS, boxes)
    assert found.positions.tolist() == [-1]
    assert found.xy[0, 1] > GRID.metres([GRID.count - 1])[0, 1] + 1


def test_nobody_is_nobody() -> None:
    assert len(fuse(corners(), CAMERAS, np.empty((0, 3, 4))).positions) == 0


def test_near_views_count_more() -> None:
    position = np.array([GRID.columns * 5 + 40])  # close to the first camera
    _points, weights = ground_points(CAMERAS, boxes_of(corners(), position))
    distances = [np.hypot(*(GRID.metres(position)[0] - camera.centre[:2])) for camera in CAMERAS]
    seen = np.flatnonzero(weights[0])
    assert np.argmax(weights[0]) == min(seen, key=lambda camera: distances[camera])


def test_feet_are_the_middle_of_the_lower_side() -> None:
    assert feet(np.array([10, 20, 30, 90])).tolist() == [20.0, 90.0]
