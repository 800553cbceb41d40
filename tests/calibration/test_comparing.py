"""How two calibrations differ: numbers that are known because they were put there."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from gtm_hit.calibration.comparing import OtherCameras, cells_of, compare_cameras, ground_shift
from gtm_hit.calibration.shift_map import EDGES, bands
from gtm_hit.geometry.camera import Camera, fold, project
from gtm_hit.geometry.grid import Grid
from tests.dataset_folder import GRID, cameras


def moved(camera: Camera, by: tuple[float, float, float]) -> Camera:
    """The camera carried along, looking as before."""
    return replace(camera, tvec=-camera.rotation @ (camera.centre + by))


def turned(camera: Camera, *degrees: float) -> Camera:
    """The camera turned about its own axes where it stands."""
    turn = cv2.Rodrigues(np.radians(degrees))[0] @ camera.rotation
    return replace(camera, rvec=cv2.Rodrigues(turn)[0], tvec=-turn @ camera.centre)


def with_first(camera: Camera) -> list[Camera]:
    return [camera, *cameras()[1:]]


def test_the_same_cameras_do_not_differ() -> None:
    change = compare_cameras(cameras(), cameras(), GRID)
    assert [(each.moved, each.turned, each.distortion) for each in change.cameras] == [(0, 0, 0)] * 3
    assert np.nanmax(change.worst) < 1e-6


def test_a_camera_that_was_carried_along_the_ground_shifts_all_of_it_by_as_much() -> None:
    change = compare_cameras(cameras(), with_first(moved(cameras()[0], (0.03, 0.04, 0.0))), GRID)
    first, second, third = change.cameras
    assert first.moved == pytest.approx(5.0) and first.centre == pytest.approx((3.0, 4.0, 0.0))
    assert first.turned == pytest.approx(0.0, abs=1e-6)
    ground = first.ground
    assert ground.seen > 1000 and (ground.median, ground.most) == pytest.approx((5.0, 5.0))
    assert second.moved == third.moved == 0.0 and second.ground.most == pytest.approx(0.0, abs=1e-6)
    assert np.nanmax(change.worst) == pytest.approx(5.0)


def test_a_camera_that_was_turned_says_by_how_much_and_stays_where_it_is() -> None:
    new = turned(cameras()[0], 0.0, 0.0, 0.25)
    first = compare_cameras(cameras(), with_first(new), GRID).cameras[0]
    assert first.turned == pytest.approx(0.25) and first.moved == pytest.approx(0.0, abs=1e-9)


def test_the_shift_is_where_the_new_camera_puts_the_old_pixel() -> None:
    old = cameras()[0]
    new = moved(old, (0.0, 0.1, 0.2))
    point = np.array([[0.5, 0.5, 0.0]])
    found = point[0, :2] + 0.0
    # The ground point whose new pixel is the old one of `point`, by search.
    for _ in range(30):
        off = (project(old, point) - project(new, [[*found, 0.0]]))[0]
        step = np.stack(
            [
                (project(new, [[*(found + each), 0.0]]) - project(new, [[*found, 0.0]]))[0] / 1e-5
                for each in np.eye(2) * 1e-5
            ],
            axis=1,
        )
        found = found + np.linalg.solve(step, off)
    expected = 100 * np.linalg.norm(found - point[0, :2])
    assert expected > 1 and ground_shift(old, new, point)[0] == pytest.approx(expected, abs=1e-6)


def test_ground_the_camera_does_not_see_has_no_shift() -> None:
    behind = np.add(cameras()[0].centre, [0.0, -5.0, 0.0])
    aside = (200.0, 0.0, 0.0)
    points = np.array([[*behind[:2], 0.0], aside])
    assert np.isnan(ground_shift(cameras()[0], cameras()[0], points)).all()


def test_ground_beyond_the_fold_of_a_lens_has_no_shift() -> None:
    folded = replace(cameras()[0], distortion=np.array([-3.0, 0.0, 0.0, 0.0, 0.0]))
    x, y, depth = (GRID.metres(np.arange(GRID.count)) @ folded.rotation[:, :2].T + folded.tvec).T
    radius = np.hypot(x / depth, y / depth)
    beyond = radius > fold(folded)
    points = np.column_stack((GRID.metres(np.arange(GRID.count)), np.zeros(GRID.count)))
    shift = ground_shift(folded, folded, points)
    assert beyond.any() and np.isnan(shift[beyond]).all()
    assert np.nanmax(shift[radius < 0.9 * fold(folded)]) < 1e-3


def test_pixels_that_show_no_ground_any_more_are_counted_and_no_number() -> None:
    """Turned up until the horizon lies within what showed ground before."""
    old = cameras()[0]
    ground = compare_cameras([old], [turned(old, -32.0, 0.0, 0.0)], GRID).cameras[0].ground
    assert 0 < ground.lost < ground.seen
    assert ground.most is not None and np.isfinite(ground.most)


def test_distortion_is_told_apart_from_focal_length_and_principal_point() -> None:
    old = cameras()[0]
    matrix = np.add(old.matrix, [[3.0, 0, 5.0], [0, 3.0, -4.0], [0, 0, 0]])
    longer = compare_cameras([old], [replace(old, matrix=matrix)], GRID).cameras[0]
    assert longer.distortion == 0.0
    bent = compare_cameras([old], [replace(old, distortion=[0.1, 0, 0, 0, 0])], GRID).cameras[0]
    x, y = old.matrix[0, 2] / old.matrix[0, 0], old.matrix[1, 2] / old.matrix[1, 1]
    r = np.hypot(x, y)  # the corner is farthest out
    assert bent.distortion == pytest.approx(0.1 * r**3 * 300.0, rel=0.01)


def test_other_cameras_are_refused_by_name() -> None:
    others = [replace(camera, name=f"X{camera.name}") for camera in cameras()]
    with pytest.raises(OtherCameras, match=r"cameras C1, C2, C3, the other XC1"):
        compare_cameras(cameras(), others, GRID)
    with pytest.raises(OtherCameras, match="C1 have 320×240 pixels in one, 640×240"):
        compare_cameras(cameras(), with_first(replace(cameras()[0], width=640)), GRID)


# The map


@pytest.mark.parametrize("grid", [Grid(480, 1440, 0.025, -3.0, -9.0), Grid(1000, 7, 0.1, 0.0, 0.0), GRID])
def test_cells_cover_the_ground_once(grid: Grid) -> None:
    cells = cells_of(grid)
    assert max(cells.columns, cells.rows) <= 120
    found = bands(np.zeros((cells.rows, cells.columns)), cells)
    assert [band.cells for band in found] == [cells.columns * cells.rows, *[0] * len(EDGES)]
    assert area(found[0].path) == pytest.approx(grid.extent[0] * grid.extent[1])


def area(path: str) -> float:
    """Of rectangles `M x y H right V bottom H left Z`."""
    total = 0.0
    for part in path.removesuffix("Z").split("Z"):
        left, top = (float(word) for word in part[1 : part.index("H")].split())
        right = float(part[part.index("H") + 1 : part.index("V")])
        bottom = float(part[part.index("V") + 1 : part.rindex("H")])
        assert right > left and bottom > top
        total += (right - left) * (bottom - top)
    return total


def test_a_cell_is_drawn_where_the_map_has_it() -> None:
    """X runs to the right and Y upwards; a ground longer along Y is turned: Y to the right, X downwards."""
    wide, long = Grid(4, 2, 1.0, 0.0, 0.0), Grid(2, 4, 1.0, 0.0, 0.0)
    cm = np.full((2, 4), np.nan)
    cm[0, 3] = 3.0
    assert [band.path for band in bands(cm, cells_of(wide)) if band.path] == ["M3 1H4V2H3Z"]
    assert [band.path for band in bands(cm.T, cells_of(long)) if band.path] == ["M3 0H4V1H3Z"]


def test_a_shift_belongs_to_the_class_that_begins_with_it_and_what_is_lost_to_the_last() -> None:
    cm = np.array([[0.0, 0.5, 1.99, 2.0], [50.0, np.inf, np.nan, 6.0]])
    found = bands(cm, cells_of(Grid(4, 2, 1.0, 0.0, 0.0)))
    assert [band.cells for band in found] == [1, 1, 1, 1, 1, 0, 0, 2]
    assert sum(band.percent for band in found) == pytest.approx(100)
