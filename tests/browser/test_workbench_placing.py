"""Placing with evidence: the ghost before a click, several views for one place, sizes, and the settings."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from django.contrib.auth.models import User
from django.test import Client
from playwright.sync_api import Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.geometry.camera import project
from gtm_hit.geometry.cylinder import HEIGHTS, RADII, Cylinder, FootRule, rectangles
from gtm_hit.models import Annotation, Frame, Layer
from tests.browser.bench import Bench, best_view, metres_apart, well_seen
from tests.browser.modules import run
from tests.browser.street import CYLINDER, FRAME_STEP, GRID, annotate, cameras, make_street
from tests.browser.test_workbench_moving import all_saved

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

CYAN = (47, 227, 247)
RED = (255, 143, 134)


def coloured(opened: Bench, view: str, colour: tuple[int, int, int]) -> int:
    """How many pixels of a view's marks have a colour."""
    opened.painted()
    return int(
        opened.page.locator(f'[data-view="{view}"] .pane-marks').evaluate(
            """(canvas, wanted) => {
                const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
                const like = (i) => wanted.every((value, c) => Math.abs(data[i + c] - value) < 12);
                let found = 0;
                for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200 && like(i)) found += 1;
                return found;
            }""",
            list(colour),
        )
    )


def views_showing(position: int) -> list[int]:
    cylinder = [
        rectangles(camera, GRID, CYLINDER, FootRule.CORNERS, np.array([position])) for camera in cameras()
    ]
    return [index for index, (_boxes, visible) in enumerate(cylinder) if visible[0]]


def pixel(view: int, position: int) -> Any:
    x, y = GRID.metres([position])[0]
    return project(cameras()[view], [[x, y, 0.0]])[0]


def two_views(position: int) -> tuple[int, int]:
    """Two views that have the position well inside their picture."""
    first = best_view(position)
    others = [view for view in views_showing(position) if view != first]
    inside = [
        view
        for view in others
        if (pixel(view, position) > 40).all() and (pixel(view, position) < (1880, 1040)).all()
    ]
    return first, inside[0]


def well_seen_twice(opened: Bench) -> tuple[int, int, int]:
    for position in opened.street.truth[0]:
        try:
            first, second = two_views(int(position))
        except IndexError:
            continue
        if np.linalg.norm(cameras()[first].centre[:2] - cameras()[second].centre[:2]) > 3:
            return int(position), first, second
    raise AssertionError("nobody is seen well by two views")


def alt_click(page: Page, x: float, y: float) -> None:
    page.keyboard.down("Alt")
    page.mouse.click(x, y)
    page.keyboard.up("Alt")


