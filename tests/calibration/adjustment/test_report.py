from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gtm_hit.calibration.adjustment.adjusting import adjust
from gtm_hit.calibration.adjustment.report import report_of
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.calibration.adjustment.telling import lines
from gtm_hit.calibration.folding import folding
from gtm_hit.calibration.lens_numbers import Lens, lens_of
from tests.calibration.adjustment.scene import scene, true_cameras


def test_misses_fall_to_the_noise_of_the_clicks() -> None:
    problem, _ = scene(cameras=4, noise=1.0)
    report = report_of(adjust(problem, Variant.FIXED))
    assert report.before.median > 5
    assert 0.3 < report.after.median < 1.3
    assert sum(camera.after.count for camera in report.cameras) == report.after.count
    assert all(camera.moved > 0.01 for camera in report.cameras)


def test_the_worst_click_is_named() -> None:
    problem, _ = scene(noise=0.3)
    pixels = problem.seen.pixels.copy()
    pixels[5] += 200
    result = adjust(replace(problem, seen=replace(problem.seen, pixels=pixels)), Variant.FIXED)
    worst = report_of(result).worst
    assert len(worst) == 20
    named = problem.names[problem.seen.cameras[5]]
    assert (worst[0].camera, worst[0].point, worst[0].measured) == (named, problem.seen.points[5], False)
    assert worst[0].clicked == tuple(pixels[5])


def test_a_view_left_out_is_foretold_to_about_the_noise() -> None:
    problem, _ = scene(cameras=4, noise=0.5)
    hold_out = report_of(adjust(problem, Variant.FIXED)).hold_out
    assert hold_out.points > 10
    assert 0.3 < hold_out.share(50) < 3


def test_two_views_leave_nothing_to_hold_out() -> None:
    problem, _ = scene(cameras=2)
    assert report_of(adjust(problem, Variant.FIXED)).hold_out.points == 0


def test_feet_are_told_from_heads_by_what_stands_above_them() -> None:
    problem, points = scene(cameras=4, noise=0.3)
    report = report_of(adjust(problem, Variant.FIXED))
    assert report.feet.guessed
    assert report.feet.median < 0.02
    told = replace(problem, feet=np.arange(len(points)) % 2 == 1)
    assert report_of(adjust(told, Variant.FIXED)).feet.median == pytest.approx(1.7, abs=0.1)


def test_shifts_are_told_in_what_the_lens_step_knew() -> None:
    problem, _ = scene(cameras=3, lenses=True)
    known = tuple(replace(view, sigmas={"cx": 2.0}) for view in problem.views)
    report = report_of(adjust(replace(problem, views=known), Variant.TWO_PASS))
    shift = report.cameras[0].lens["cx"]
    assert shift.shift == pytest.approx((shift.after - shift.before) / 2.0)


def test_a_lens_that_turns_back_before_the_corner_folds() -> None:
    folds = [not folding(lens_of(camera)).monotone for camera in true_cameras(7)]
    assert folds == [True, False, False, False, False, True, False]
    straight = Lens(1920, 1080, lens_of(true_cameras(1)[0]).matrix, np.zeros(5))
    assert folding(straight).reach == np.inf


def test_the_words_name_each_camera_and_what_was_left_out() -> None:
    problem, _ = scene(cameras=3)
    result = adjust(problem)
    told = "\n".join(lines(result, report_of(result)))
    assert all(f"\n{name}: " in told for name in problem.names)
    assert "in one view only: left out" in told
