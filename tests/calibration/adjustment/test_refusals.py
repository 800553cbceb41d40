"""What no adjustment is made of, each with a sentence that names it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import cv2
import numpy as np
import pytest

from gtm_hit.calibration.adjustment.adjusting import adjust
from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.problem import NOBODY, Problem, Sightings
from gtm_hit.calibration.adjustment.settings import Variant
from tests.calibration.adjustment.scene import scene, true_cameras, view_of


def only(seen: Sightings, kept: np.ndarray) -> Sightings:
    return Sightings(seen.cameras[kept], seen.points[kept], seen.pixels[kept])


def with_pixel(problem: Problem, pixel: tuple[float, float]) -> Problem:
    pixels = problem.seen.pixels.copy()
    pixels[4] = pixel
    return replace(problem, seen=replace(problem.seen, pixels=pixels))


def with_view(problem: Problem, number: int, **facts: object) -> Problem:
    views = list(problem.views)
    views[number] = replace(views[number], **facts)
    return replace(problem, views=tuple(views))


def unconnected(problem: Problem) -> Problem:
    alone = ~((problem.seen.cameras == 1) & (problem.seen.points > 4))
    measured = problem.measured_seen.cameras != 1
    return replace(
        problem, seen=only(problem.seen, alone), measured_seen=only(problem.measured_seen, measured)
    )


def underground(problem: Problem) -> Problem:
    camera = true_cameras(1)[0]
    centre = camera.centre * (1, 1, -1)
    return with_view(problem, 0, tvec=-camera.rotation @ centre)


def left_handed(problem: Problem) -> Problem:
    camera = true_cameras(1)[0]
    rotation = -camera.rotation @ np.diag([1.0, -1.0, 1.0])
    return with_view(problem, 0, rvec=cv2.Rodrigues(rotation)[0].ravel(), tvec=-camera.tvec)


def in_one_line(problem: Problem) -> Problem:
    kept = np.isin(problem.measured_seen.points, np.flatnonzero(problem.measured[:, 0] == -1.5))
    return replace(problem, measured_seen=only(problem.measured_seen, kept))


def at_one_place(problem: Problem) -> Problem:
    same = tuple(replace(problem.views[0], name=view.name) for view in problem.views)
    return replace(problem, views=same, measured_seen=NOBODY)


def twice(seen: Sightings) -> Sightings:
    return only(seen, np.r_[0, np.arange(len(seen.pixels))])


CASES: dict[str, tuple[Callable[[Problem], Problem], str]] = {
    "nan": (lambda problem: with_pixel(problem, (np.nan, 3)), r"C1: the click on point \d+ is at \(nan, 3\)"),
    "far": (
        lambda problem: with_pixel(problem, (1e18, 3)),
        r"\(1e\+18, 3\), far outside its picture of 1920×1080",
    ),
    "names": (lambda problem: with_view(problem, 1, name="C1"), "Two cameras are named C1"),
    "twice": (lambda problem: replace(problem, seen=twice(problem.seen)), "C1: point .* was clicked twice"),
    "unconnected": (unconnected, r"C2 is not connected: it shares \d points .* sees 0 measured ones"),
    "underground": (underground, r"C1 stands 2\.\d\d m under the ground"),
    "left-handed": (left_handed, "C1 sees the world upside down or mirrored"),
    "line": (in_one_line, "fewer than three or lie in one line"),
    "one place": (at_one_place, "All cameras stand at the same place"),
    "same place": (
        lambda problem: replace(problem, measured=np.r_[problem.measured[:1], problem.measured[:-1]]),
        "Two measured points have the same coordinates",
    ),
    "parameter": (
        lambda problem: with_view(problem, 0, stays=frozenset({"focal"})),
        "C1: there is no parameter focal; there are rx",
    ),
    "fisheye": (
        lambda problem: with_view(problem, 0, lens=replace(problem.views[0].lens, distortion=np.zeros(12))),
        "C1: a lens of 12 coefficients cannot be adjusted",
    ),
    "nothing": (
        lambda problem: replace(problem, seen=NOBODY, measured_seen=NOBODY),
        "Nothing was clicked",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_it_is_refused_by_name(case: str) -> None:
    change, sentence = CASES[case]
    with pytest.raises(AdjustmentError, match=sentence):
        adjust(change(scene()[0]), Variant.FIXED)


def test_points_in_one_view_are_left_out_and_told() -> None:
    problem, _ = scene(cameras=2)
    kept = ~((problem.seen.cameras == 1) & (problem.seen.points == problem.seen.points[0]))
    result = adjust(replace(problem, seen=only(problem.seen, kept)), Variant.FIXED)
    assert np.isnan(result.points[problem.seen.points[0]]).all()
    assert any("in one view only: left out" in notice for notice in result.notices)


def test_a_point_in_one_view_whose_height_is_known_is_found() -> None:
    problem, points = scene(cameras=3, noise=0.1)
    sigmas = np.full(points.shape, np.inf)
    sigmas[::2, 2] = 0.001
    start = points.copy()
    result = adjust(replace(problem, points=start, point_sigmas=sigmas), Variant.FIXED)
    counts = np.bincount(problem.seen.points, minlength=len(points))
    single = (counts == 1) & (np.arange(len(points)) % 2 == 0)
    assert single.any()
    assert np.linalg.norm(result.points - points, axis=1)[single].max() < 0.1


def test_nearly_parallel_rays_are_told() -> None:
    camera = true_cameras(1)[0]
    near = replace(camera, name="C1b", tvec=camera.tvec + np.array([0.02, 0, 0]))
    problem, _ = scene(cameras=1, noise=0.0)
    shown = Sightings(problem.seen.cameras + 1, problem.seen.points, problem.seen.pixels)
    views = (view_of(camera, stays=frozenset({"pose"})), view_of(near, stays=frozenset({"pose"})))
    both = Sightings(
        *(
            np.concatenate(pair)
            for pair in zip(
                (problem.seen.cameras, problem.seen.points, problem.seen.pixels),
                (shown.cameras, shown.points, shown.pixels),
                strict=True,
            )
        )
    )
    result = adjust(replace(problem, views=views, seen=both), Variant.FIXED)
    assert any("less than 1° apart" in notice for notice in result.notices)


def test_points_along_parallel_rays_that_nobody_placed_are_left_out() -> None:
    problem, points = scene(cameras=2)
    first = problem.seen.cameras == 0
    same = Sightings(
        np.r_[problem.seen.cameras[first], problem.seen.cameras[first] + 1],
        np.r_[problem.seen.points[first], problem.seen.points[first]],
        np.r_[problem.seen.pixels[first], problem.seen.pixels[first]],
    )
    camera = true_cameras(1)[0]
    views = tuple(view_of(replace(camera, name=name), stays=frozenset({"pose"})) for name in ("C1", "C2"))
    unplaced = replace(problem, views=views, seen=same, points=np.full_like(points, np.nan))
    result = adjust(unplaced, Variant.FIXED)
    assert np.isnan(result.points).all()
    assert any("parallel rays" in notice for notice in result.notices)
