"""Clicks in several views against what scipy and OpenCV say, and what is marked and refused."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from typing import Any

import cv2
import numpy as np
import pytest

from gtm_hit.calibration.checking import Click, epipolar_line, shown, spot
from gtm_hit.geometry.camera import Camera, project
from tests.calibration.check_cases import PATH
from tests.conftest import REPOSITORY
from tests.geometry.scenes import wildtrack_cameras

CASES = json.loads(PATH.read_text())
CAMERAS = [
    Camera(**{name: value for name, value in facts.items() if name != "rotation"})
    for facts in CASES["cameras"]
]
LENSES = wildtrack_cameras(original=True)


def clicks_of(case: dict[str, Any]) -> list[Click]:
    return [
        Click(CAMERAS[camera], *pixel) for camera, pixel in zip(case["cameras"], case["clicks"], strict=True)
    ]


def clicked(point: tuple[float, float, float], *cameras: Camera) -> list[Click]:
    return [Click(camera, *project(camera, [point])[0]) for camera in cameras]


def off_the_line(line: np.ndarray, pixel: list[float]) -> float:
    start, along = line[:-1], np.diff(line, axis=0)
    share = np.clip(((pixel - start) * along).sum(1) / (along**2).sum(1), 0, 1)
    return float(np.hypot(*(start + share[:, None] * along - pixel).T).min())


@pytest.mark.parametrize("case", CASES["meetings"], ids=lambda case: str(case["cameras"]))
def test_clicks_meet_where_scipy_has_them_meet(case: dict[str, Any]) -> None:
    found = spot(clicks_of(case), CASES["sigma"])
    np.testing.assert_allclose(found.point, case["point"], atol=2e-5)
    np.testing.assert_allclose(found.residuals, case["residuals"], atol=0.01)
    np.testing.assert_allclose(found.sigmas, case["sigmas"], rtol=0.01)
    for camera in CAMERAS[:7] if max(case["cameras"]) < 7 else CAMERAS[7:]:
        here, there = shown(camera, found.point), shown(camera, np.array(case["point"]))
        np.testing.assert_allclose(here, there, atol=0.01)


@pytest.mark.parametrize("case", CASES["lines"], ids=lambda case: f"{case['camera']}-{case['other']}")
def test_an_epipolar_line_runs_through_all_that_lies_on_the_ray(case: dict[str, Any]) -> None:
    line = epipolar_line(Click(CAMERAS[case["camera"]], *case["click"]), CAMERAS[case["other"]])
    assert max(off_the_line(line, pixel) for pixel in case["through"]) < 0.05


def test_the_browser_does_the_same() -> None:
    code = """
        import { readFileSync } from "node:fs";
        import { Camera } from "./static/geometry/camera.js";
        import { epipolarLine } from "./static/geometry/epipolar.js";
        import { spot } from "./static/geometry/spatial.js";
        const text = readFileSync("fixtures/check_cases.json");
        const { cameras: facts, meetings, lines, sigma } = JSON.parse(text);
        const cameras = facts.map((each) => new Camera(each));
        const click = (camera, [u, v]) => ({ camera: cameras[camera], u, v });
        console.log(JSON.stringify({
          spots: meetings.map((each) => spot(each.clicks.map((at, n) => click(each.cameras[n], at)), sigma)),
          lines: lines.map((each) =>
            epipolarLine(click(each.camera, each.click), cameras[each.other]).map(({ x, y }) => [x, y])),
        }));
    """
    command = ["node", "--input-type=module", "-e", code]
    told = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=True).stdout
    browser = json.loads(told)
    for case, there in zip(CASES["meetings"], browser["spots"], strict=True):
        here = spot(clicks_of(case), CASES["sigma"])
        np.testing.assert_allclose(there["point"], here.point, atol=1e-6)
        np.testing.assert_allclose(there["residuals"], here.residuals, atol=0.01)
        np.testing.assert_allclose(there["covariance"], here.covariance, rtol=1e-3, atol=1e-9)
        assert there["groundSigma"] == pytest.approx(here.ground_sigma, rel=1e-3)
        assert there["doubtful"] == here.doubtful.tolist()
        assert there["angle"] == pytest.approx(here.angle, abs=1e-9)
    for case, there in zip(CASES["lines"], browser["lines"], strict=True):
        here = epipolar_line(Click(CAMERAS[case["camera"]], *case["click"]), CAMERAS[case["other"]])
        np.testing.assert_allclose(there, here, atol=0.01)


def test_of_three_clicks_the_one_that_spoils_the_others_is_marked() -> None:
    spoiled = [case for case in CASES["meetings"] if case["spoiled"] is not None and len(case["clicks"]) > 2]
    assert len(spoiled) > 1
    for case in spoiled:
        assert spot(clicks_of(case)).doubtful.tolist() == [
            place == case["spoiled"] for place in range(len(case["clicks"]))
        ]


def test_two_clicks_that_disagree_are_both_marked() -> None:
    clicks = clicked((3.0, 9.0, 1.0), LENSES[0], LENSES[5])
    assert not spot(clicks).doubtful.any()
    assert spot([replace(clicks[0], v=clicks[0].v + 60), clicks[1]]).doubtful.all()


def test_exact_clicks_leave_nothing_but_the_clicks_own_sigma() -> None:
    clicks = clicked((3.0, 9.0, 1.2), LENSES[0], LENSES[2], LENSES[5])
    found, twice = spot(clicks, sigma=1.0), spot(clicks, sigma=2.0)
    np.testing.assert_allclose(found.point, (3.0, 9.0, 1.2), atol=1e-7)
    np.testing.assert_allclose(twice.sigmas, 2 * found.sigmas, rtol=1e-9)
    assert 0.001 < found.ground_sigma < 0.05
    assert found.residuals.max() < 1e-4


def test_the_sigmas_are_what_repeated_clicks_show() -> None:
    exact = clicked((3.0, 9.0, 1.2), LENSES[0], LENSES[2], LENSES[5])
    rng = np.random.default_rng(3)
    found = [
        spot([replace(each, u=each.u + rng.normal(), v=each.v + rng.normal()) for each in exact], 1.0).point
        for _ in range(200)
    ]
    said = spot(exact, 1.0).sigmas
    np.testing.assert_allclose(np.std(found, axis=0), said, rtol=0.25)


def test_one_click_parallel_rays_and_what_no_lens_shows_meet_nowhere() -> None:
    (one,) = clicked((3.0, 9.0, 0.0), LENSES[0])
    assert spot([one]) is None
    assert spot([one, Click(replace(LENSES[0], name="the same"), one.u, one.v)]) is None
    assert spot([one, Click(LENSES[5], 1e5, -1e5)]) is None


def test_a_line_ends_where_the_ray_meets_the_ground() -> None:
    ground = np.array([3.0, 9.0, 0.0])
    (click,) = clicked((3.0, 9.0, 0.0), LENSES[0])
    line = epipolar_line(click, LENSES[5])
    assert min(np.hypot(*(end - project(LENSES[5], ground)[0])) for end in (line[0], line[-1])) < 0.01


def test_there_is_no_line_in_a_view_that_looks_away() -> None:
    (click,) = clicked((3.0, 9.0, 0.0), LENSES[0])
    back = LENSES[0].rotation.copy()
    back[[0, 2]] *= -1
    behind = replace(LENSES[0], rvec=cv2.Rodrigues(back)[0], tvec=-back @ (LENSES[0].centre - (0, 0, 0.5)))
    assert len(epipolar_line(click, behind)) == 0
