"""OpenCV's fisheye model against OpenCV itself, and the rectangles it makes."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.geometry import fisheye
from gtm_hit.geometry.camera import (
    CalibrationError,
    Camera,
    CameraModel,
    back_project,
    normalise,
    project,
    undistort_maps,
    undistorted,
)
from gtm_hit.geometry.cylinder import FootRule, rectangles
from gtm_hit.geometry.table import table_digest
from tests.geometry.footprint import footprint
from tests.geometry.scenes import PERSON, WILDTRACK_GRID, mirrored, wildtrack_cameras

LENS = np.array([0.08, -0.02, 0.004, -0.0006])
FOLDING = np.array([-0.4, 0.0, 0.0, 0.0])  # the radius stops growing at 0.913 radians


def fisheye_camera(distortion: np.ndarray = LENS) -> Camera:
    """Where C1 stands, with 1280×720 pixels and 140° of view."""
    matrix = np.array([[520.0, 0, 640], [0, 520, 360], [0, 0, 1]])
    taken = wildtrack_cameras()[0]
    changes = {"matrix": matrix, "distortion": distortion, "model": CameraModel.FISHEYE}
    return replace(taken, width=1280, height=720, **changes)  # type: ignore[arg-type]


CAMERA = fisheye_camera()


def ground(count: int = 500) -> np.ndarray:
    low = np.array([WILDTRACK_GRID.origin_x, WILDTRACK_GRID.origin_y])
    xy = np.random.default_rng(3).uniform(low, low + WILDTRACK_GRID.extent, (count, 2))
    return np.column_stack((xy, np.zeros(count)))


def before(camera: Camera, points: np.ndarray) -> np.ndarray:
    return points[(points @ camera.rotation.T + camera.tvec)[:, 2] * camera.facing > 0.1]


def test_points_are_projected_as_opencv_does() -> None:
    points = before(CAMERA, ground())
    pose = (CAMERA.rvec, CAMERA.tvec, CAMERA.matrix, CAMERA.distortion)
    expected, _ = cv2.fisheye.projectPoints(points.reshape(-1, 1, 3), *pose)
    assert len(points) > 200
    np.testing.assert_allclose(project(CAMERA, points), expected.reshape(-1, 2), atol=1e-6)


@pytest.mark.parametrize("camera", [CAMERA, mirrored(CAMERA)], ids=["plain", "mirrored"])
def test_a_ground_point_comes_back_from_its_pixel(camera: Camera) -> None:
    points = ground() * ([1, -1, 1] if camera is not CAMERA else [1, 1, 1])
    points = before(camera, points)
    np.testing.assert_allclose(back_project(camera, project(camera, points)), points[:, :2], atol=1e-6)


coefficients = st.lists(st.floats(-0.3, 0.3), min_size=4, max_size=4).map(np.array)


@given(coefficients, st.floats(0, 0.999), st.floats(-np.pi, np.pi))
def test_every_direction_within_the_limit_comes_back(lens: np.ndarray, share: float, turn: float) -> None:
    angle = share * fisheye.limit(lens)
    x, y = np.array([np.tan(angle) * np.cos(turn)]), np.array([np.tan(angle) * np.sin(turn)])
    back = fisheye.undistort(*fisheye.distort(x, y, lens), lens)
    np.testing.assert_allclose(np.arctan(np.hypot(*back)), angle, atol=1e-7)


def test_beyond_the_angle_where_the_radius_stops_growing_nothing_is_seen() -> None:
    assert fisheye.limit(FOLDING) == pytest.approx(np.sqrt(1 / 1.2), abs=1e-3)
    angles = np.array([0.90, 0.92, 1.2])
    x, y = fisheye.distort(np.tan(angles), np.zeros(3), FOLDING)
    assert np.isnan(x).tolist() == np.isnan(y).tolist() == [False, True, True]
    assert np.isnan(fisheye.undistort(np.array([2.0]), np.array([0.0]), FOLDING)[0]).all()


def test_pixels_outside_the_image_circle_show_nothing() -> None:
    corner = normalise(fisheye_camera(np.array([-0.3, 0.0, 0.0, 0.0])), [[0, 0], [640, 360]])
    assert np.isnan(corner).all(axis=1).tolist() == [True, False]


@pytest.mark.parametrize("rule", FootRule)
def test_a_rectangle_is_that_of_the_eight_corners_opencv_projects(rule: FootRule) -> None:
    positions = np.random.default_rng(5).integers(0, WILDTRACK_GRID.count, 2000)
    boxes, visible = rectangles(CAMERA, WILDTRACK_GRID, PERSON, rule, positions)
    assert visible.sum() > 300
    for (x, y), box in zip(WILDTRACK_GRID.metres(positions[visible]), boxes[visible], strict=True):
        r, corners = PERSON.radius, []
        for z in (0.0, PERSON.height):
            corners += [[x + dx, y + dy, z] for dx in (-r, r) for dy in (-r, r)]
        pose = (CAMERA.rvec, CAMERA.tvec, CAMERA.matrix, CAMERA.distortion)
        u, v = cv2.fisheye.projectPoints(np.array([corners]), *pose)[0].reshape(-1, 2).T
        assert np.abs(box[:3] - [u.min(), v.min(), u.max()]).max() < 1.01


def test_people_beyond_the_lens_are_not_visible() -> None:
    positions = np.arange(0, WILDTRACK_GRID.count, 101)
    folding = fisheye_camera(FOLDING)
    _boxes, visible = rectangles(folding, WILDTRACK_GRID, PERSON, FootRule.CORNERS, positions)
    feet = np.column_stack((WILDTRACK_GRID.metres(positions), np.zeros(len(positions))))
    assert visible.any()
    assert not np.isnan(project(folding, feet[visible])).any()


def test_undistorted_images_show_what_the_undistorted_camera_says() -> None:
    target = np.array([[300.0, 0, 640], [0, 300, 360], [0, 0, 1]])
    ideal = undistorted(CAMERA, target)
    assert (ideal.model, ideal.has_lens) == (CameraModel.PINHOLE, False)
    coarse, _fine = undistort_maps(CAMERA, target)
    pixels = np.array([[400, 500], [640, 360], [900, 600]])
    rays = np.column_stack((normalise(ideal, pixels), np.ones(3)))
    world = (rays - CAMERA.tvec) @ CAMERA.rotation
    found = coarse[pixels[:, 1], pixels[:, 0]]
    np.testing.assert_allclose(found, project(CAMERA, world), atol=1)


def test_a_fisheye_sees_a_part_of_the_ground() -> None:
    polygon = footprint(CAMERA, WILDTRACK_GRID)
    assert len(polygon) > 8
    inside = np.abs(polygon - polygon.mean(axis=0)).max()
    assert 1 < inside < 40


def test_the_same_numbers_mean_other_rectangles_in_another_model() -> None:
    usual = replace(CAMERA, model=CameraModel.PINHOLE)
    facts = (WILDTRACK_GRID, PERSON, FootRule.CORNERS)
    assert table_digest([CAMERA], *facts) != table_digest([usual], *facts)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"distortion": np.zeros(5)}, "5 numbers, not the 4 of the fisheye model"),
        ({"model": "spherical"}, "model is 'spherical', not one of pinhole, fisheye"),
    ],
)
def test_an_impossible_model_is_refused_with_the_value_named(changes: dict, reason: str) -> None:
    with pytest.raises(CalibrationError, match=reason):
        replace(CAMERA, **changes)
