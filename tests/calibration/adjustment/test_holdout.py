"""What cameras foretell of a view that they were not asked about."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gtm_hit.calibration.adjustment.holdout import HoldOut, leave_one_view_out
from gtm_hit.calibration.adjustment.residuals import Seen
from gtm_hit.geometry.camera import Camera
from tests.calibration.adjustment.scene import people, sightings, true_cameras, view_of


def held_out(cameras: list[Camera], points: np.ndarray, off: float = 0.0) -> HoldOut:
    """`off`: pixels by which one click on the point that most views see is off, along both axes."""
    clicks = sightings(cameras, points, 0.0, np.random.default_rng(0))
    pixels = clicks.pixels.copy()
    pixels[np.flatnonzero(clicks.points == np.bincount(clicks.points).argmax())[0]] += off
    seen = Seen(clicks.cameras, clicks.points, pixels, np.ones(len(pixels)))
    return leave_one_view_out([view_of(camera) for camera in cameras], seen, len(points), 1.0)


def test_a_bad_click_among_many_spoils_no_other_view() -> None:
    cameras, points = true_cameras(7), people(40, np.random.default_rng(1))
    clean, spoilt = held_out(cameras, points), held_out(cameras, points, off=60.0)
    assert clean.misses.max() < 1e-3
    assert spoilt.misses.max() == pytest.approx(60 * np.sqrt(2), abs=2)
    assert np.sum(spoilt.misses > 2) == 1


def test_what_the_others_see_along_one_ray_is_counted_and_not_foretold() -> None:
    first, second = true_cameras(2)
    beside = replace(first, name="beside", tvec=first.tvec + np.array([0.002, 0.0, 0.0]))
    points = people(40, np.random.default_rng(1))
    found = held_out([first, beside, second], points)
    assert found.undetermined == found.points > 10
    assert found.misses.size == 2 * found.points
    assert found.misses.max() < 1
    assert held_out([first, beside, replace(beside, name="third")], points).points == 0