def test_the_cylinder_shows_in_all_views_before_anything_is_placed(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    view, person = well_seen(opened.street)
    position = int(opened.street.truth[0][person])
    opened.page.mouse.move(*opened.place_of(view, position))
    for seeing in views_showing(position):
        assert coloured(opened, f"camera-{seeing}", CYAN) > 20
    assert coloured(opened, "map", CYAN) > 20
    assert opened.rows() == []
    opened.page.mouse.move(5, 5)
    assert coloured(opened, "map", CYAN) == 0


def test_the_ghost_can_be_switched_off(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    view, person = well_seen(opened.street)
    opened.press(",")
    opened.page.get_by_label("Show what a click would place").uncheck()
    opened.press("Escape")
    opened.page.mouse.move(*opened.place_of(view, int(opened.street.truth[0][person])))
    assert coloured(opened, "map", CYAN) == 0


def test_over_an_occupied_position_the_ghost_warns_in_every_view(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    position = int(opened.street.truth[0][0])
    opened.page.keyboard.down("Shift")
    opened.page.mouse.move(*opened.place_of(best_view(position), position))
    for seeing in views_showing(position):
        assert coloured(opened, f"camera-{seeing}", RED) > 20
    opened.page.keyboard.up("Shift")


@pytest.mark.parametrize(
    ("ground", "words"),
    [
        ("null", ["above the horizon"]),
        ("{x: 3, y: 4}", ["x 3.000  y 4.000 m"]),
        ("{x: 3, y: -8.75}", ["x 3.000  y -8.750 m", "0.26 m to the border"]),
        ("{x: 3, y: -9.5}", ["x 3.000  y -9.500 m", "0.49 m outside the ground area"]),
        ("{x: 0, y: 0}", ["x 0.000  y 0.000 m", "person 7 stands exactly here"]),
    ],
)
def test_the_ghost_says_where_it_is_and_what_speaks_against_it(
    module_page: Page, ground: str, words: list[str]
) -> None:
    said = run(
        module_page,
        {"truth/ground_point": "spotOn, spotWords", "geometry/grid": "Grid"},
        f"""
        const grid = new Grid({{columns: 480, rows: 1440, step: 0.025, origin: [-3, -9]}});
        const scene = {{
          grid,
          metres: (position) => grid.metres(position),
          positionAt: ({{x, y}}) => (grid.position(x, y) < 0 ? null : grid.position(x, y)),
        }};
        const store = {{occupant: (position) => (position === grid.position(0, 0) ? {{person: 7}} : null)}};
        return spotWords(scene, spotOn(scene, store, {ground}));
        """,
    )
    assert said == words


def test_a_second_view_places_better_and_says_how_far_each_click_is_off(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    position, first, second = well_seen_twice(opened)
    x, y = opened.place_of(first, position)
    opened.page.mouse.click(x, y - 3)  # a few centimetres to decimetres too deep
    assert opened.selected() == "1"
    once = opened.stored()[0].position
    alt_click(opened.page, *opened.place_of(second, position))
    message = opened.page.locator(".notice.beside")
    expect(message).to_contain_text("Best place for 2 views")
    expect(message).to_contain_text(re.compile(rf"C{first + 1} \d+\.\d px, C{second + 1} \d+\.\d px"))
    all_saved(opened)
    assert metres_apart(opened.stored()[0].position, position) < metres_apart(once, position)
    assert coloured(opened, f"camera-{second}", CYAN) > 0


def test_clicks_that_do_not_fit_ask_to_check_them_or_the_calibration(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    position, first, second = well_seen_twice(opened)
    opened.click(first, position)
    x, y = opened.place_of(second, position)
    alt_click(opened.page, x + 60, y)
    expect(opened.page.locator(".notice.beside")).to_contain_text(
        re.compile(r"check this click or the calibration of C\d")
    )
    assert coloured(opened, f"camera-{first}", RED) + coloured(opened, f"camera-{second}", RED) > 0


def test_a_first_click_with_the_modifier_moves_and_asks_for_the_second(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press("Tab")
    position = int(opened.street.truth[0][0])
    x, y = opened.place_of(best_view(position), position)
    alt_click(opened.page, x + 20, y)
    expect(opened.page.locator(".notice.beside")).to_contain_text("another view")
    all_saved(opened)
    assert opened.stored()[0].position != position


def marked_in_all_frames(bench: Callable[..., Bench]) -> Bench:
    opened = bench(people=2)
    for frame in (1, 2):
        annotate(opened.assignment, opened.street.frames[frame], opened.street.truth[frame])
    return opened.open()


def test_a_height_is_kept_in_all_later_frames_and_undone_at_once(bench: Callable[..., Bench]) -> None:
    opened = marked_in_all_frames(bench)
    opened.press("Tab", "Shift+BracketRight", "Shift+BracketRight", "PageUp", "PageDown", "PageUp")
    expect(opened.page.locator(".people li .size").first).to_have_text("1.86 m")
    all_saved(opened)
    assert [opened.stored(frame)[0].height for frame in range(3)] == pytest.approx([1.86] * 3)
    assert [opened.stored(frame)[1].height for frame in range(3)] == [None] * 3
    opened.press("Control+z")
    expect(opened.page.locator(".people li .size").first).to_have_text("")
    all_saved(opened)
    assert [opened.stored(frame)[0].height for frame in range(3)] == [None] * 3


def test_earlier_frames_keep_their_height(bench: Callable[..., Bench]) -> None:
    opened = marked_in_all_frames(bench)
    opened.page.locator(".timeline-frame").nth(1).click()
    expect(opened.page.locator("strong.place")).to_have_text("Frame 2 of 3")
    opened.press("Tab", "Shift+BracketLeft", "]")
    all_saved(opened)
    assert [opened.stored(frame)[0].height for frame in range(3)] == [
        None,
        pytest.approx(1.78),
        pytest.approx(1.78),
    ]
    assert opened.stored(1)[0].radius == pytest.approx(0.17)
    opened.press("\\")
    all_saved(opened)
    assert [(one.height, one.radius) for one in opened.stored(2)] == [(None, None)] * 2


def test_the_boxes_follow_a_width_exactly(bench: Callable[..., Bench]) -> None:
    """Where the painted box ends in a view is where the rule puts the end of the wider cylinder."""
    opened = bench(people=1).open()
    position = opened.stored()[0].position
    view = best_view(position)
    opened.press("Tab", *["]"] * 8)
    all_saved(opened)
    radius = opened.stored()[0].radius
    assert radius == pytest.approx(CYLINDER.radius + 0.08)
    wide = Cylinder(radius=radius, height=CYLINDER.height)
    boxes, _visible = rectangles(cameras()[view], GRID, wide, FootRule.CORNERS, np.array([position]))
    pane = opened.pane(view)
    bounds = pane.bounding_box()
    assert bounds is not None
    scale = min(bounds["width"] / 1920, bounds["height"] / 1080)
    left = (bounds["width"] - 1920 * scale) / 2
    across = pane.locator(".pane-marks").evaluate(
        """(canvas, [r, g, b]) => {
            const {data, width} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            const xs = [];
            for (let i = 0; i < data.length; i += 4) {
                const off = Math.hypot(data[i] - r, data[i + 1] - g, data[i + 2] - b);
                if (data[i + 3] > 200 && off < 20) xs.push((i / 4) % width);
            }
            return [Math.min(...xs), Math.max(...xs)];
        }""",
        list(CYAN),
    )
    xmin, _ymin, xmax, _ymax = (int(value) for value in boxes[0])
    assert across == pytest.approx([left + xmin * scale, left + xmax * scale], abs=6)


def test_the_usual_size_is_not_stored_as_a_size_of_ones_own(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press("Tab", "Shift+BracketRight", "Shift+BracketLeft", "ArrowLeft")
    all_saved(opened)
    assert opened.stored()[0].height is None


def test_a_height_is_carried_over_to_a_frame_that_starts_from_this_one(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press("Tab", "Shift+BracketLeft", "n")
    expect(opened.page.locator("strong.place")).to_have_text("Frame 2 of 3")
    expect(opened.page.locator(".people li .size")).to_have_text("1.78 m")


def test_the_top_of_the_selected_box_is_dragged_to_the_head(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    position = int(opened.street.truth[0][0])
    view = best_view(position)
    opened.press("Tab")
    bounds = opened.pane(view).bounding_box()
    assert bounds is not None
    scale = min(bounds["width"] / 1920, bounds["height"] / 1080)
    x, _ = opened.place_of(view, position)
    foot = pixel(view, position)
    _, top = opened.place_of(view, position)
    ymin = box_top(view, position, CYLINDER)
    y = top + (ymin - foot[1]) * scale
    opened.page.mouse.move(x, y)
    expect(opened.pane(view)).to_have_attribute("data-grip", "top")
    opened.page.mouse.down()
    opened.page.mouse.move(x, y + 6)
    opened.page.mouse.move(x, y + 12)
    opened.page.mouse.up()
    all_saved(opened)
    stored: Annotation = opened.stored()[0]
    assert stored.position == position
    assert stored.height is not None
    reached = box_top(view, position, Cylinder(CYLINDER.radius, stored.height))
    assert reached == pytest.approx(ymin + 12 / scale, abs=4)


def box_top(view: int, position: int, cylinder: Cylinder) -> int:
    boxes, _ = rectangles(cameras()[view], GRID, cylinder, FootRule.CORNERS, np.array([position]))
    return int(boxes[0][1])


def test_settings_are_remembered_by_the_browser(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press(",")
    dialog = opened.page.get_by_role("dialog")
    dialog.get_by_label("Arrow keys follow").select_option("the axes of the ground, in every view")
    dialog.get_by_label("Show what a click would place").uncheck()
    opened.press("Escape")
    opened.open().press(",")
    expect(dialog.get_by_label("Arrow keys follow")).to_have_value("the axes of the ground, in every view")
    expect(dialog.get_by_label("Show what a click would place")).not_to_be_checked()
    dialog.get_by_role("button", name="Reset to defaults").click()
    expect(dialog.get_by_label("Show what a click would place")).to_be_checked()
    dialog.get_by_role("button", name="Close").click()
    expect(dialog).to_have_count(0)


def test_a_stored_setting_that_fits_no_more_falls_back_to_the_default(module_page: Page) -> None:
    values = run(
        module_page,
        {"workbench/settings": "Settings"},
        """
        localStorage.setItem("gtm-workbench-arrowAxes", '"sideways"');
        localStorage.setItem("gtm-workbench-ghost", "{broken");
        const settings = new Settings();
        return [settings.get("arrowAxes"), settings.get("ghost")];
        """,
    )
    assert values == ["screen", True]


def test_a_setting_tells_who_watches_it_and_refuses_what_it_cannot_be(module_page: Page) -> None:
    result = run(
        module_page,
        {"workbench/settings": "Settings"},
        """
        const settings = new Settings();
        const heard = [];
        const stop = settings.watch("ghost", (value) => heard.push(value));
        settings.set("ghost", false);
        stop();
        settings.reset("ghost");
        let refused = false;
        try { settings.set("arrowAxes", "sideways"); } catch { refused = true; }
        return {heard, refused};
        """,
    )
    assert result == {"heard": [True, False], "refused": True}


def test_a_height_reaches_frames_of_a_long_layer_that_were_not_loaded_yet(
    page: Page, client: Client, live_server: LiveServer
) -> None:
    street = make_street(people=1, frames=1)
    later = Frame.objects.bulk_create(
        Frame(dataset=street.dataset, number=FRAME_STEP * index) for index in range(1, 50)
    )
    layer = Layer.objects.create(dataset=street.dataset, name="review", kind=Layer.Kind.STAFF, last_person=1)
    position = int(street.truth[0][0])
    Annotation.objects.bulk_create(
        Annotation(layer=layer, frame=frame, person=1, position=position)
        for frame in [*street.frames, *later]
    )
    client.force_login(User.objects.create_user("vera", is_superuser=True))
    session = client.cookies["sessionid"].value
    page.context.add_cookies([{"name": "sessionid", "value": session, "url": live_server.url}])
    page.goto(f"{live_server.url}/datasets/street/layers/review/")
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    page.keyboard.press("Tab")
    page.keyboard.press("PageUp")
    expect(page.locator(".people li .size")).to_have_text("1.82 m")
    page.keyboard.press("s")
    expect(page.get_by_text("Everything is saved").first).to_be_attached()
    assert set(Annotation.objects.filter(layer=layer).values_list("height", flat=True)) == {1.82}


@pytest.mark.parametrize(("before", "keys", "after"), [(2.8, 1, 2.82), (3.0, 2, 3.0)], ids=["2.8 m", "3 m"])
def test_taller_never_makes_a_very_tall_person_smaller(
    bench: Callable[..., Bench], before: float, keys: int, after: float
) -> None:
    opened = bench(frames=1)
    Annotation.objects.filter(layer=opened.assignment.layer, person=1).update(height=before)
    opened.open()
    opened.press("Tab", *["PageUp"] * keys)
    expect(opened.page.locator(".notice").last).to_contain_text(" m tall")
    assert opened.stored()[0].height == pytest.approx(after)


def test_the_sizes_a_person_may_have_are_the_servers(bench: Callable[..., Bench]) -> None:
    opened = bench(frames=1)
    with opened.page.expect_response("**/scene/") as answer:
        opened.open()
    assert answer.value.json()["sizes"] == {"height": list(HEIGHTS), "radius": list(RADII)}
