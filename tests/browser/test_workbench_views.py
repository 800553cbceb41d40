"""Seeing: which views are shown and how large, bright and close; all of it remembered by the browser."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, Page, Route, expect

from gtm_hit.models import Image
from tests.browser.bench import Bench, best_view, pane_of, well_seen

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def width(pane: Locator) -> float:
    bounds = pane.bounding_box()
    assert bounds is not None
    return bounds["width"]


def test_a_double_click_makes_a_view_large_with_the_others_around_it(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    view, person = well_seen(opened.street)
    before = width(opened.pane(view))
    opened.page.mouse.dblclick(*opened.place_of(view, int(opened.street.truth[0][person])))
    expect(opened.pane(view)).to_have_class(LARGE)
    assert width(opened.pane(view)) > 1.6 * before
    assert len(opened.page.locator(".pane:visible").all()) == 8
    stage = opened.page.locator(".stage").bounding_box()
    assert stage is not None
    for pane in opened.page.locator(".pane").all():
        bounds = pane.bounding_box()
        assert bounds is not None
        assert bounds["width"] >= 120
        assert bounds["y"] + bounds["height"] <= stage["y"] + stage["height"] + 1


@pytest.mark.parametrize(("width", "height"), [(1280, 700), (1920, 980), (3840, 2060)])
def test_eight_views_with_a_large_one_leave_no_cell_empty(module_page: Page, width: int, height: int) -> None:
    script = """async (room) => {
      const { arrangeAround } = await import("/static/views/layout.js");
      return arrangeAround(8, room, 16 / 9);
    }"""
    found = module_page.evaluate(script, {"width": width, "height": height})
    taken = found["largeColumns"] * found["largeRows"] + 7
    assert found["columns"] * found["rows"] == taken
    assert found["largeColumns"] >= 2


def test_a_double_click_on_the_ground_leaves_nobody_behind(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    view, person = well_seen(opened.street)
    opened.page.mouse.dblclick(*opened.place_of(view, int(opened.street.truth[0][person])))
    expect(opened.pane(view)).to_have_class(LARGE)
    assert opened.rows() == []


def test_a_click_places_although_a_double_click_means_the_view(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    view, person = well_seen(opened.street)
    position = int(opened.street.truth[0][person])
    opened.click(view, position)
    assert opened.rows() == ["1"]
    other = next(index for index in range(4) if index != view)
    opened.pane(other).dblclick(position={"x": 30, "y": 8})  # sky: nothing is placed there
    assert opened.rows() == ["1"]


def test_v_makes_the_active_view_large_and_all_alike_again(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.pane(2).hover()
    opened.press("v")
    expect(opened.pane(2)).to_have_class(LARGE)
    opened.press("v")
    opened.page.wait_for_function(
        "() => new Set([...document.querySelectorAll('.pane')].map((pane) => pane.offsetWidth)).size === 1"
    )


def test_a_number_hides_a_view_and_shows_it_again(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("2")
    expect(opened.pane(1)).to_be_hidden()
    opened.press("2")
    expect(opened.pane(1)).to_be_visible()


def test_the_last_view_cannot_be_hidden(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press(*"12345678")
    assert opened.page.locator(".pane:visible").count() == 1
    assert "stays" in opened.page.locator(".notices").inner_text()


def test_hidden_and_large_views_are_remembered(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.pane(2).hover()
    opened.press("v", "1")
    opened.open()
    expect(opened.pane(0)).to_be_hidden()
    expect(opened.pane(2)).to_have_class(LARGE)
    opened.press("0")
    assert opened.page.locator(".pane:visible").count() == 8
    assert opened.page.locator(".pane.large").count() == 0


def test_a_hidden_view_comes_back_zoomed_with_the_others(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    view, _person = well_seen(opened.street)
    opened.press(str(view + 1))
    opened.open()  # the view has never been measured on this page
    opened.press("Tab", "z", str(view + 1))
    opened.painted()
    scale = opened.page.locator(f'[data-view="camera-{view}"]').get_attribute("data-zoom")
    assert scale is not None and float(scale) > 1.5


def test_each_view_has_its_own_brightness_contrast_and_gamma(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("u")
    menu = opened.page.get_by_role("region", name="Views")
    menu.get_by_role("slider", name="Brightness of C2").fill("1.5")
    menu.get_by_role("slider", name="Gamma of C2").fill("1.25")
    filters = opened.page.evaluate(FILTERS)
    assert filters["camera-1"] == 'url("#gamma-camera-1") brightness(1.5)'
    assert filters["camera-0"] == ""
    opened.open()
    assert opened.page.evaluate(FILTERS) == filters


def test_one_slider_sets_all_cameras_and_the_map_stays(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("u")
    opened.page.get_by_role("slider", name="Contrast of All cameras").fill("1.4")
    filters = opened.page.evaluate(FILTERS)
    assert filters.pop("map") == ""
    assert set(filters.values()) == {"contrast(1.4)"}
    opened.page.get_by_role("button", name="All cameras as it was").click()
    assert set(opened.page.evaluate(FILTERS).values()) == {""}


def test_escape_closes_the_menu_of_views_and_keys_annotate_again(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    opened.press("u")
    expect(opened.page.locator(".views-menu")).to_be_visible()  # the part arrives when it is asked for
    opened.press("Escape")
    expect(opened.page.locator(".views-menu")).to_be_hidden()
    opened.press("Tab")
    assert opened.selected() == "1"


def test_zooming_fetches_the_full_picture_and_shows_it(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    view = best_view(opened.stored()[0].position)
    expect(opened.pane(view)).to_have_attribute("data-picture", "ready")
    full = Image.objects.get(frame=opened.street.frames[0], camera__index=view).full_digest
    held: list[Route] = []
    opened.page.route(re.compile(full), lambda route: held.append(route))
    opened.press("Tab")
    with opened.page.expect_request(re.compile(full)):
        opened.press("z")
        opened.pane(view).hover()
        opened.page.mouse.wheel(0, -500)
    soft = picture_of(opened, view)
    for route in held:
        route.continue_()
    opened.page.wait_for_function(
        """([view, soft]) => document.querySelector(`[data-view="camera-${view}"] .pane-picture`)
            .toDataURL() !== soft""",
        arg=[view, soft],
    )


def test_the_wheel_zooms_around_the_pointer_and_a_drag_pans(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1, marked=False).open()
    pane = opened.pane(0)
    bounds = pane.bounding_box()
    assert bounds is not None
    x, y = bounds["x"] + bounds["width"] / 2, bounds["y"] + bounds["height"] * 0.2  # the horizon
    opened.page.mouse.move(x, y)
    opened.page.mouse.wheel(0, -400)
    opened.painted()
    assert float(pane.get_attribute("data-zoom") or 0) == pytest.approx(2.718, abs=0.05)
    before = picture_of(opened, 0)
    opened.page.mouse.down()
    opened.page.mouse.move(x + 90, y - 30, steps=4)
    opened.page.mouse.up()
    assert picture_of(opened, 0) != before
    assert opened.rows() == []


def picture_of(opened: Bench, view: int) -> str:
    opened.painted()
    return str(opened.pane(view).locator(".pane-picture").evaluate("(canvas) => canvas.toDataURL()"))


def test_the_page_is_dark_until_the_reader_wants_it_light(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    brightness = """() => getComputedStyle(document.body).backgroundColor.match(/[0-9]+/g).slice(0, 3)
        .reduce((sum, one) => sum + Number(one), 0)"""
    assert opened.page.evaluate(brightness) < 150
    opened.page.get_by_role("button", name="Dark or light").click()
    assert opened.page.evaluate(brightness) > 600
    opened.open()
    assert opened.page.evaluate(brightness) > 600


def test_boxes_and_numbers_fade_by_the_settings(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    view, _person = well_seen(opened.street)
    opened.painted()
    full = opened.page.evaluate(INK, view)
    opened.press(",")
    opened.page.locator("[data-setting=boxOpacity]").fill("0.3")
    opened.page.locator("[data-setting=labelOpacity]").fill("0")
    opened.painted()
    assert 0 < opened.page.evaluate(INK, view) < 0.6 * full


def test_the_metric_grid_is_drawn_and_remembered(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    view, _person = well_seen(opened.street)
    expect(opened.pane(view)).to_have_attribute("data-picture", "ready")
    opened.painted()
    before = opened.page.evaluate(LOOK, view)
    opened.press("Shift+t")
    opened.painted()
    with_grid = opened.page.evaluate(LOOK, view)
    assert with_grid != before
    opened.open()
    expect(opened.pane(view)).to_have_attribute("data-picture", "ready")
    opened.painted()
    assert opened.page.evaluate(LOOK, view) == with_grid


def test_choosing_somebody_in_the_list_brings_them_into_a_view_zoomed_by_hand(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=2).open()
    pane = pane_of(opened.page, 0)
    bounds = pane.bounding_box()
    assert bounds is not None
    opened.page.mouse.move(bounds["x"] + 4, bounds["y"] + bounds["height"] - 4)
    opened.page.mouse.wheel(0, -700)
    opened.painted()
    before = opened.page.evaluate(LOOK, 0)
    zoom = pane.get_attribute("data-zoom")
    opened.page.locator(".people li").first.click()
    opened.painted()
    assert opened.page.evaluate(LOOK, 0) != before
    assert pane.get_attribute("data-zoom") == zoom


LARGE = re.compile(r"\blarge\b")
FILTERS = """() => Object.fromEntries([...document.querySelectorAll(".pane")].map((pane) =>
  [pane.dataset.view, pane.querySelector(".pane-picture").style.filter]))"""
INK = """(view) => {
  const canvas = document.querySelector(`[data-view="camera-${view}"] .pane-marks`);
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let sum = 0;
  for (let index = 3; index < data.length; index += 4) sum += data[index];
  return sum;
}"""
LOOK = """(view) => document.querySelector(`[data-view="camera-${view}"] .pane-picture`).toDataURL()"""
