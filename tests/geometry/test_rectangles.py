from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.geometry.camera import Camera, project
from gtm_hit.geometry.cylinder import Cylinder, CylinderError, FootRule, rectangles
from gtm_hit.geometry.grid import Grid, GridError
from tests.geometry.rectangle_cases import PATH
from tests.geometry.reference_rule import reference_rectangles
from tests.geometry.scenes import (
    MULTIVIEWX_GRID,
    PERSON,
    WILDTRACK_GRID,
    enlarged,
    mirrored,
    mirrored_grid,
    multiviewx_cameras,
    wildtrack_cameras,
)

CAMERAS = wildtrack_cameras()
SIDES = ("xmin", "ymin", "xmax", "ymax")

# Rows of the published WILDTRACK annotations: position, view, xmin ymin xmax ymax.
PUBLISHED = [
    (456826, 0, (1510, 139, 1561, 299)),
    (456826, 1, (813, 10, 891, 289)),
    (435095, 0, (1202, 128, 1248, 284)),
    (435095, 1, (1357, 3, 1440, 304)),
    (435095, 5, (429, 121, 463, 255)),
    (435095, 6, (1781, 87, 1899, 323)),
]


def boxes_or_none(boxes: np.ndarray, visible: np.ndarray) -> list:
    return [box if seen else None for box, seen in zip(boxes.tolist(), visible, strict=True)]


@pytest.mark.parametrize(("position", "view", "expected"), PUBLISHED)
def test_published_wildtrack_rows_are_reproduced(position: int, view: int, expected: tuple) -> None:
    boxes, visible = rectangles(CAMERAS[view], WILDTRACK_GRID, PERSON, FootRule.CORNERS, [position])
    assert visible.tolist() == [True]
    assert tuple(boxes[0].tolist()) == expected


def test_every_published_multiviewx_box_and_absence_is_reproduced(shared_data: Path) -> None:
    cameras = multiviewx_cameras(shared_data)
    files = sorted((shared_data / "multiviewx" / "annotations_positions").glob("*.json"))
    people = [person for file in files for person in json.loads(file.read_text())]
    positions = [person["positionID"] for person in people]
    assert len(people) > 100
    for camera in cameras:
        boxes, visible = rectangles(camera, MULTIVIEWX_GRID, PERSON, FootRule.CENTRE, positions)
        boxes[~visible] = -1
        views = [
            next(view for view in person["views"] if view["viewNum"] == camera.index) for person in people
        ]
        assert boxes.tolist() == [[view[side] for side in SIDES] for view in views]


@pytest.mark.parametrize("rule", FootRule)
@pytest.mark.parametrize("original", [False, True], ids=["undistorted", "distorted"])
def test_rectangles_follow_the_rule_word_by_word(rule: FootRule, original: bool) -> None:
    rng = np.random.default_rng(7)
    for camera in wildtrack_cameras(original):
        positions = rng.integers(0, WILDTRACK_GRID.count, 4000)
        boxes, visible = rectangles(camera, WILDTRACK_GRID, PERSON, rule, positions)
        expected = reference_rectangles(camera, WILDTRACK_GRID, PERSON, rule, positions)
        np.testing.assert_array_equal(boxes, expected)
        np.testing.assert_array_equal(visible, expected.any(axis=1))


def test_the_cases_shared_with_the_browser_hold() -> None:
    cases = json.loads(PATH.read_text())
    assert len(cases) > 50
    for case in cases:
        numbers = {key: value for key, value in case["camera"].items() if key != "rotation"}
        grid = {key: value for key, value in case["grid"].items() if key != "origin"}
        origin_x, origin_y = case["grid"]["origin"]
        found = rectangles(
            Camera(**numbers),
            Grid(**grid, origin_x=origin_x, origin_y=origin_y),
            Cylinder(**case["cylinder"]),
            FootRule(case["rule"]),
            case["positions"],
        )
        assert boxes_or_none(*found) == case["rectangles"]


@pytest.mark.parametrize("rule", FootRule)
def test_a_left_handed_pose_sees_the_mirrored_world_alike(rule: FootRule) -> None:
    rng = np.random.default_rng(3)
    for camera in CAMERAS:
        columns, rows = rng.integers(1, 479, 500), rng.integers(1, 1439, 500)
        # Row r of the mirrored grid lies opposite row 1440 - r.
        here = rectangles(camera, WILDTRACK_GRID, PERSON, rule, rows * 480 + columns)
        mirror = mirrored(camera), mirrored_grid(WILDTRACK_GRID)
        there = rectangles(*mirror, PERSON, rule, (1440 - rows) * 480 + columns)
        assert here[1].any()
        # Only the rounding of the mirrored numbers may differ.
        assert (here[0] != there[0]).any(axis=1).mean() < 0.01
        assert np.abs(here[0].astype(int) - there[0])[here[1] & there[1]].max() <= 1


