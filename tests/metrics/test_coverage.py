from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.annotations import MetricsError
from gtm_hit.metrics.coverage import chosen_positions, coverage

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
SMALL = Grid(columns=5, rows=3, step=0.5, origin_x=0.0, origin_y=0.0)


def test_every_other_position_along_both_axes_begins_with_position_0() -> None:
    assert chosen_positions(SMALL, 2).tolist() == [[0, 2, 4], [10, 12, 14]]


def test_positions_are_counted_by_how_many_cameras_see_them() -> None:
    first, second = np.zeros(15, dtype=bool), np.zeros(15, dtype=bool)
    first[:5], second[4:6] = True, True
    seen = coverage(SMALL, [first, second])
    assert seen.seen_by.tolist() == [[1, 1, 1, 1, 2], [1, 0, 0, 0, 0], [0, 0, 0, 0, 0]]
    assert seen.counts.tolist() == [9, 5, 1]
    assert seen.mean == pytest.approx(7 / 15)


def test_cameras_may_come_one_at_a_time() -> None:
    assert coverage(SMALL, (np.ones(15, dtype=bool) for _ in range(3))).counts.tolist() == [0, 0, 0, 15]


def test_visibility_of_another_grid_is_refused() -> None:
    with pytest.raises(MetricsError, match=r"shape \(14,\), not \(15,\)"):
        coverage(SMALL, [np.ones(14, dtype=bool)])


def test_a_step_below_one_is_refused() -> None:
    with pytest.raises(MetricsError, match="every must be 1 or more, not 0"):
        chosen_positions(SMALL, 0)


def test_the_published_wildtrack_calibration_covers_its_grid_as_known() -> None:
    """Every eighth position from position 0 on; the paper has nearly these, of another calibration state."""
    grid = Grid(480, 1440, 0.025, -3.0, -9.0)
    chosen = chosen_positions(grid, 8).ravel()
    visible = np.zeros((7, grid.count), dtype=bool)
    for camera in load_cameras(FIXTURES / "wildtrack_cameras.json"):
        _, seen = rectangles(camera, grid, Cylinder(0.16, 1.80), FootRule.CORNERS, chosen)
        visible[camera.index, chosen] = seen
    result = coverage(grid, visible, every=8)
    assert result.seen_by.size == 10_800
    assert result.counts.tolist() == [0, 77, 2481, 2458, 1625, 1735, 2095, 329]
    assert result.mean == pytest.approx(3.93, abs=0.005)
