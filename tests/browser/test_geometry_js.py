"""The browser's geometry against Python's: the same rectangles, the same pixels, the same ground points."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page

from gtm_hit.geometry.camera import Camera, back_project, project
from gtm_hit.geometry.cylinder import FootRule, rectangles
from gtm_hit.geometry.grid import Grid
from tests.geometry.footprint import footprint
from tests.geometry.rectangle_cases import PATH, UNEVEN_GRID
from tests.geometry.scenes import (
    MULTIVIEWX_GRID,
    PERSON,
    WILDTRACK_GRID,
    mirrored,
    mirrored_grid,
    multiviewx_cameras,
    wildtrack_cameras,
)

pytestmark = pytest.mark.browser

MODULES = """
    const [{ Camera, project, backProject }, { Grid }, { rectangle, rectangleInto }, ground, directions,
      { groundPoint }] = await Promise.all(
      ["camera", "grid", "rectangle", "ground", "directions", "triangulation"].map(
        (name) => import(`/static/geometry/${name}.js`)));
    const { gridOutline, gridLines, footprint } = ground;
    const { screenStep, screenAxes } = directions;
    const cameras = (given.cameras ?? []).map((camera) => new Camera(camera));
    const grid = given.grid && new Grid(given.grid);
"""

# int16 boxes of every `stride`-th position, 0 where not visible, as one SHA-256 per camera.
HASH_RECTANGLES = """
    const digests = [];
    const box = new Float64Array(4);
    for (const camera of cameras) {
      const boxes = new Int16Array(4 * Math.ceil(grid.count / given.stride));
      for (let position = 0, at = 0; position < grid.count; position += given.stride, at += 4) {
        if (rectangleInto(box, camera, grid, given.cylinder, given.rule, position)) boxes.set(box, at);
      }
      const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", boxes));
      digests.push(Array.from(hash, (byte) => byte.toString(16).padStart(2, "0")).join(""));
    }
    return digests;
