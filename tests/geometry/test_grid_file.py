from __future__ import annotations

import gzip
import struct
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gtm_hit.geometry.camera import project
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.grid_file import encode, encode_values, grid_file_digest
from gtm_hit.geometry.table import RectangleTable
from tests.geometry.scenes import PERSON, WILDTRACK_GRID, wildtrack_cameras
from tests.geometry.test_fisheye import CAMERA as FISHEYE

SMALL = Grid(columns=5, rows=4, step=0.5, origin_x=0.0, origin_y=0.0)
CAMERAS = wildtrack_cameras()
INGREDIENTS = (CAMERAS[0], WILDTRACK_GRID, PERSON, FootRule.CORNERS)
MOST_BYTES = 6_000_000  # of WILDTRACK's seven cameras


def decoded(data: bytes) -> np.ndarray:
    """The format word by word, slowly."""
    raw = gzip.decompress(data)
    assert raw[:8] == b"GTMGRID1"
    columns, rows, visible, run_count, exception_count, count = struct.unpack("<6I", raw[8:32])
    numbers = np.frombuffer(raw, "<u4", run_count + exception_count, 32).tolist()
    runs, exceptions = numbers[:run_count], iter(numbers[run_count:])
    planes = np.frombuffer(raw, np.uint8, count * visible, 32 + 4 * len(numbers)).reshape(count, visible)
    seen = np.repeat(np.arange(run_count) % 2 == 1, runs)
    assert seen.size == columns * rows
    boxes = np.zeros((seen.size, count), int)
    for side, plane in enumerate(planes):
        for position, byte in zip(np.flatnonzero(seen), plane.tolist(), strict=True):
            zigzag = next(exceptions) if byte == 255 else byte
            left = position % columns > 0 and seen[position - 1]
            above = boxes[position - columns, side] if position >= columns else 0
            known = boxes[position - 1, side] if left else above
            boxes[position, side] = known + ((zigzag >> 1) ^ -(zigzag & 1))
    return boxes


@st.composite
def tables(draw: st.DrawFn) -> np.ndarray:
    values = draw(arrays(np.int16, (SMALL.count, draw(st.sampled_from((4, 6))))))
    values[:, 2] = np.maximum(values[:, 2], 2)  # a visible box has an xmax above 1
    values[draw(arrays(np.bool_, SMALL.count))] = 0
    return values


@given(tables())
def test_any_numbers_come_back_as_they_were(values: np.ndarray) -> None:
    np.testing.assert_array_equal(decoded(encode_values(values, values[:, 2] > 0, SMALL)), values)


def test_a_fisheyes_file_tells_the_feet_too(wildtrack_table: RectangleTable) -> None:
    grid = Grid(columns=48, rows=144, step=0.25, origin_x=-3.0, origin_y=-9.0)
    boxes, visible = rectangles(FISHEYE, grid, PERSON, FootRule.CORNERS, np.arange(grid.count))
    values = decoded(encode(boxes, FISHEYE, grid))
    np.testing.assert_array_equal(values[:, :4], boxes)
    feet = project(FISHEYE, np.column_stack((grid.metres(np.flatnonzero(visible)), np.zeros(visible.sum()))))
    np.testing.assert_allclose(values[visible, 4:] / 4, feet, atol=0.1251)
    assert not values[~visible].any()


def test_the_same_boxes_give_the_same_bytes(wildtrack_table: RectangleTable) -> None:
    boxes = wildtrack_table.boxes(3)
    assert encode(boxes, CAMERAS[3], WILDTRACK_GRID) == encode(boxes.copy(), CAMERAS[3], WILDTRACK_GRID)


def test_the_files_of_wildtracks_seven_cameras_are_small(wildtrack_table: RectangleTable) -> None:
    sizes = [len(encode(wildtrack_table.boxes(one.index), one, WILDTRACK_GRID)) for one in CAMERAS]
    assert sum(sizes) < MOST_BYTES


@pytest.mark.parametrize(
    "changes",
    [
        {0: replace(INGREDIENTS[0], tvec=INGREDIENTS[0].tvec + 1e-9)},
        {1: replace(WILDTRACK_GRID, columns=481)},
        {2: Cylinder(0.16, 1.81)},
        {3: FootRule.CENTRE},
    ],
)
def test_other_numbers_have_another_address(changes: dict) -> None:
    other = [changes.get(place, one) for place, one in enumerate(INGREDIENTS)]
    assert grid_file_digest(*other) != grid_file_digest(*INGREDIENTS)  # type: ignore[arg-type]


def test_a_cameras_name_and_number_do_not_change_its_address() -> None:
    renamed = replace(INGREDIENTS[0], name="D9", index=8)
    assert grid_file_digest(renamed, *INGREDIENTS[1:]) == grid_file_digest(*INGREDIENTS)