@pytest.mark.parametrize("rule", FootRule)
def test_coordinates_that_do_not_fit_into_int16_are_never_visible(rule: FootRule) -> None:
    camera = enlarged(CAMERAS[0])
    positions = np.random.default_rng(5).integers(0, WILDTRACK_GRID.count, 3000)
    boxes, visible = rectangles(camera, WILDTRACK_GRID, PERSON, rule, positions)
    normal, normally_visible = rectangles(CAMERAS[0], WILDTRACK_GRID, PERSON, rule, positions)
    assert 0 < visible.sum() < normally_visible.sum()
    # Were one wrapped around, it would lie far from the enlarged normal rectangle.
    assert np.abs(boxes[visible].astype(int) - 40 * normal[visible].astype(int)).max() < 100
    assert not visible[(normal > 32767 // 40).any(axis=1)].any()


def test_rectangles_reach_beyond_the_picture_unclipped() -> None:
    boxes, visible = rectangles(
        CAMERAS[0], WILDTRACK_GRID, PERSON, FootRule.CORNERS, np.arange(0, WILDTRACK_GRID.count, 97)
    )
    assert (boxes[visible, 0] < 0).any()
    assert (boxes[visible, 3] > 1080).any()


def test_a_place_behind_the_camera_is_not_visible() -> None:
    grid = Grid(1, 1, 1.0, *(CAMERAS[0].centre[:2] - 5 * CAMERAS[0].rotation[2, :2]).tolist())
    _, visible = rectangles(CAMERAS[0], grid, PERSON, FootRule.CORNERS, [0])
    assert visible.tolist() == [False]


def test_a_cylinder_through_the_camera_plane_is_not_visible() -> None:
    grid = Grid(1, 1, 1.0, *CAMERAS[0].centre[:2].tolist())
    boxes, visible = rectangles(CAMERAS[0], grid, PERSON, FootRule.CORNERS, [0])
    assert (boxes.tolist(), visible.tolist()) == ([[0, 0, 0, 0]], [False])


@given(
    camera=st.sampled_from(CAMERAS + [mirrored(camera) for camera in CAMERAS]),
    rule=st.sampled_from(FootRule),
    radius=st.floats(0.05, 0.5),
    height=st.floats(0.8, 2.2),
    position=st.integers(0, WILDTRACK_GRID.count - 1),
)
def test_visible_rectangles_keep_the_rules_promises(
    camera: Camera, rule: FootRule, radius: float, height: float, position: int
) -> None:
    grid = WILDTRACK_GRID if camera.facing == 1 else mirrored_grid(WILDTRACK_GRID)
    boxes, visible = rectangles(camera, grid, Cylinder(radius, height), rule, [position])
    xmin, ymin, xmax, ymax = boxes[0].tolist()
    if not visible[0]:
        assert (xmin, ymin, xmax, ymax) == (0, 0, 0, 0)
        return
    assert xmin <= xmax and ymin <= ymax
    assert xmin < camera.width - 2 and ymin < camera.height - 2 and xmax >= 1 and ymax >= 1
    assert xmax - xmin <= camera.width // 3
    assert xmax - xmin <= ymax - ymin + 1  # truncating last can take one pixel off
    foot = project(camera, [[*grid.metres([position])[0], 0.0]])[0]
    assert xmin - 1 <= foot[0] <= xmax + 1
    assert ymin - 1 <= foot[1]


@given(position=st.integers(0, WILDTRACK_GRID.count - 1), camera=st.sampled_from(CAMERAS))
def test_a_taller_person_never_has_a_lower_head(position: int, camera: Camera) -> None:
    tops = [
        rectangles(camera, WILDTRACK_GRID, Cylinder(0.16, height), FootRule.CORNERS, [position])
        for height in (1.5, 1.9)
    ]
    if all(visible[0] for _, visible in tops):
        assert tops[1][0][0, 1] <= tops[0][0][0, 1]


def test_one_call_gives_what_many_calls_give() -> None:
    positions = np.random.default_rng(1).integers(0, WILDTRACK_GRID.count, 20_000)
    together, _ = rectangles(CAMERAS[5], WILDTRACK_GRID, PERSON, FootRule.CORNERS, positions)
    apart = [
        rectangles(CAMERAS[5], WILDTRACK_GRID, PERSON, FootRule.CORNERS, position)[0]
        for position in positions[:300]
    ]
    np.testing.assert_array_equal(together[:300], np.concatenate(apart))


def test_no_positions_give_no_rectangles() -> None:
    boxes, visible = rectangles(CAMERAS[0], WILDTRACK_GRID, PERSON, FootRule.CORNERS, [])
    assert (boxes.shape, visible.shape) == ((0, 4), (0,))


def test_a_position_off_the_grid_is_refused() -> None:
    with pytest.raises(GridError, match="-1"):
        rectangles(CAMERAS[0], WILDTRACK_GRID, PERSON, FootRule.CORNERS, [5, -1])


@pytest.mark.parametrize("size", [(0.0, 1.8), (0.16, -1.0), (np.nan, 1.8), (0.16, np.inf)])
def test_an_impossible_cylinder_is_refused(size: tuple[float, float]) -> None:
    with pytest.raises(CylinderError, match="positive number of metres"):
        Cylinder(*size)
