from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.demo.ground import Floor, Spot, box_cover, stripes
from gtm_hit.demo.scene import Scene

NUMBERS = np.linspace(-0.5, 0.5, 20001)


@given(st.floats(-1, 1), st.floats(0.01, 0.5), st.floats(0.01, 1))
def test_cover_of_a_line_is_its_share_of_the_sample(offset: float, half: float, blur: float) -> None:
    counted = (np.abs(offset + NUMBERS * blur) < half).mean()
    assert box_cover(np.array(offset), half, np.array(blur)) == pytest.approx(counted, abs=2e-4)


@pytest.mark.parametrize("blur", [0.001, 0.05, 0.4, 3.0])
def test_stripes_are_as_dark_on_average_at_every_distance(blur: float) -> None:
    along = np.linspace(0, 10, 20000, endpoint=False)
    assert stripes(along, 0.5, 0.1, np.full_like(along, blur)).mean() == pytest.approx(0.2, abs=0.02)


def spot(x: np.ndarray, y: np.ndarray, blur: float) -> Spot:
    x, y = np.meshgrid(x.astype(np.float32), y.astype(np.float32))
    size = np.full(x.shape, blur, np.float32)
    return Spot(x, y, size, size)


def test_stone_far_away_has_no_joints_left(scene: Scene) -> None:
    floor = Floor(scene)
    near, far = (
        floor.colours(spot(np.linspace(-2, 0, 300), np.linspace(4, 6, 300), blur)) for blur in (0.004, 3.0)
    )
    assert np.abs(np.diff(near, axis=1)).mean() > 10 * np.abs(np.diff(far, axis=1)).mean()


def test_colours_are_albedos(scene: Scene) -> None:
    colours = Floor(scene).colours(spot(np.linspace(-13, 9, 200), np.linspace(-40, 60, 400), 0.05))
    assert np.isfinite(colours).all()
    assert colours.min() >= 0
    assert colours.max() < 1


def test_the_ground_does_not_depend_on_how_it_is_cut_into_tiles(scene: Scene) -> None:
    floor = Floor(scene)
    x, y = np.linspace(2, 6, 64), np.linspace(6, 10, 64)
    whole = floor.colours(spot(x, y, 0.02))
    part = floor.colours(spot(x[16:48], y[16:48], 0.02))
    assert np.allclose(whole[16:48, 16:48], part, atol=1e-5)