"""

CAMERAS = wildtrack_cameras()
DISTORTED = wildtrack_cameras(original=True)
MIRRORED = [mirrored(camera) for camera in CAMERAS]


def run(page: Page, code: str, **given: Any) -> Any:
    """What `code` returns in the browser, with the modules imported and `given` in reach."""
    if "cameras" in given:
        given["cameras"] = [camera.as_json() for camera in given["cameras"]]
    if "grid" in given:
        given["grid"] = grid_json(given["grid"])
    return page.evaluate(f"async (given) => {{ {MODULES} {code} }}", given)


def grid_json(grid: Grid) -> dict[str, Any]:
    origin = [grid.origin_x, grid.origin_y]
    return {"columns": grid.columns, "rows": grid.rows, "step": grid.step, "origin": origin}


def python_hashes(cameras: list[Camera], grid: Grid, rule: FootRule, stride: int) -> list[str]:
    positions = np.arange(0, grid.count, stride)
    boxes = (rectangles(camera, grid, PERSON, rule, positions)[0] for camera in cameras)
    return [hashlib.sha256(box.astype("<i2").tobytes()).hexdigest() for box in boxes]


def browser_hashes(page: Page, cameras: list[Camera], grid: Grid, rule: FootRule, stride: int) -> list[str]:
    cylinder = {"radius": PERSON.radius, "height": PERSON.height}
    facts = {"cameras": cameras, "grid": grid, "rule": rule.value, "stride": stride, "cylinder": cylinder}
    return run(page, HASH_RECTANGLES, **facts)


def random_ground(grid: Grid, count: int, seed: int) -> np.ndarray:
    low = np.array([grid.origin_x, grid.origin_y])
    return np.random.default_rng(seed).uniform(low, low + grid.extent, (count, 2))


def test_every_rectangle_of_the_wildtrack_table_is_the_same_in_the_browser(module_page: Page) -> None:
    facts = (CAMERAS, WILDTRACK_GRID, FootRule.CORNERS, 1)
    assert browser_hashes(module_page, *facts) == python_hashes(*facts)


def test_rectangles_of_the_published_multiviewx_cameras_are_the_same(
    module_page: Page, shared_data: Path
) -> None:
    facts = (multiviewx_cameras(shared_data), MULTIVIEWX_GRID, FootRule.CENTRE, 7)
    assert browser_hashes(module_page, *facts) == python_hashes(*facts)


@pytest.mark.parametrize("rule", FootRule)
def test_rectangles_in_distorted_pictures_are_the_same(module_page: Page, rule: FootRule) -> None:
    facts = (DISTORTED, UNEVEN_GRID, rule, 1)
    assert browser_hashes(module_page, *facts) == python_hashes(*facts)


@pytest.mark.parametrize("rule", FootRule)
def test_rectangles_of_left_handed_poses_are_the_same(module_page: Page, rule: FootRule) -> None:
    facts = (MIRRORED, mirrored_grid(WILDTRACK_GRID), rule, 11)
    assert browser_hashes(module_page, *facts) == python_hashes(*facts)


def test_the_cases_shared_with_python_hold(module_page: Page) -> None:
    cases = json.loads(PATH.read_text())
    found = run(
        module_page,
        """
        return given.cases.map((one) => {
          const [camera, grid] = [new Camera(one.camera), new Grid(one.grid)];
          return one.positions.map((position) => {
            const found = rectangle(camera, grid, one.cylinder, one.rule, position);
            return found && [found.xmin, found.ymin, found.xmax, found.ymax];
          });
        });
        """,
        cases=cases,
    )
    assert found == [case["rectangles"] for case in cases]


def test_an_unknown_foot_rule_is_refused(module_page: Page) -> None:
    code = """
        try {
          rectangle(cameras[0], grid, { radius: 0.16, height: 1.8 }, "toes", 0);
        } catch (error) {
          return error.message;
        }
    """
    assert "toes" in run(module_page, code, cameras=CAMERAS[:1], grid=WILDTRACK_GRID)


@pytest.mark.parametrize("cameras", [CAMERAS, DISTORTED, MIRRORED], ids=["plain", "distorted", "mirrored"])
def test_the_browser_projects_and_back_projects_as_python_does(
    module_page: Page, cameras: list[Camera]
) -> None:
    pixels = np.random.default_rng(4).uniform((0, 0), (1919, 1079), (300, 2))
    code = """
        return cameras.map((camera) => given.pixels.map(([u, v]) => {
          const ground = backProject(camera, u, v, 0.3);
          const pixel = ground && project(camera, ground.x, ground.y, 0.3);
          return ground && [ground.x, ground.y, pixel.x, pixel.y];
        }));
    """
    found = run(module_page, code, cameras=cameras, pixels=pixels.tolist())
    for camera, points in zip(cameras, found, strict=True):
        expected = back_project(camera, pixels, 0.3)
        here = ~np.isnan(expected).any(axis=1)
        assert [point is not None for point in points] == here.tolist()
        browser = np.array([point for point in points if point])
        np.testing.assert_allclose(browser[:, :2], expected[here], rtol=1e-6)
        world = np.column_stack((expected[here], np.full(here.sum(), 0.3)))
        np.testing.assert_allclose(browser[:, 2:], project(camera, world), atol=1e-4)
        np.testing.assert_allclose(browser[:, 2:], pixels[here], atol=1e-4)


def test_points_behind_a_camera_have_no_pixel(module_page: Page) -> None:
    behind = [(camera.centre - 3 * camera.rotation[2]).tolist() for camera in CAMERAS]
    code = "return cameras.map((camera, index) => project(camera, ...given.points[index]));"
    assert run(module_page, code, cameras=CAMERAS, points=behind) == [None] * 7


def test_the_browsers_grid_agrees_with_pythons(module_page: Page) -> None:
    points = np.random.default_rng(6).uniform((-4, -10), (10, 28), (2000, 2))
    positions = np.random.default_rng(7).integers(0, WILDTRACK_GRID.count, 500)
    code = """
        return {
          position: given.points.map(([x, y]) => grid.position(x, y)),
          nearest: given.points.map(([x, y]) => grid.nearest(x, y)),
          metres: given.positions.map((position) => grid.metres(position)).map(({ x, y }) => [x, y]),
        };
    """
    found = run(module_page, code, grid=WILDTRACK_GRID, points=points.tolist(), positions=positions.tolist())
    assert found["position"] == WILDTRACK_GRID.position(points).tolist()
    assert found["nearest"] == WILDTRACK_GRID.nearest(points).tolist()
    assert found["metres"] == WILDTRACK_GRID.metres(positions).tolist()


@pytest.mark.parametrize("cameras", [CAMERAS, DISTORTED], ids=["plain", "distorted"])
def test_footprints_are_the_same(module_page: Page, cameras: list[Camera]) -> None:
    code = "return cameras.map((camera) => footprint(camera, grid).map(({ x, y }) => [x, y]));"
    found = run(module_page, code, cameras=cameras, grid=WILDTRACK_GRID)
    for camera, polygon in zip(cameras, found, strict=True):
        np.testing.assert_allclose(polygon, footprint(camera, WILDTRACK_GRID), atol=1e-6)


@pytest.mark.parametrize("cameras", [CAMERAS, DISTORTED, MIRRORED], ids=["plain", "distorted", "mirrored"])
def test_outlines_show_the_grids_border_and_nothing_behind_the_camera(
    module_page: Page, cameras: list[Camera]
) -> None:
    grid = mirrored_grid(WILDTRACK_GRID) if cameras is MIRRORED else WILDTRACK_GRID
    code = (
        "return cameras.map((camera) => gridOutline(camera, grid).map((l) => l.map(({ x, y }) => [x, y])));"
    )
    low = np.array([grid.origin_x, grid.origin_y])
    for camera, lines in zip(cameras, run(module_page, code, cameras=cameras, grid=grid), strict=True):
        pixels = np.concatenate(lines)
        assert len(pixels) >= 2
        inside = ((pixels >= 0) & (pixels < (1920, 1080))).all(axis=1)
        ground = back_project(camera, pixels[inside])
        off_border = np.minimum(np.abs(ground - low), np.abs(ground - low - grid.extent)).min(axis=1)
        assert off_border.max(initial=0) < 1e-6


def test_grid_lines_lie_on_whole_metres(module_page: Page) -> None:
    code = "return gridLines(cameras[0], grid, 2).map((line) => line.map(({ x, y }) => [x, y]));"
    lines = run(module_page, code, cameras=CAMERAS[:1], grid=WILDTRACK_GRID)
    for line in lines:
        start, end = np.array(line)
        middle = back_project(CAMERAS[0], [(start + end) / 2])[0]
        if not np.isnan(middle).any():
            assert min(abs(middle / 2 - np.rint(middle / 2))) < 1e-6
    assert 15 < len(lines) <= 7 + 19


def test_a_grid_behind_the_camera_has_no_outline(module_page: Page) -> None:
    behind = Grid(4, 4, 1.0, *(CAMERAS[0].centre[:2] - 20 * CAMERAS[0].rotation[2, :2] - 2).tolist())
    assert run(module_page, "return gridOutline(cameras[0], grid);", cameras=CAMERAS[:1], grid=behind) == []


@pytest.mark.parametrize("cameras", [CAMERAS, MIRRORED], ids=["plain", "mirrored"])
def test_arrow_keys_and_ground_steps_belong_together_one_to_one(
    module_page: Page, cameras: list[Camera]
) -> None:
    grid = mirrored_grid(WILDTRACK_GRID) if cameras is MIRRORED else WILDTRACK_GRID
    code = """
        const axes = cameras.flatMap((camera) => given.points.map(([x, y]) => screenAxes(camera, x, y)));
        return axes.filter(Boolean);
    """
    found = run(module_page, code, cameras=cameras, points=random_ground(grid, 200, seed=8).tolist())
    assert len(found) > 700
    for axes in found:
        steps = {key: (axes[key]["columns"], axes[key]["rows"]) for key in ("left", "right", "up", "down")}
        assert set(steps.values()) == {(1, 0), (-1, 0), (0, 1), (0, -1)}
        assert sum(np.array([steps["left"], steps["right"]])).tolist() == [0, 0]
        assert sum(np.array([steps["up"], steps["down"]])).tolist() == [0, 0]


def test_an_arrow_key_leads_its_way_on_the_screen(module_page: Page) -> None:
    code = """
        const keys = { left: [-1, 0], right: [1, 0], up: [0, -1], down: [0, 1] };
        return cameras.flatMap((camera) => given.points.map(([x, y]) => {
          const [axes, here] = [screenAxes(camera, x, y), project(camera, x, y)];
          if (!axes || here.x < 0 || here.x > 1919 || here.y < 0 || here.y > 1079) return null;
          return Object.entries(keys).map(([key, [right, down]]) => {
            const there = project(camera, x + 0.025 * axes[key].columns, y + 0.025 * axes[key].rows);
            return (there.x - here.x) * right + (there.y - here.y) * down;
          });
        })).filter(Boolean);
    """
    points = random_ground(WILDTRACK_GRID, 200, seed=9).tolist()
    found = np.array(run(module_page, code, cameras=CAMERAS, points=points))
    assert len(found) > 300
    # Where the ground's axes run diagonally, two keys of the four have the better of the choice.
    assert (found > 0).mean() > 0.97
    assert (found.sum(axis=1) > 0).all()


def test_steps_are_unit_vectors_and_opposites_point_apart(module_page: Page) -> None:
    steps = run(module_page, "return screenStep(cameras[0], 3, 9);", cameras=CAMERAS[:1])
    vectors = {(step["columns"], step["rows"]): np.array([step["x"], step["y"]]) for step in steps}
    assert [np.hypot(*vector) for vector in vectors.values()] == pytest.approx([1.0] * 4)
    np.testing.assert_array_equal(vectors[1, 0], -vectors[-1, 0])
    np.testing.assert_array_equal(vectors[0, 1], -vectors[0, -1])


def test_there_are_no_directions_behind_the_camera(module_page: Page) -> None:
    x, y = (CAMERAS[0].centre - 3 * CAMERAS[0].rotation[2])[:2].tolist()
    code = "return [screenStep(cameras[0], given.x, given.y), screenAxes(cameras[0], given.x, given.y)];"
    assert run(module_page, code, cameras=CAMERAS[:1], x=x, y=y) == [None, None]


GROUND_POINT = "return groundPoint(given.clicks.map(([u, v], index) => ({ camera: cameras[index], u, v })));"


def test_two_exact_clicks_give_the_ground_point_without_residuals(module_page: Page) -> None:
    clicks = [project(camera, [[3.0, 9.0, 0.0]])[0].tolist() for camera in (CAMERAS[0], CAMERAS[5])]
    found = run(module_page, GROUND_POINT, cameras=[CAMERAS[0], CAMERAS[5]], clicks=clicks)
    assert (found["x"], found["y"]) == pytest.approx((3.0, 9.0), abs=1e-7)
    assert found["residuals"] == pytest.approx([0, 0], abs=1e-4)


def test_two_clicks_that_disagree_give_the_least_squares_in_pixels(module_page: Page) -> None:
    cameras = [CAMERAS[0], CAMERAS[5]]
    exact = np.array([project(camera, [[3.0, 9.0, 0.0]])[0] for camera in cameras])
    clicks = exact + np.array([[9, 0], [0, -6]])
    found = run(module_page, GROUND_POINT, cameras=cameras, clicks=clicks.tolist())

    def cost(x: float, y: float) -> float:
        pixels = np.array([project(camera, [[x, y, 0.0]])[0] for camera in cameras])
        return float(((pixels - clicks) ** 2).sum())

    best = cost(found["x"], found["y"])
    assert np.sum(np.square(found["residuals"])) == pytest.approx(best)
    around = [(dx, dy) for dx in (-0.002, 0, 0.002) for dy in (-0.002, 0, 0.002) if dx or dy]
    assert all(cost(found["x"] + dx, found["y"] + dy) > best for dx, dy in around)


def test_two_clicks_into_the_sky_meet_no_ground(module_page: Page) -> None:
    sky = [[900, -400], [900, -400]]
    assert run(module_page, GROUND_POINT, cameras=[CAMERAS[0], CAMERAS[5]], clicks=sky) is None
