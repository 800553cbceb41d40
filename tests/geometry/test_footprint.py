from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from gtm_hit.geometry.camera import Camera, project
from gtm_hit.geometry.grid import Grid
from tests.geometry.footprint import footprint
from tests.geometry.scenes import WILDTRACK_GRID, mirrored, mirrored_grid, wildtrack_cameras


def seen_on_grid(camera: Camera, grid: Grid, points: np.ndarray) -> np.ndarray:
    depths = (points @ camera.rotation.T + camera.tvec)[:, 2] * camera.facing
    pixels = project(camera, points)
    inside = ((pixels > -0.5) & (pixels < (camera.width - 0.5, camera.height - 0.5))).all(axis=1)
    return inside & (depths > 0)


@pytest.mark.parametrize("camera", wildtrack_cameras() + [mirrored(each) for each in wildtrack_cameras()])
def test_a_ground_point_is_in_the_footprint_exactly_when_it_is_in_the_picture(camera: Camera) -> None:
    grid = WILDTRACK_GRID if camera.facing == 1 else mirrored_grid(WILDTRACK_GRID)
    low = np.array([grid.origin_x, grid.origin_y])
    xy = np.random.default_rng(2).uniform(low, low + grid.extent, (2000, 2))
    polygon = footprint(camera, grid).astype(np.float32)
    distances = np.array([cv2.pointPolygonTest(polygon, point, True) for point in xy.astype(float)])
    expected = seen_on_grid(camera, grid, np.column_stack((xy, np.zeros(len(xy)))))
    clear = np.abs(distances) > 1e-3
    np.testing.assert_array_equal((distances > 0)[clear], expected[clear])


def test_a_footprint_follows_the_bent_border_of_a_distorted_picture() -> None:
    camera = wildtrack_cameras(original=True)[6]
    outline = footprint(camera, WILDTRACK_GRID)
    pixels = project(camera, np.column_stack((outline, np.zeros(len(outline)))))
    on_border = np.minimum(np.abs(pixels + 0.5), np.abs(pixels - (1919.5, 1079.5))).min(axis=1) < 1e-3
    low = np.array([-3.0, -9.0])
    on_grid = np.minimum(np.abs(outline - low), np.abs(outline - low - (12, 36))).min(axis=1) < 1e-9
    assert len(outline) > 20
    assert (on_border | on_grid).all()


def test_a_camera_that_looks_away_has_no_footprint() -> None:
    away = Grid(10, 10, 0.1, *(wildtrack_cameras()[0].centre[:2] - 50.0).tolist())
    assert footprint(wildtrack_cameras()[0], away).shape == (0, 2)


def test_a_camera_that_looks_up_has_no_footprint() -> None:
    camera = wildtrack_cameras()[0]
    up = cv2.Rodrigues(np.array([-1.2, 0.0, 0.0]))[0] @ camera.rotation
    looking_up = replace(camera, rvec=cv2.Rodrigues(up)[0], tvec=-up @ camera.centre)
    assert footprint(looking_up, WILDTRACK_GRID).shape == (0, 2)
