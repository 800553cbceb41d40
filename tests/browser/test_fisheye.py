"""A camera whose model only the server knows, from its files to the export, through the workbench."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from uuid import uuid4

import numpy as np
import pytest
from playwright.sync_api import Page, Route, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.formats.calibration.wildtrack_xml import read_intrinsic
from gtm_hit.geometry.camera import CameraModel, project
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.models import Annotation, Assignment, Dataset
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.frames.saving import save_frame
from gtm_hit.ops.work import assignments, links, workers
from gtm_hit.ops.work.batches import make_batches
from tests import fisheye_folder

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

WIDE, USUAL = fisheye_folder.cameras()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return fisheye_folder.write(tmp_path_factory.mktemp("fisheye"))


@pytest.fixture
def dataset(folder: Path) -> Dataset:
    dataset = import_dataset(fisheye_folder.options(folder)).dataset
    make_batches(dataset)
    return dataset


@pytest.fixture
def assignment(dataset: Dataset) -> Assignment:
    return assignments.claim(workers.enter("link", "walker"), dataset)


@pytest.fixture
def opened(page: Page, live_server: LiveServer, assignment: Assignment) -> Iterator[Page]:
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1280, "height": 800})
    go(page, live_server, assignment)
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    yield page
    assert errors == []


def go(page: Page, server: LiveServer, assignment: Assignment) -> None:
    page.goto(f"{server.url}/annotate/{links.assignment_token(assignment)}/")


def clear_positions(count: int) -> list[int]:
    """Where people of the first frame stand, well inside the fisheye's picture and away from each other."""
    grid = fisheye_folder.scene().grid
    places = [row.position for row in fisheye_folder.people() if row.number == 0 and row.position >= 0]
    pixels = project(WIDE, np.column_stack((grid.metres(places), np.zeros(len(places)))))
    inside = ((pixels > (80, 200)) & (pixels < (880, 500))).all(axis=1)
    _boxes, visible = rectangles(WIDE, grid, Cylinder(0.16, 1.8), FootRule.CORNERS, places)
    found: list[int] = []
    for place, pixel in zip(np.array(places)[inside & visible], pixels[inside & visible], strict=True):
        others = [at(one) for one in found]
        if all(np.hypot(*(pixel - other)) > 60 for other in others):
            found.append(int(place))
    assert len(found) >= count
    return sorted(found, key=lambda one: -at(one)[1])[:count]


def at(position: int) -> np.ndarray:
    """Pixel of a position's ground point in the fisheye's picture."""
    x, y = fisheye_folder.scene().grid.metres([position])[0]
    return project(WIDE, [[x, y, 0.0]])[0]


def on_page(page: Page, pixel: np.ndarray, view: int = 0) -> tuple[float, float]:
    bounds = page.locator(f'[data-view="camera-{view}"]').bounding_box()
    assert bounds
    scale = min(bounds["width"] / WIDE.width, bounds["height"] / WIDE.height)
    left = bounds["x"] + (bounds["width"] - WIDE.width * scale) / 2
    top = bounds["y"] + (bounds["height"] - WIDE.height * scale) / 2
    return left + pixel[0] * scale, top + pixel[1] * scale


def saved(page: Page) -> list[Annotation]:
    expect(page.locator(".save-words")).to_have_text(re.compile("All saved"))
    return list(Annotation.objects.order_by("person"))


def apart(one: int, other: int) -> int:
    """Positions between two places."""
    rows, columns = np.divmod([one, other], fisheye_folder.scene().grid.columns)
    return int(max(abs(rows[0] - rows[1]), abs(columns[0] - columns[1])))


def test_clicked_moved_saved_and_exported(opened: Page, dataset: Dataset, tmp_path: Path) -> None:
    position = clear_positions(1)[0]
    opened.mouse.click(*on_page(opened, at(position)))
    (placed,) = saved(opened)
    assert apart(placed.position, position) <= 4  # half a pixel of the screen
    before = at(placed.position)
    opened.keyboard.press("ArrowRight")
    opened.wait_for_timeout(100)
    (moved,) = saved(opened)
    assert apart(moved.position, placed.position) == 1
    way = at(moved.position) - before
    assert way[0] > abs(way[1])  # to the right on the screen
    folder = tmp_path / "export"
    layer = Assignment.objects.get().layer
    exporting.export_layer(layer, folder, tmp_path / "partial", lambda *_: None)
    (row,) = json.loads(next((folder / "annotations_positions").glob("*.json")).read_text())
    box, _ = rectangles(WIDE, dataset.grid, dataset.cylinder, dataset.rule, [moved.position])
    assert row["positionID"] == moved.position
    assert [row["views"][0][side] for side in ("xmin", "ymin", "xmax", "ymax")] == box[0].tolist()
    assert [one.model for one in load_cameras(folder / "cameras.json")] == ["fisheye", "pinhole"]
    lens = read_intrinsic(next((folder / "calibrations").glob("intrinsic*/intr_C1.xml")))
    assert (lens.model, lens.distortion.tolist()) == (CameraModel.FISHEYE, fisheye_folder.LENS.tolist())


def test_the_box_drawn_is_the_one_of_the_table(opened: Page, dataset: Dataset) -> None:
    for position in clear_positions(3):
        opened.mouse.click(*on_page(opened, at(position)))
        opened.keyboard.press("Escape")
    for person in saved(opened):
        box, visible = rectangles(WIDE, dataset.grid, dataset.cylinder, dataset.rule, [person.position])
        assert visible[0]
        middle = np.array([(box[0][0] + box[0][2]) / 2, (box[0][1] + box[0][3]) / 2])
        opened.mouse.click(*on_page(opened, middle))
        chosen = opened.locator('.people li[aria-selected="true"] .number')
        expect(chosen).to_have_text(str(person.person))


