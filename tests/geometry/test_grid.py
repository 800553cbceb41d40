from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.geometry.grid import Grid, GridError
from tests.geometry.scenes import WILDTRACK_GRID

grids = st.builds(
    Grid,
    columns=st.integers(1, 2000),
    rows=st.integers(1, 2000),
    step=st.floats(0.005, 2.0),
    origin_x=st.floats(-50, 50),
    origin_y=st.floats(-50, 50),
)


def test_published_position_456826_is_5_65_by_14_775_metres() -> None:
    # 456826 = 951 · 480 + 346; X = -3 + 0.025 · 346, Y = -9 + 0.025 · 951
    np.testing.assert_allclose(WILDTRACK_GRID.metres([456826]), [[5.65, 14.775]], atol=1e-12)


def test_the_grid_covers_12_by_36_metres() -> None:
    assert WILDTRACK_GRID.count == 691_200
    assert WILDTRACK_GRID.extent == (12.0, 36.0)


@given(grids, st.data())
def test_the_position_nearest_to_a_positions_metres_is_itself(grid: Grid, data: st.DataObject) -> None:
    position = data.draw(st.integers(0, grid.count - 1))
    assert grid.position(grid.metres([position])).tolist() == [position]


@given(grids, st.floats(-200, 200), st.floats(-200, 200))
def test_the_nearest_position_is_on_the_grid_and_agrees_inside(grid: Grid, x: float, y: float) -> None:
    position, nearest = grid.position([[x, y]])[0], grid.nearest([[x, y]])[0]
    assert grid.contains(nearest)
    assert position in (-1, nearest)


def test_points_half_a_step_outside_have_no_position() -> None:
    points = [[-3.0124, -9.0], [-3.0126, -9.0], [8.987, 0.0], [8.988, 0.0], [0.0, 26.988]]
    assert (WILDTRACK_GRID.position(points) >= 0).tolist() == [True, False, True, False, False]


def test_nan_has_neither_a_position_nor_a_nearest_one() -> None:
    assert WILDTRACK_GRID.position([[np.nan, 0.0]]).tolist() == [-1]
    assert WILDTRACK_GRID.nearest([[0.0, np.nan]]).tolist() == [-1]


def test_far_points_are_clamped_to_the_border() -> None:
    assert WILDTRACK_GRID.nearest([[-99.0, -99.0], [np.inf, np.inf]]).tolist() == [0, 691_199]


@pytest.mark.parametrize(
    "wrong", [{"columns": 0}, {"rows": -1}, {"step": 0.0}, {"step": np.nan}, {"origin_x": np.inf}]
)
def test_an_impossible_grid_is_refused(wrong: dict) -> None:
    facts = {"columns": 2, "rows": 2, "step": 1.0, "origin_x": 0.0, "origin_y": 0.0}
    with pytest.raises(GridError, match=next(iter(wrong)).removesuffix("_x")):
        Grid(**{**facts, **wrong})


def test_a_position_off_the_grid_is_named() -> None:
    with pytest.raises(GridError, match="691200"):
        WILDTRACK_GRID.check(np.array([0, 691_200]))
