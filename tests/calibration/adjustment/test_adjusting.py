"""Adjusting on problems whose answer is known, with scipy as the judge of what the lowest cost is."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares

from gtm_hit.calibration.adjustment.adjusting import Adjustment, adjust
from gtm_hit.calibration.adjustment.checks import usable
from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.normal import reduced
from gtm_hit.calibration.adjustment.parameters import packed
from gtm_hit.calibration.adjustment.problem import NOBODY, Problem
from gtm_hit.calibration.adjustment.residuals import derivatives, misses
from gtm_hit.calibration.adjustment.settings import Settings, Variant
from gtm_hit.calibration.adjustment.state import State
from gtm_hit.calibration.adjustment.system import all_points, observations, system_of
from tests.calibration.adjustment.scene import centres_off, scene


def bytes_of(result: Adjustment) -> bytes:
    return packed(result.views).tobytes() + result.points.tobytes()


def scipys_cost(problem: Problem, result: Adjustment, lenses: bool) -> float:
    """The lowest cost that scipy's trust-region method finds around a result, its slopes left to it."""
    settings = Settings()
    seen, _ = usable(problem, observations(problem, settings))
    rows, free = packed(result.views), len(problem.points)
    points = np.concatenate((np.nan_to_num(result.points), problem.measured))
    width = 15 if lenses else 6

    def residuals(values: np.ndarray) -> np.ndarray:
        here, there = rows.copy(), points.copy()
        here[:, :width] = values[: len(rows) * width].reshape(len(rows), width)
        there[:free] = values[len(rows) * width :].reshape(-1, 3)
        missed = misses(here, there, seen)
        lengths = np.hypot(*missed.T)
        # Half the square of this is the robust cost.
        robust = np.sqrt(np.where(lengths > 1, 2 * lengths - 1, lengths**2) * seen.weights)
        return (missed * (robust / np.maximum(lengths, 1e-12))[:, None]).ravel()

    start = np.concatenate((rows[:, :width].ravel(), points[:free].ravel()))
    return least_squares(residuals, start, x_scale="jac", ftol=1e-10, xtol=1e-12, max_nfev=8).cost


@pytest.mark.parametrize("lenses", [False, True], ids=["poses", "lenses too"])
def test_the_derivatives_are_those_that_small_steps_show(lenses: bool) -> None:
    problem, _ = scene(crowd=5, lenses=lenses)
    rows, points = packed(problem.views), all_points(problem)
    seen = observations(problem, Settings())
    _, by_camera, by_point = derivatives(rows, points, seen)
    for number in range(rows.shape[1]):
        step = 1e-6 * max(1.0, abs(rows[0, number]))
        up, down = rows.copy(), rows.copy()
        up[:, number] += step
        down[:, number] -= step
        numeric = (misses(up, points, seen) - misses(down, points, seen)) / (2 * step)
        np.testing.assert_allclose(by_camera[..., number], numeric, rtol=1e-4, atol=1e-3)
    for axis in range(3):
        shift = np.eye(3)[axis] * 1e-6
        numeric = (misses(rows, points + shift, seen) - misses(rows, points - shift, seen)) / 2e-6
        np.testing.assert_allclose(by_point[..., axis], numeric, rtol=1e-4, atol=1e-3)


@pytest.mark.parametrize("lenses", [False, True], ids=["poses", "lenses too"])
def test_no_lower_cost_is_found_by_scipy(lenses: bool) -> None:
    problem, _ = scene(crowd=4, cameras=2)
    variant = Variant.BOTH if lenses else Variant.FIXED
    result = adjust(problem, variant)
    assert result.cost.total <= scipys_cost(problem, result, lenses) * (1 + 1e-5)


@pytest.mark.parametrize("variant", Variant)
def test_cameras_come_back_to_where_they_are(variant: Variant) -> None:
    problem, _ = scene(cameras=4, lenses=variant is not Variant.FIXED, noise=0.3)
    assert centres_off(problem.views).max() > 0.1
    assert centres_off(adjust(problem, variant).views).max() < 0.03


def test_points_nobody_placed_are_found() -> None:
    problem, points = scene(noise=0.3)
    result = adjust(replace(problem, points=np.full_like(points, np.nan)), Variant.FIXED)
    known = ~np.isnan(result.points[:, 0])
    assert known.sum() > 40
    assert np.median(np.linalg.norm(result.points - points, axis=1)[known]) < 0.02


def test_one_gross_click_does_not_move_the_cameras() -> None:
    problem, _ = scene(noise=0.3)
    pixels = problem.seen.pixels.copy()
    pixels[3] += 300
    result = adjust(replace(problem, seen=replace(problem.seen, pixels=pixels)), Variant.FIXED)
    assert centres_off(result.views).max() < 0.03


def test_a_held_lens_and_a_held_camera_keep_every_bit() -> None:
    problem, _ = scene(lenses=True)
    first, second, third = problem.views
    views = (
        replace(first, stays=frozenset({"pose", "lens"})),
        replace(second, stays=frozenset({"k3"})),
        third,
    )
    result = adjust(replace(problem, views=views), Variant.BOTH)
    before, after = packed(views), packed(result.views)
    assert (after[0] == before[0]).all()
    assert after[1, 14] == before[1, 14] and after[1, 13] != before[1, 13]
    assert (after[2] != before[2]).all()


def test_the_lens_step_holds_lenses_as_firmly_as_it_knew_them() -> None:
    problem, _ = scene(lenses=True)
    firm = tuple(replace(view, sigmas={"fx": 1e-3, "fy": 1e-3}) for view in problem.views)
    shifts = []
    for views in (problem.views, firm):
        result = adjust(replace(problem, views=views), Variant.SOFT)
        shifts.append(np.abs(packed(result.views)[:, 6] - packed(views)[:, 6]).max())
    assert shifts[1] < 0.01 < shifts[0]


