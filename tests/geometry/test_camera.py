from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.geometry.camera import (
    CalibrationError,
    Camera,
    back_project,
    normalise,
    project,
    undistort_maps,
    undistorted,
)
from tests.geometry.scenes import mirrored, wildtrack_cameras

C1 = wildtrack_cameras()[0]
C1_WITH_LENS = wildtrack_cameras(original=True)[0]
CAMERAS = [*wildtrack_cameras(), *wildtrack_cameras(original=True), *map(mirrored, wildtrack_cameras())]

# OpenCV's coefficients in full: radial, tangential, rational, thin prism, tilt.
FULL_LENS = np.array([-0.3, 0.1, 1e-3, -2e-3, 0.01, 0.02, 0.03, 0.01, 1e-3, 2e-3, -1e-3, 3e-3, 0.05, -0.03])


def replaced(**changes: object) -> Camera:
    return replace(C1, **changes)  # type: ignore[arg-type]


def with_entry(row: int, column: int, value: float) -> np.ndarray:
    matrix = C1.matrix.copy()
    matrix[row, column] = value
    return matrix


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"width": 0}, "0×1080"),
        ({"matrix": with_entry(0, 0, 0.0)}, "focal lengths must be positive"),
        ({"matrix": with_entry(1, 1, -5.0)}, "focal lengths must be positive"),
        ({"matrix": with_entry(0, 1, 0.1)}, "matrix must read"),
        ({"matrix": with_entry(2, 2, 2.0)}, "matrix must read"),
        ({"matrix": with_entry(0, 2, np.nan)}, "matrix holds a number that is not finite"),
        ({"matrix": np.eye(4)}, r"matrix has shape \(4, 4\)"),
        ({"rvec": np.zeros(4)}, r"rvec has shape \(4,\)"),
        ({"tvec": np.array([0, 0, np.inf])}, "tvec holds a number that is not finite"),
        ({"tvec": ["a", "b", "c"]}, "tvec is not an array of numbers"),
        ({"distortion": np.zeros(6)}, "distortion has 6 numbers"),
    ],
)
def test_an_impossible_calibration_is_refused_with_the_value_named(changes: dict, reason: str) -> None:
    with pytest.raises(CalibrationError, match=f"C1: .*{reason}" if "×" not in reason else reason):
        replaced(**changes)


def test_column_vectors_are_read_as_vectors() -> None:
    assert replaced(tvec=[[1.0], [2.0], [3.0]]).tvec.tolist() == [1.0, 2.0, 3.0]


def test_calibration_numbers_cannot_be_changed_afterwards() -> None:
    with pytest.raises(ValueError, match="read-only"):
        C1.tvec[0] = 0


@pytest.mark.parametrize("count", [4, 5, 8, 12, 14])
def test_projection_agrees_with_opencv_for_every_length_of_distortion(count: int) -> None:
    camera = replaced(distortion=FULL_LENS[:count])
    points = np.random.default_rng(count).uniform((0, 3, 0), (6, 20, 2), (500, 3))
    expected, _ = cv2.projectPoints(points, camera.rvec, camera.tvec, camera.matrix, camera.distortion)
    np.testing.assert_allclose(project(camera, points), expected[:, 0], rtol=0, atol=1e-9)


def test_points_in_the_camera_plane_have_no_pixel() -> None:
    camera = replaced(rvec=np.zeros(3), tvec=np.zeros(3))
    assert np.isnan(project(camera, [[1.0, 1.0, 0.0]])).all()


def test_published_cameras_stand_around_the_square_at_their_measured_heights() -> None:
    heights = [camera.centre[2] for camera in wildtrack_cameras()]
    assert all(1.5 < height < 3.5 for height in heights)


def test_cameras_see_positive_depths_and_mirrored_poses_negative_ones() -> None:
    assert [camera.facing for camera in wildtrack_cameras()] == [1] * 7
    assert [mirrored(camera).facing for camera in wildtrack_cameras()] == [-1] * 7


@pytest.mark.parametrize("roll", [0.0, 0.7, 2.0, np.pi])
def test_a_camera_looking_straight_down_sees_the_ground(roll: float) -> None:
    down = cv2.Rodrigues(np.array([np.pi, 0.0, 0.0]))[0] @ cv2.Rodrigues(np.array([0.0, 0.0, roll]))[0]
    camera = replaced(rvec=cv2.Rodrigues(down)[0], tvec=np.array([0.0, 0.0, 5.0]))
    middle = [[camera.matrix[0, 2], camera.matrix[1, 2]]]
    np.testing.assert_allclose(back_project(camera, middle), [[0.0, 0.0]], atol=1e-9)


