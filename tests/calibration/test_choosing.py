"""Which views are taken, and how their boards lean."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.calibration.choosing import CELLS, choose, coverage, directions_of, tilt_at, tilt_of
from gtm_hit.demo.boards import Placement, placements
from tests.calibration.board_scene import CHESS, LENS, SIZE, exact_view, straight

MIDDLE = np.array([0.0, 0.0, 0.6])


def leaning(number: int, towards: float, angle: float = 35.0) -> Placement:
    axis = np.array([np.cos(np.radians(towards)), np.sin(np.radians(towards)), 0])
    return Placement(axis * np.radians(angle), np.array([-0.1, -0.06, 0.55 + 0.001 * number]))


@pytest.mark.parametrize(
    ("rvec", "direction"),
    [((0, 0.5, 0), 0.0), ((-0.5, 0, 0), 90.0), ((0, -0.5, 0), 180.0), ((0.5, 0, 0), 270.0)],
)
def test_a_tilt_has_an_angle_and_a_direction(rvec: tuple[float, ...], direction: float) -> None:
    tilt = tilt_at(np.array(rvec), MIDDLE)
    assert tilt.angle == pytest.approx(np.degrees(0.5))
    assert abs((tilt.direction - direction + 180) % 360 - 180) < 1e-6


def test_the_tilt_is_told_well_enough_without_the_lens() -> None:
    placement = leaning(0, 60.0)
    true = tilt_at(placement.rvec, placement.tvec)
    told = tilt_of(exact_view("a", placement), SIZE)
    assert abs(told.angle - true.angle) < 12
    assert abs((told.direction - true.direction + 180) % 360 - 180) < 25


def test_different_tilts_are_chosen_before_the_same_one_again() -> None:
    straights = [exact_view(f"s{number}", straight(0.5 + 0.01 * number, tilt=0.02)) for number in range(6)]
    tilted = [exact_view(f"t{towards}", leaning(0, towards)) for towards in (0, 90, 180, 270)]
    assert set(choose([*straights, *tilted], SIZE, 4)) == {"t0", "t90", "t180", "t270"}


def test_the_rest_is_chosen_to_cover_the_picture() -> None:
    placed = list(placements(LENS, CHESS, 30, seed=8))
    seen = [exact_view(f"{number:02d}", placement) for number, placement in enumerate(placed)]
    by_name = {view.name: view for view in seen}
    chosen = [by_name[name] for name in choose(seen, SIZE, 14)]
    rng = np.random.default_rng(0)
    by_chance = [(coverage([seen[i] for i in rng.permutation(30)[:14]], SIZE) > 0).mean() for _ in range(20)]
    assert (coverage(chosen, SIZE) > 0).mean() > max(by_chance) - 0.02


def test_the_same_views_give_the_same_choice_in_any_order() -> None:
    seen = [exact_view(f"{n:02d}", placement) for n, placement in enumerate(placements(LENS, CHESS, 12, 8))]
    assert choose(seen, SIZE, 6) == choose(seen[::-1], SIZE, 6)


def test_never_more_are_chosen_than_there_are() -> None:
    assert choose([], SIZE, 5) == []
    assert choose([exact_view("a", straight())], SIZE, 5) == ["a"]


def test_coverage_counts_points_by_cell() -> None:
    counts = coverage([exact_view("a", straight()), exact_view("b", straight())], SIZE)
    assert counts.shape == CELLS[::-1]
    assert counts.sum() == 2 * CHESS.point_count


def test_a_board_seen_straight_on_leans_nowhere() -> None:
    assert directions_of([tilt_at(np.zeros(3), MIDDLE)]) == set()
    assert len(directions_of([tilt_at(np.array([0.5, 0, 0]), MIDDLE)])) == 1
