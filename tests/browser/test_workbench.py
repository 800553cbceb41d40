"""The workbench in a real Chromium, on the real server, with real keys and clicks."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Route, expect

from gtm_hit.models import LayerFrame
from tests.browser.bench import Bench, metres_apart, well_seen

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_eight_panes_of_one_size_fill_a_wide_screen(bench: Callable[..., Bench]) -> None:
    page = bench().open().page
    sizes = [box.bounding_box() for box in page.locator(".pane").all()]
    assert len(sizes) == 8
    assert len({(round(size["width"]), round(size["height"])) for size in sizes if size}) == 1


def test_a_click_on_feet_places_and_selects_a_new_person(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    view, person = well_seen(opened.street)
    position = int(opened.street.truth[0][person])
    opened.click(view, position)
    assert opened.rows() == ["1"]
    assert opened.selected() == "1"
    (stored,) = opened.stored()
    assert metres_apart(stored.position, position) < 0.1
    assert (stored.state, stored.origin) == ("validated", "clicked")


def test_a_click_on_a_foot_selects_instead_of_placing(bench: Callable[..., Bench]) -> None:
    opened = bench().open()
    view, person = well_seen(opened.street)
    opened.click(view, int(opened.street.truth[0][person]))
    assert opened.selected() == str(person + 1)
    assert len(opened.rows()) == 4


def test_shift_and_click_place_inside_somebodys_box(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    view, person = well_seen(opened.street)
    x, y = opened.place_of(view, int(opened.street.truth[0][person]))
    opened.page.keyboard.down("Shift")
    opened.page.mouse.click(x, y - 12)
    opened.page.keyboard.up("Shift")
    assert opened.selected() == "2"


def test_arrows_move_one_position_and_shift_ten(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    before = opened.stored()[0].position
    opened.press("Tab", "ArrowLeft")
    once = opened.stored()[0].position
    assert metres_apart(before, once) == pytest.approx(0.025, abs=1e-6)
    opened.press("Shift+ArrowLeft")
    page_words = opened.page.locator(".save-words")
    expect(page_words).to_have_text("All saved · r3")
    assert metres_apart(once, opened.stored()[0].position) == pytest.approx(0.25, abs=1e-6)


def test_left_moves_left_on_the_screen_in_the_view_under_the_pointer(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    view, _person = well_seen(opened.street)
    before = opened.stored()[0].position
    opened.pane(view).hover()
    opened.press("Tab", *["ArrowLeft"] * 8)
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2")
    after = opened.stored()[0].position
    assert opened.place_of(view, after)[0] < opened.place_of(view, before)[0]


def test_sixty_repeats_of_a_held_key_are_sixty_steps(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    before = opened.stored()[0].position
    opened.press("Tab")
    for _ in range(60):
        opened.page.keyboard.down("ArrowRight")  # without an up in between: auto-repeat
    opened.page.keyboard.up("ArrowRight")
    expect(opened.page.locator(".save-words")).to_have_text(re.compile(r"All saved · r[2-9]"))
    assert metres_apart(before, opened.stored()[0].position) == pytest.approx(1.5, abs=1e-6)


def test_moving_asks_the_server_for_nothing_but_the_save(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.saved()
    tables = '() => performance.getEntriesByName("grid file").length === 7'  # they come behind the pictures
    opened.page.wait_for_function(tables)
    opened.press("Tab")
    opened.page.wait_for_timeout(1500)  # with the first action the parts that few need come, once
    opened.page.wait_for_load_state("networkidle")
    asked: list[str] = []
    opened.page.on("request", lambda request: asked.append(request.url))
    opened.press(*["ArrowLeft"] * 10)
    opened.page.wait_for_timeout(300)
    assert asked == []


def test_tab_and_space_go_through_the_people(bench: Callable[..., Bench]) -> None:
    opened = bench(people=3).open()
    seen = []
    for key in ["Tab", "Tab", "Tab", "Tab", "Space"]:
        opened.press(key)
        seen.append(opened.selected())
    assert seen == ["1", "2", "3", "1", "3"]


def test_backspace_removes_and_undo_brings_back_what_redo_removes_again(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("Tab", "Backspace")
    expect(opened.page.locator(".people li")).to_have_count(1)
    opened.press("Control+z")
    expect(opened.page.locator(".people li")).to_have_count(2)
    assert opened.selected() == "1"
    opened.press("Control+y")
    expect(opened.page.locator(".people li")).to_have_count(1)
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2")
    assert [one.person for one in opened.stored()] == [2]


def test_a_person_removed_and_placed_anew_gets_a_number_nobody_had(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    view, person = well_seen(opened.street)
    opened.press("Tab", "Backspace")
    opened.click(view, int(opened.street.truth[0][person]))
    assert opened.rows() == ["2"]


def test_undo_survives_a_reload(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("Tab", "Backspace")
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2")
    opened.open()
    opened.press("Control+z")
    expect(opened.page.locator(".people li")).to_have_count(2)


def test_the_next_frame_starts_from_this_one_in_yellow(bench: Callable[..., Bench]) -> None:
    opened = bench(people=3).open()
    opened.press("n")
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")
    expect(opened.page.locator('.people li[data-state="carried"]')).to_have_count(3)
    opened.press("Tab", "e", "Tab", "ArrowUp")
    expect(opened.page.locator('.people li[data-state="carried"]')).to_have_count(1)
    expect(opened.page.locator(".save-words")).to_have_text(re.compile(r"All saved · r\d"))
    assert [one.state for one in opened.stored(1)] == ["validated", "validated", "carried"]
    assert LayerFrame.objects.get(layer=opened.assignment.layer, frame=opened.street.frames[0]).done


def test_leaving_with_yellow_people_asks_first(bench: Callable[..., Bench]) -> None:
    opened = bench(people=3).open()
    opened.press("n")
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")
    opened.press("n")
    expect(opened.page.get_by_role("dialog")).to_contain_text("3 people are still yellow")
    opened.page.get_by_role("button", name="Look at the first one").click()
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")
    assert opened.selected() == "1"
    opened.press("n")
    opened.page.get_by_role("button", name="All are right").click()
    expect(opened.page.locator(".place")).to_have_text("Frame 3 of 3")


def test_an_empty_frame_asks_whether_nobody_is_there(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    opened.press("n")
    expect(opened.page.get_by_role("dialog")).to_contain_text("Nobody is marked")
    opened.page.get_by_role("button", name="Yes, nobody is there").click()
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")
    opened.saved()
    head = LayerFrame.objects.get(layer=opened.assignment.layer, frame=opened.street.frames[0])
    assert (head.done, head.nobody) == (True, True)


def test_a_frame_visited_before_is_not_filled_again(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("n")
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")
    opened.press("Tab", "Backspace")
    opened.press("p", "n")
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")
    assert opened.rows() == ["2"]


def test_z_zooms_every_view_and_clicking_works_while_zoomed(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    view, _ = well_seen(opened.street)
    opened.press("Tab", "z")
    expect(opened.page.locator('[data-action="zoom"]')).to_have_attribute("aria-pressed", "true")
    bounds = opened.pane(view).bounding_box()
    assert bounds is not None
    middle = (bounds["x"] + bounds["width"] / 2, bounds["y"] + bounds["height"] / 2)
    opened.page.keyboard.down("Shift")
    opened.page.mouse.click(middle[0] + 150, middle[1] + 60)
    opened.page.keyboard.up("Shift")
    assert opened.selected() == "2"
    expect(opened.page.locator('[data-action="zoom"]')).to_have_attribute("aria-pressed", "true")


def test_a_click_above_the_horizon_gets_an_answer_beside_the_pointer(bench: Callable[..., Bench]) -> None:
    opened = bench(marked=False).open()
    bounds = opened.pane(6).bounding_box()
    assert bounds is not None
    for offset in (3, 12, 30):
        opened.page.mouse.click(bounds["x"] + bounds["width"] / 2, bounds["y"] + offset)
    expect(opened.page.locator(".notice.beside")).to_be_visible()
    expect(opened.page.locator(".notice.beside")).to_contain_text(re.compile("horizon|Outside"))
    assert opened.rows() == []


def test_nobody_can_be_placed_or_moved_onto_somebody(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    view, person = well_seen(opened.street)
    x, y = opened.place_of(view, int(opened.street.truth[0][person]))
    other = 2 if person == 0 else 1
    opened.page.locator(".people li").nth(other - 1).click()
    opened.page.mouse.click(x, y, button="right")
    message = opened.page.locator(".notice.beside")
    if message.is_visible():
        expect(message).to_contain_text(f"Person {person + 1}")
    opened.press("Tab")
    positions = [one.position for one in opened.stored()]
    assert len(set(positions)) == 2


def test_typing_keys_in_control_mode_moves_between_buttons(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("F6", "Tab")
    assert opened.selected() is None
    assert opened.page.evaluate("document.activeElement.tagName") == "BUTTON"
    opened.press("Escape", "Tab")
    expect(opened.page.locator('.people li[aria-selected="true"]')).to_have_count(1)


def test_a_view_whose_image_fails_offers_to_try_again(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1)
    broken = {"now": True}

    def serve(route: Route) -> None:
        if broken["now"]:
            route.fulfill(status=404, json={"code": "not_found", "message": "no such image", "details": None})
        else:
            route.continue_()

    opened.page.route("**/api/v1/images/**", serve)
    opened.open()
    retry = opened.pane(0).get_by_role("button", name="Try again")
    expect(retry).to_be_visible()
    broken["now"] = False
    retry.click()
    expect(opened.pane(0)).to_have_attribute("data-picture", "ready")


def test_after_the_last_frame_the_batch_is_submitted_and_the_code_shown(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, frames=2).open()
    opened.press("n")
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 2")
    opened.press("Tab", "e", "Tab", "e", "n")
    dialog = opened.page.get_by_role("dialog")
    expect(dialog).to_contain_text("All 2 frames are done")
    dialog.get_by_role("button", name="Submit").click()
    opened.page.wait_for_url("**/work/**")
    opened.assignment.refresh_from_db()
    assert opened.assignment.code is not None
    expect(opened.page.get_by_label(re.compile("completion code"))).to_have_value(opened.assignment.code)


def test_the_summary_leads_to_an_unfinished_frame(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, frames=3).open()
    opened.press("n")
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")
    opened.press("n")
    opened.page.get_by_role("button", name="Go on, come back later").click()
    expect(opened.page.locator(".place")).to_have_text("Frame 3 of 3")
    opened.press("Tab", "e", "Tab", "e", "n")
    dialog = opened.page.get_by_role("dialog")
    expect(dialog).to_contain_text("1 frame is not finished")
    expect(dialog.get_by_role("button", name="Submit")).to_be_disabled()
    dialog.get_by_role("button", name="Go to the first unfinished frame").click()
    expect(opened.page.locator(".place")).to_have_text("Frame 2 of 3")


def test_the_key_sheet_lists_every_key_of_the_table(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press("?")
    dialog = opened.page.get_by_role("dialog")
    for text in ["Backspace", "Tab", "Space", "one step to the left", "next frame"]:
        expect(dialog).to_contain_text(text)
    opened.press("Escape")
    expect(dialog).to_have_count(0)