@given(
    camera=st.sampled_from(CAMERAS),
    u=st.floats(0, 1919),
    v=st.floats(0, 1079),
    z=st.floats(0, 1.2),
)
def test_projecting_what_a_pixel_shows_gives_the_pixel_back(
    camera: Camera, u: float, v: float, z: float
) -> None:
    ground = back_project(camera, [[u, v]], z)
    if not np.isnan(ground).any():
        point = np.append(ground[0], z)
        depth = (camera.rotation @ point + camera.tvec)[2]
        assert depth * camera.facing > 0
        # Near the horizon a pixel covers kilometres: the error is measured in pixels.
        np.testing.assert_allclose(project(camera, [point]), [[u, v]], atol=1e-5)


@given(
    camera=st.sampled_from([each for each in CAMERAS if each.facing == 1]),
    x=st.floats(-3, 9),
    y=st.floats(-9, 27),
)
def test_back_projecting_what_is_in_the_picture_gives_the_ground_point_back(
    camera: Camera, x: float, y: float
) -> None:
    seen = camera.rotation @ (x, y, 0.0) + camera.tvec
    pixel = project(camera, [[x, y, 0.0]])
    in_picture = np.all((pixel >= 0) & (pixel < (camera.width, camera.height)))
    # Radius 0.75 is past the corners of every picture and before any of the lenses folds back.
    if seen[2] > 0.5 and np.hypot(seen[0], seen[1]) < 0.75 * seen[2] and in_picture:
        np.testing.assert_allclose(back_project(camera, pixel), [[x, y]], atol=1e-6)


def test_pixels_above_the_horizon_show_no_ground() -> None:
    assert np.isnan(back_project(C1, [[960.0, 0.0], [0.0, -500.0]])).all()


def test_back_projection_at_the_height_of_a_head_finds_the_same_person() -> None:
    head = project(C1, [[4.0, 10.0, 1.75]])
    np.testing.assert_allclose(back_project(C1, head, z=1.75), [[4.0, 10.0]], atol=1e-9)


def test_the_corner_of_a_picture_that_a_strong_lens_cannot_reach_is_no_direction() -> None:
    assert np.isnan(normalise(C1_WITH_LENS, [[1919.0, 1079.0]])).all()
    assert not np.isnan(normalise(C1_WITH_LENS, [[960.0, 540.0]])).any()


def test_undistorting_a_picture_moves_a_mark_where_the_undistorted_camera_projects_it() -> None:
    u, v = 1650, 900
    mark = np.append(back_project(C1_WITH_LENS, [[u, v]])[0], 0.0)[None]
    picture = np.zeros((1080, 1920), np.uint8)
    picture[v - 3 : v + 4, u - 3 : u + 4] = 255
    maps = undistort_maps(C1_WITH_LENS, C1.matrix)
    rows, columns = np.nonzero(cv2.remap(picture, *maps, cv2.INTER_LINEAR) > 128)
    found = np.array([columns.mean(), rows.mean()])
    expected = project(undistorted(C1_WITH_LENS, C1.matrix), mark)[0]
    assert np.abs(found - expected).max() < 1.0
    assert np.abs(found - (u, v)).max() > 3.0


def test_the_undistorted_original_cameras_are_the_cameras_of_the_undistorted_pictures() -> None:
    for original, zero in zip(wildtrack_cameras(original=True), wildtrack_cameras(), strict=True):
        assert undistorted(original, zero.matrix).as_json() == zero.as_json()


def test_every_pixel_of_the_published_lenses_goes_to_its_direction_and_back_or_has_none() -> None:
    """OpenCV's own inverse with its usual five steps is off by up to 81 pixels in these pictures."""
    for camera in wildtrack_cameras(original=True):
        pixels = np.stack(np.meshgrid(np.arange(0.0, 1920, 12), np.arange(0.0, 1080, 12)), -1).reshape(-1, 2)
        directions = normalise(camera, pixels)
        known = np.isfinite(directions).all(axis=1)
        rays = np.column_stack((directions[known], np.ones(known.sum())))
        back = project(replace(camera, rvec=np.zeros(3), tvec=np.zeros(3)), rays)
        assert known.mean() > 0.97
        assert np.abs(back - pixels[known]).max() < 1e-5