def test_somebody_is_dragged_by_the_foot(opened: Page) -> None:
    position, other = clear_positions(2)
    opened.mouse.click(*on_page(opened, at(position)))
    (placed,) = saved(opened)
    opened.mouse.move(*on_page(opened, at(placed.position)))
    opened.mouse.down()
    opened.mouse.move(*on_page(opened, at(other)), steps=6)
    opened.mouse.up()
    opened.wait_for_timeout(100)
    (moved,) = saved(opened)
    assert apart(moved.position, other) <= 6


def test_a_second_view_settles_the_place(opened: Page) -> None:
    position = next(one for one in clear_positions(10) if seen_by_both(one))
    grid = fisheye_folder.scene().grid
    x, y = grid.metres([position])[0]
    opened.mouse.click(*on_page(opened, at(position) + np.array([0, 2])))
    second = project(USUAL, [[x, y, 0.0]])[0]
    alt_click(opened, second)
    expect(opened.locator(".notice.beside")).to_contain_text("Best place for 2 views")
    (placed,) = saved(opened)
    assert apart(placed.position, position) <= 6


def alt_click(page: Page, pixel: np.ndarray) -> None:
    page.keyboard.down("Alt")
    page.mouse.click(*on_page(page, pixel, view=1))
    page.keyboard.up("Alt")


def seen_by_both(position: int) -> bool:
    grid = fisheye_folder.scene().grid
    x, y = grid.metres([position])[0]
    pixel = project(USUAL, [[x, y, 0.0]])[0]
    _box, visible = rectangles(USUAL, grid, Cylinder(0.16, 1.8), FootRule.CORNERS, [position])
    return bool(visible[0]) and bool(((pixel > 20) & (pixel < (940, 520))).all())


def test_a_click_where_nobodys_feet_can_be_says_so(opened: Page) -> None:
    opened.mouse.click(*on_page(opened, np.array([480, 20])))
    expect(opened.locator(".notice.beside")).to_contain_text("Nobody in the ground area")
    assert opened.locator(".people li .number").count() == 0


def test_heads_are_not_clicked_on_where_the_page_does_not_know_the_lens(opened: Page) -> None:
    opened.keyboard.press("y")
    opened.mouse.click(*on_page(opened, at(clear_positions(1)[0])))
    expect(opened.locator(".notice.beside")).to_contain_text("This page does not know the lens of C1")
    assert opened.locator(".people li .number").count() == 0


def test_nobody_gets_a_size_that_a_view_could_not_show(opened: Page) -> None:
    opened.mouse.click(*on_page(opened, at(clear_positions(1)[0])))
    opened.keyboard.press("PageUp")
    expect(opened.locator(".notices")).to_contain_text("does not know the lens of C1")
    assert [one.height for one in saved(opened)] == [None]


def test_somebody_who_came_with_a_size_of_their_own_is_drawn_with_it(
    page: Page, live_server: LiveServer, assignment: Assignment, dataset: Dataset
) -> None:
    position = clear_positions(1)[0]
    rows = [{"person": 1, "position": position, "state": "validated", "origin": "clicked"}]
    sized = [{**row, "height": 2.4, "radius": None} for row in rows]
    frame = dataset.frames.order_by("number")[0]
    save_frame(assignment.layer, frame, assignment.worker, uuid4(), 0, sized)
    asked: list[str] = []
    page.on("request", lambda request: "/rectangles/" in request.url and asked.append(request.url))
    go(page, live_server, assignment)
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    page.wait_for_timeout(500)
    box, _ = rectangles(WIDE, dataset.grid, Cylinder(0.16, 2.4), dataset.rule, [position])
    usual, _ = rectangles(WIDE, dataset.grid, dataset.cylinder, dataset.rule, [position])
    assert usual[0][1] - box[0][1] > 10
    above = np.array([(box[0][0] + box[0][2]) / 2, box[0][1] + 5])  # over the head of somebody of usual size
    page.mouse.click(*on_page(page, above))
    expect(page.locator('.people li[aria-selected="true"] .number')).to_have_text("1")
    assert len(asked) == 1


def test_border_grid_and_arrows_are_drawn_by_the_table(opened: Page) -> None:
    opened.mouse.click(*on_page(opened, at(clear_positions(1)[0])))
    before = opened.locator('[data-view="camera-0"]').screenshot()
    for key in ("t", "Shift+t", "h"):
        opened.keyboard.press(key)
    opened.wait_for_timeout(200)
    assert opened.locator('[data-view="camera-0"]').screenshot() != before


def test_while_the_table_is_on_its_way_the_page_says_so(
    page: Page, live_server: LiveServer, assignment: Assignment
) -> None:
    held: list[Route] = []
    page.route("**/grids/*", lambda route: held.append(route))
    go(page, live_server, assignment)
    expect(page.locator(".starting")).to_have_text("Loading what C1 sees…")
    while not held:
        page.wait_for_timeout(50)
    held[0].continue_()
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    page.unroute_all(behavior="ignoreErrors")


def test_a_table_that_does_not_arrive_can_be_asked_for_again(
    page: Page, live_server: LiveServer, assignment: Assignment
) -> None:
    page.route("**/grids/*", lambda route: route.abort())
    go(page, live_server, assignment)
    expect(page.locator(".start-problem")).to_contain_text("What C1 sees did not arrive")
    page.unroute("**/grids/*")
    page.get_by_role("button", name="Try again").click()
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
