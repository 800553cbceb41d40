from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.demo.loft import Part, box, normals
from gtm_hit.demo.scene import Area
from gtm_hit.demo.shadows import SunMap, beam
from gtm_hit.demo.splat import Mesh

SUN = (-0.6, 0.0, 0.8)  # from the west; shadows are 3/4 as long as things are tall, towards the east
AREA = Area(-5.0, 5.0, -5.0, 5.0)


def post(height: float) -> Mesh:
    axes = np.eye(3)
    points = box(np.array([0, 0, height / 2]), axes[1], axes[0], axes[2], (0.1, 0.1, height / 2))
    directions = normals(points).reshape(-1, 3)
    parts = (Part(points, np.ones((2, 2, 3), np.float32)),)
    return Mesh(parts, points.reshape(-1, 3), directions, np.ones((len(directions), 3), np.float32))


@pytest.fixture
def sun_map() -> SunMap:
    made = SunMap(AREA, 0.02, SUN)
    made.add(post(2.0))
    return made


def hidden_at(sun_map: SunMap, x: float, y: float) -> float:
    column, row = sun_map.cells(np.array([x, y])).astype(int)
    return float(sun_map.soft_mask(0.01, 0.03)[row, column])


def test_a_post_shades_the_ground_away_from_the_sun(sun_map: SunMap) -> None:
    for x in (0.2, 0.8, 1.4):
        assert hidden_at(sun_map, x, 0.0) > 0.95


@pytest.mark.parametrize("place", [(1.75, 0.0), (-0.3, 0.0), (0.8, 0.25), (0.8, -0.25)])
def test_the_sun_reaches_the_ground_beyond_the_shadow(sun_map: SunMap, place: tuple[float, float]) -> None:
    assert hidden_at(sun_map, *place) < 0.05


def test_points_on_one_beam_meet_the_ground_in_one_place() -> None:
    start = np.array([0.4, 1.0, 0.2])
    points = start + np.outer([0, 1, 2], SUN)
    assert np.allclose(beam(points, SUN), beam(start, SUN))


def test_what_stands_in_the_shadow_is_dark_and_what_rises_out_of_it_is_not(sun_map: SunMap) -> None:
    lit = sun_map.reaches(np.array([[0.75, 0.0, 0.3], [0.75, 0.0, 1.6], [-1.0, 0.0, 0.3]]))
    assert lit.tolist() == [0.0, 1.0, 1.0]


def test_the_side_that_the_sun_sees_does_not_shade_itself(sun_map: SunMap) -> None:
    west = np.array([[-0.1, 0.0, 0.6], [-0.1, 0.03, 1.4]])
    assert sun_map.reaches(west).min() > 0.75


def test_what_is_outside_the_map_is_left_out() -> None:
    small = SunMap(Area(20.0, 21.0, 20.0, 21.0), 0.02, SUN)
    small.add(post(2.0))
    assert (small.top == -1).all()


def test_edges_are_softer_the_higher_what_casts_them(sun_map: SunMap) -> None:
    mask = sun_map.soft_mask(0.01, 0.06)
    foot, tip = (mask[:, sun_map.cells(np.array([x, 0.0]))[0].astype(int)] for x in (0.2, 1.3))
    assert np.abs(np.diff(foot)).max() > 1.5 * np.abs(np.diff(tip)).max()
