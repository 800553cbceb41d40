from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from gtm_hit.models import Camera, Dataset
from gtm_hit.ops.ground.coverage import coverage
from gtm_hit.pages.datasets.ground_map import GroundMap
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def tables(tmp_path: Path, settings: Any) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


def drawn(**grid: Any) -> GroundMap:
    make_dataset(frames=1)
    Dataset.objects.update(**grid)
    dataset = Dataset.objects.get()
    return GroundMap(dataset, coverage(dataset))


def test_a_wide_ground_has_x_to_the_right_and_y_upwards() -> None:
    ground = drawn(columns=400, rows=200)
    assert (ground.width, ground.height) == (10, 5)
    assert [(tick.text, round(tick.x, 6)) for tick in ground.across_ticks()][:2] == [("-4", 1.0), ("-2", 3.0)]
    upright = [tick for tick in ground.upright_ticks() if tick.text == "-4"]
    assert upright[0].y > ground.height / 2


def test_a_long_ground_is_turned_without_being_mirrored() -> None:
    ground = drawn(columns=200, rows=400)
    assert (ground.width, ground.height) == (10, 5)
    centre = Camera.objects.get(index=0).calibrated.centre
    marker = ground.cameras[0]
    assert (marker.x, marker.y) == pytest.approx((centre[1] + 5, centre[0] + 5))


def test_cameras_point_to_the_middle_of_what_they_see() -> None:
    ground = drawn(columns=400, rows=200)
    for marker, (x, y) in zip(ground.cameras, ground.coverage.middles, strict=True):
        to_x, to_y = x + 5, ground.height - (y + 5)
        expected = math.degrees(math.atan2(to_y - marker.y, to_x - marker.x))
        assert marker.turn == pytest.approx(expected)


def test_names_of_cameras_in_the_same_place_do_not_cover_each_other() -> None:
    make_dataset(frames=1)
    twin = Camera.objects.get(index=0)
    Camera.objects.filter(index=1).update(rvec=twin.rvec, tvec=twin.tvec)
    dataset = Dataset.objects.get()
    first, second = GroundMap(dataset, coverage(dataset)).cameras
    assert (first.x, first.y) == (second.x, second.y)
    assert abs(first.label_y - second.label_y) > 0


def test_everything_lies_inside_the_drawing() -> None:
    ground = drawn(columns=400, rows=200)
    left, top, width, height = map(float, ground.view_box.split())
    for marker in ground.cameras:
        assert left < marker.x < left + width and top < marker.y < top + height
        assert left < marker.label_x < left + width and top < marker.label_y < top + height


def test_a_camera_far_away_does_not_shrink_the_ground_to_a_dot() -> None:
    make_dataset(frames=1)
    Camera.objects.filter(index=0).update(tvec=[0.0, 0.0, 900.0])
    dataset = Dataset.objects.get()
    width = float(GroundMap(dataset, coverage(dataset)).view_box.split()[2])
    assert width < 3 * 10
