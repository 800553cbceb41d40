"""The tables that boxes are looked up in: what the browser's worker makes of a grid file."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, Route, expect

from gtm_hit.geometry.camera import Camera, back_project, project
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.geometry.grid_file import encode
from gtm_hit.geometry.table import RectangleTable
from tests.browser.bench import Bench
from tests.browser.test_geometry_js import grid_json
from tests.geometry.scenes import PERSON, WILDTRACK_GRID, wildtrack_cameras
from tests.geometry.test_fisheye import CAMERA as FISHEYE

pytestmark = [pytest.mark.browser]

OPEN = """
    const { openScene, fetchTables } = await import("/static/tables/tables.js");
    const api = { headers: () => ({}) };
    const images = { settled: async () => {} };
    const words = [];
    const scene = await openScene(api, given.scene, images.settled, (said) => words.push(said));
    await fetchTables({ api, scene, images }, 0);
"""
# The boxes of all positions as the scene answers them, as one SHA-256 per camera.
HASH_LOOKED_UP = """
    const digests = [];
    for (const [index] of scene.cameras.entries()) {
      const boxes = new Int16Array(4 * scene.grid.count);
      for (let position = 0; position < scene.grid.count; position += 1) {
        const box = scene._rectangle(index, { position, height: null, radius: null });
        if (box) boxes.set([box.xmin, box.ymin, box.xmax, box.ymax], 4 * position);
      }
      const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", boxes));
      digests.push(Array.from(hash, (byte) => byte.toString(16).padStart(2, "0")).join(""));
    }
    return digests;