def test_measured_points_that_may_be_off_are_moved_by_their_sigma_at_most_somewhat() -> None:
    problem, _ = scene(noise=0.2)
    measured = problem.measured.copy()
    measured[4, 0] += 0.05
    result = adjust(replace(problem, measured=measured, measured_sigma=0.02), Variant.FIXED)
    moved = result.measured - measured
    assert moved[4, 0] < -0.02
    assert np.abs(np.delete(moved, 4, axis=0)).max() < 0.02


def test_the_same_input_gives_the_same_bytes() -> None:
    problem, _ = scene()
    assert bytes_of(adjust(problem)) == bytes_of(adjust(problem))


def test_stopped_after_every_step_and_kept_as_json_it_ends_with_the_same_bytes() -> None:
    problem, _ = scene(crowd=10)
    result = adjust(problem, Variant.TWO_PASS, stop=lambda: True)
    stops = 0
    while not result.finished:
        kept = State.of_json(json.loads(json.dumps(result.state.as_json())))
        asked = iter((False, True))
        result = adjust(problem, Variant.TWO_PASS, state=kept, stop=lambda asked=asked: next(asked))
        stops += 1
    assert stops > 5
    assert bytes_of(result) == bytes_of(adjust(problem, Variant.TWO_PASS))


def test_a_state_of_other_clicks_is_not_taken_up() -> None:
    problem, _ = scene(crowd=10)
    state = adjust(problem, stop=lambda: True).state
    pixels = problem.seen.pixels + 1
    with pytest.raises(AdjustmentError, match="changed since"):
        adjust(replace(problem, seen=replace(problem.seen, pixels=pixels)), state=state)


def test_progress_counts_the_steps_of_both_passes_and_the_cost_falls_within_each() -> None:
    told = []
    problem, _ = scene(lenses=True)
    result = adjust(problem, Variant.TWO_PASS, progress=told.append)
    assert [step.number for step in told] == list(range(1, result.steps + 1))
    assert {step.pass_number for step in told} == {1, 2}
    second = [step.cost for step in told if step.pass_number == 2]
    assert second == sorted(second, reverse=True)


def test_without_measured_points_two_cameras_hold_the_world_and_it_is_said() -> None:
    problem, _ = scene(cameras=3)
    result = adjust(replace(problem, measured=np.zeros((0, 3)), measured_seen=NOBODY), Variant.FIXED)
    (notice,) = [notice for notice in result.notices if "no measured point" in notice]
    held = [place for place, view in enumerate(problem.views) if view.name in notice]
    before, after = (
        [views[place].camera().centre for place in held] for views in (problem.views, result.views)
    )
    assert len(held) == 2
    assert np.linalg.norm(after[0] - after[1]) == pytest.approx(
        np.linalg.norm(before[0] - before[1]), abs=1e-9
    )
    assert sum(np.allclose(here, there, atol=1e-9) for here, there in zip(before, after, strict=True)) == 1


def test_the_uncertainty_is_what_repeated_noise_shows() -> None:
    found, told = [], []
    for seed in range(12):
        problem, _ = scene(seed=7, cameras=3, crowd=30, noise=0.0)
        rng = np.random.default_rng(seed)
        pixels = problem.seen.pixels + rng.normal(0, 1, problem.seen.pixels.shape)
        grid = problem.measured_seen.pixels + rng.normal(0, 1, problem.measured_seen.pixels.shape)
        noisy = replace(
            problem,
            seen=replace(problem.seen, pixels=pixels),
            measured_seen=replace(problem.measured_seen, pixels=grid),
        )
        result = adjust(noisy, Variant.FIXED)
        found.append([view.camera().centre for view in result.views])
        told.append(result.uncertainty.centres)
    spread, said = np.std(found, axis=0, ddof=1), np.mean(told, axis=0)
    assert 0.6 < np.median(said / spread) < 1.6


def test_the_reduced_system_is_the_whole_one_without_its_points() -> None:
    problem, _ = scene(crowd=6, cameras=2)
    settings = Settings()
    seen, _ = usable(problem, observations(problem, settings))
    held = np.zeros((2, 15), dtype=bool)
    system = system_of(problem, settings, seen, held, lenses=True, soft=True)
    rows, points = packed(problem.views), all_points(problem)
    normal = system.normal(rows, points)
    _, by_camera, by_point = derivatives(rows, points, seen)
    whole = np.zeros((2 * len(seen.pixels), 30 + 3 * len(problem.points)))
    for row, (camera, point) in enumerate(zip(seen.cameras, seen.points, strict=True)):
        part = slice(2 * row, 2 * row + 2)
        whole[part, 15 * camera : 15 * camera + 15] = by_camera[row]
        if point < len(problem.points):
            whole[part, 30 + 3 * point : 33 + 3 * point] = by_point[row]
    lengths = np.hypot(*misses(rows, points, seen).T)
    weights = np.repeat(seen.weights / np.maximum(lengths, 1), 2)
    full = whole.T @ (whole * weights[:, None])
    full[np.arange(30), np.arange(30)] += system.cameras_known.information.ravel()
    used = np.flatnonzero(np.diag(full)[30:]) + 30
    eliminated = np.linalg.solve(full[np.ix_(used, used)], full[used][:, :30])
    schur = full[:30, :30] - full[:30][:, used] @ eliminated
    np.testing.assert_allclose(reduced(normal, 0.0).matrix, schur, rtol=1e-5, atol=1e-6 * np.abs(schur).max())