"""


@pytest.fixture(scope="module")
def fisheye_table(tmp_path_factory: pytest.TempPathFactory) -> RectangleTable:
    folder = tmp_path_factory.mktemp("tables")
    return RectangleTable.build(folder, [FISHEYE], WILDTRACK_GRID, PERSON, FootRule.CORNERS)


@pytest.fixture(scope="module")
def wildtrack_table(tmp_path_factory: pytest.TempPathFactory) -> RectangleTable:
    folder = tmp_path_factory.mktemp("tables")
    return RectangleTable.build(folder, wildtrack_cameras(), WILDTRACK_GRID, PERSON, FootRule.CORNERS)


def packed(table: RectangleTable) -> list[bytes]:
    return [encode(table.boxes(one.index), one, WILDTRACK_GRID) for one in wildtrack_cameras()]


def serve(page: Page, tables: list[bytes]) -> None:
    def answer(route: Route) -> None:
        number = int(re.findall(r"\d+", route.request.url)[-1])
        route.fulfill(body=tables[number], content_type="application/gzip")

    page.route("**/grids/*", answer)


def scene_json(cameras: list[Camera]) -> dict[str, Any]:
    views = [{**camera.as_json(), "index": i, "grid": f"/grids/{i}"} for i, camera in enumerate(cameras)]
    return {
        "cameras": views,
        "grid": grid_json(WILDTRACK_GRID),
        "cylinder": {"radius": PERSON.radius, "height": PERSON.height},
        "foot_rule": "corners",
        "frames": [],
    }


def run(page: Page, cameras: list[Camera], code: str, **given: Any) -> Any:
    facts = {"scene": scene_json(cameras), **given}
    return page.evaluate(f"async (given) => {{ {OPEN} {code} }}", facts)


def test_every_box_that_is_looked_up_is_the_one_of_the_table(
    module_page: Page, wildtrack_table: RectangleTable
) -> None:
    boxes = [wildtrack_table.boxes(index) for index in range(7)]
    serve(module_page, packed(wildtrack_table))
    # Looked up, not computed: with this cylinder the rule gives other boxes.
    code = "scene.cylinder = { radius: 0.5, height: 1 };" + HASH_LOOKED_UP
    found = run(module_page, wildtrack_cameras(), code)
    assert found == [hashlib.sha256(one.tobytes()).hexdigest() for one in boxes]


def test_boxes_are_the_same_before_and_after_the_table_arrives(
    module_page: Page, wildtrack_table: RectangleTable
) -> None:
    serve(module_page, packed(wildtrack_table))
    positions = np.random.default_rng(2).integers(0, WILDTRACK_GRID.count, 3000).tolist()
    code = """
        const { Scene } = await import("/static/truth/scene.js");
        const at = (scene) => given.positions.map((position) =>
            scene.rectangles({ position, height: null, radius: null }));
        return JSON.stringify(at(scene)) === JSON.stringify(at(new Scene(given.scene)));
    """
    assert run(module_page, wildtrack_cameras(), code, positions=positions)


def test_people_of_their_own_size_are_computed(module_page: Page, wildtrack_table: RectangleTable) -> None:
    serve(module_page, packed(wildtrack_table))
    code = """
        const tall = scene.rectangles({ position: 456826, height: 2.1, radius: null })[0];
        const usual = scene.rectangles({ position: 456826, height: null, radius: null })[0];
        return [tall.ymin, usual.ymin, tall.ymax, usual.ymax];
    """
    tall, usual, *feet = run(module_page, wildtrack_cameras()[:1], code)
    assert tall < usual
    assert feet[0] == feet[1]


@pytest.mark.parametrize("body", [b"no gzip", b""])
def test_a_damaged_table_leaves_the_rule(module_page: Page, body: bytes) -> None:
    serve(module_page, [body])
    code = "return scene.rectangles({ position: 456826, height: null, radius: null })[0].xmin;"
    assert run(module_page, wildtrack_cameras()[:1], code) == 1510


def test_an_unknown_camera_whose_table_does_not_arrive_is_named(module_page: Page) -> None:
    serve(module_page, [b"no gzip"])
    with pytest.raises(Exception, match="What C1 sees did not arrive"):
        run(module_page, [FISHEYE], "return 1;")


def test_a_click_in_a_fisheye_view_finds_the_place_by_the_nearest_feet(
    module_page: Page, fisheye_table: RectangleTable
) -> None:
    serve(module_page, [encode(fisheye_table.boxes(0), FISHEYE, WILDTRACK_GRID)])
    pixels, ground = feet_in_picture(fisheye_table)
    code = "return given.pixels.map(([x, y]) => scene.toGround(0, { x, y }));"
    found = run(module_page, [FISHEYE], code, pixels=pixels.tolist())
    assert None not in found
    off = np.linalg.norm([(one["x"], one["y"]) for one in found] - ground, axis=1)
    per_pixel = np.linalg.norm(back_project(FISHEYE, pixels + np.array([0, 1])) - ground, axis=1)
    assert np.median(off / np.maximum(per_pixel, 0.025)) < 0.5
    assert np.quantile(off / np.maximum(per_pixel, 0.025), 0.99) < 1.5  # pixels, or positions


def test_the_nearest_feet_are_those_a_search_of_all_finds(
    module_page: Page, fisheye_table: RectangleTable
) -> None:
    serve(module_page, [encode(fisheye_table.boxes(0), FISHEYE, WILDTRACK_GRID)])
    clicks = np.random.default_rng(8).uniform((0, 0), (1280, 720), (40, 2)).tolist()
    code = """
        const { footX, footY, isVisible, nearestFoot } = await import("/static/geometry/feet.js");
        const { _feet: table, _index: index } = scene.cameras[0];
        const apart = (one, [x, y]) => Math.hypot(footX(table, one) - x, footY(table, one) - y);
        const inPicture = (one) => footX(table, one) >= 0 && footY(table, one) >= 0 &&
            footX(table, one) < 1280 && footY(table, one) < 720;
        const all = [...Array(scene.grid.count).keys()]
            .filter((one) => isVisible(table, one) && inPicture(one));
        return given.clicks.map((click) => {
          const found = nearestFoot(table, index, ...click, 24);
          const best = all.reduce((least, one) => Math.min(least, apart(one, click)), Infinity);
          return found === null ? best >= 24 : apart(found, click) === best;
        });
    """
    assert run(module_page, [FISHEYE], code, clicks=clicks) == [True] * 40


def test_ground_points_have_their_pixel_in_a_fisheye_view(
    module_page: Page, fisheye_table: RectangleTable
) -> None:
    serve(module_page, [encode(fisheye_table.boxes(0), FISHEYE, WILDTRACK_GRID)])
    pixels, ground = feet_in_picture(fisheye_table)
    code = "return given.ground.map(([x, y]) => scene.toImage(0, { x, y }));"
    found = run(module_page, [FISHEYE], code, ground=ground.tolist())
    off = np.abs([(one["x"], one["y"]) for one in found] - pixels)
    assert np.quantile(off, 0.99) < 1.0


def test_where_no_feet_can_be_there_is_no_place(module_page: Page, fisheye_table: RectangleTable) -> None:
    serve(module_page, [encode(fisheye_table.boxes(0), FISHEYE, WILDTRACK_GRID)])
    code = "return [scene.toGround(0, { x: 640, y: 5 }), scene.toImage(0, { x: -60, y: -60 })];"
    assert run(module_page, [FISHEYE], code) == [None, None]


def test_directions_in_a_fisheye_view_are_those_of_its_model(
    module_page: Page, fisheye_table: RectangleTable
) -> None:
    serve(module_page, [encode(fisheye_table.boxes(0), FISHEYE, WILDTRACK_GRID)])
    _pixels, ground = feet_in_picture(fisheye_table)
    code = """
        const { screenStep } = await import("/static/geometry/directions.js");
        return given.ground.map(([x, y]) => screenStep(scene.cameras[0], x, y).map(({ x, y }) => [x, y]));
    """
    found = np.array(run(module_page, [FISHEYE], code, ground=ground.tolist()))
    for axis, place in ((0, 0), (1, 2)):
        aside = ground.copy()
        aside[:, axis] += 0.05
        way = project(FISHEYE, on_ground(aside)) - project(FISHEYE, on_ground(ground))
        cosine = (found[:, place] * way).sum(axis=1) / np.linalg.norm(way, axis=1)
        assert np.median(cosine) > 0.99
        assert np.quantile(cosine, 0.02) > 0.9


def feet_in_picture(table: RectangleTable) -> tuple[np.ndarray, np.ndarray]:
    """Pixels inside the picture and the visible ground points they show."""
    positions = np.random.default_rng(4).choice(np.flatnonzero(table.visible(0)), 600, replace=False)
    ground = WILDTRACK_GRID.metres(positions)
    pixels = project(FISHEYE, on_ground(ground))
    inside = ((pixels > 5) & (pixels < (1275, 715))).all(axis=1)
    assert inside.sum() > 200
    return pixels[inside], ground[inside]


def on_ground(xy: np.ndarray) -> np.ndarray:
    return np.column_stack((xy, np.zeros(len(xy))))


@pytest.mark.django_db(transaction=True)
def test_tables_are_fetched_behind_the_first_frames_pictures(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2)
    asked: list[str] = []
    opened.page.on("request", lambda request: asked.append(request.url))
    opened.open().page.wait_for_load_state("networkidle")
    tables = [place for place, url in enumerate(asked) if "/grids/" in url]
    first = {image.light_digest for image in opened.street.frames[0].images.all()}
    pictures = [place for place, url in enumerate(asked) if Path(url).stem in first]
    assert len(tables) == 7
    assert max(pictures) < min(tables)


@pytest.mark.django_db(transaction=True)
def test_a_browser_that_has_the_tables_does_not_ask_for_them_again(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.page.wait_for_load_state("networkidle")
    opened.page.reload()
    expect(opened.page.locator("#workbench")).to_have_attribute("data-ready", "true")
    opened.page.wait_for_load_state("networkidle")
    sizes = opened.page.evaluate("performance.getEntriesByName('grid file').length")
    assert sizes == 7
