"""Working over time, by real pointer and keyboard in the open workbench."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, expect

from gtm_hit.models import Assignment, LayerFrame
from gtm_hit.ops.work import assignments, workers
from tests.browser.bench import Bench, metres_apart
from tests.browser.street import annotate
from tests.local_start import until
from tests.work_scene import finish

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def frame_cell(opened: Bench, place: int) -> Locator:
    return opened.page.locator(".timeline-frame").nth(place - 1)


def at_frame(opened: Bench, place: int, of: int = 3) -> None:
    expect(opened.page.locator("strong.place")).to_have_text(f"Frame {place} of {of}")


def mark(opened: Bench, *frames: int, state: str = "validated") -> Bench:
    """The truth of these frames, saved before the workbench is opened."""
    for frame in frames:
        annotate(opened.assignment, opened.street.frames[frame], opened.street.truth[frame], state)
    return opened


def test_the_third_frame_expects_people_further_on_their_way(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=4), 1).open()
    frame_cell(opened, 3).click()
    at_frame(opened, 3)
    expect(opened.page.locator('.people li[data-state="carried"]')).to_have_count(4)
    for one, before, now in zip(opened.stored(2), *opened.street.truth[1:3], strict=True):
        assert metres_apart(one.position, int(now)) <= 0.08 * metres_apart(int(before), int(now)) + 0.05


def test_going_backwards_people_come_from_the_next_frame(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=2, marked=False), 2).open()
    frame_cell(opened, 2).click()
    expect(opened.page.locator('.people li[data-state="carried"]')).to_have_count(2)
    assert [one.position for one in opened.stored(1)] == [int(place) for place in opened.street.truth[2]]


def test_people_walk_in_from_the_accepted_batch_before_under_their_numbers(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=2, frames=20, marked=False)
    for index in range(8, 10):
        annotate(opened.assignment, opened.street.frames[index], opened.street.truth[index])
    finish(opened.assignment)
    Assignment.objects.update(state=Assignment.State.ACCEPTED)
    second = assignments.claim(workers.enter("link", "second"), opened.street.dataset)
    following = Bench(opened.page, opened.server, opened.street, second).open()
    expect(following.page.locator('.people li[data-state="carried"]')).to_have_count(2)
    assert following.rows() == ["1", "2"]
    for one, truth in zip(following.stored(10), following.street.truth[10], strict=True):
        assert metres_apart(one.position, int(truth)) < 0.1


def test_working_backwards_people_walk_in_from_the_accepted_batch_after(
    bench: Callable[..., Bench],
) -> None:
    opened = bench(people=2, frames=20, marked=False)
    second = assignments.claim(workers.enter("link", "second"), opened.street.dataset)
    for index in range(10, 12):
        annotate(second, opened.street.frames[index], opened.street.truth[index])
    finish(second)
    Assignment.objects.filter(pk=second.pk).update(state=Assignment.State.ACCEPTED)
    opened.open()
    frame_cell(opened, 10).click()
    expect(opened.page.locator('.people li[data-state="carried"]')).to_have_count(2)
    for one, truth in zip(opened.stored(9), opened.street.truth[9], strict=True):
        assert metres_apart(one.position, int(truth)) < 0.1


def test_guesses_are_made_anew_when_more_is_known(bench: Callable[..., Bench]) -> None:
    """Looked at too early, the third frame had only the first to go by."""
    opened = bench(people=1).open()
    frame_cell(opened, 3).click()
    expect(frame_cell(opened, 3)).to_have_attribute("data-state", "yellow")
    frame_cell(opened, 2).click()
    at_frame(opened, 2)
    opened.press("Tab", *["Shift+ArrowRight"] * 2)
    second = opened.stored(1)[0].position
    frame_cell(opened, 3).click()
    at_frame(opened, 3)
    opened.saved()
    first = int(opened.street.truth[0][0])
    third = opened.stored(2)[0]
    assert metres_apart(third.position, first) > 1.5 * metres_apart(second, first)
    assert third.state == "carried"


def test_undo_takes_back_that_a_frame_is_done_and_goes_there(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("n")
    at_frame(opened, 2)
    expect(frame_cell(opened, 1)).to_have_attribute("data-state", "done")
    opened.press("Control+z", "Control+z")
    at_frame(opened, 1)
    expect(frame_cell(opened, 1)).to_have_attribute("data-state", "open")
    opened.saved()
    assert not LayerFrame.objects.get(layer=opened.assignment.layer, frame=opened.street.frames[0]).done


def test_frame_states_can_be_undone_after_a_reload(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("n")
    at_frame(opened, 2)
    opened.saved()
    opened.open()
    expect(frame_cell(opened, 1)).to_have_attribute("data-state", "done")
    opened.press("Control+z", "Control+z")
    expect(frame_cell(opened, 1)).to_have_attribute("data-state", "open")


def test_missing_people_are_loaded_from_the_next_frame(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=3, marked=False), 1).open()
    opened.press("Tab", "Backspace", "j")
    expect(opened.page.locator(".notices .notice")).to_have_text("1 person loaded")
    assert opened.rows() == ["1", "2", "3"]


def test_one_person_is_copied_from_the_previous_frame(bench: Callable[..., Bench]) -> None:
    """The selected one, put back exactly where the person stood."""
    opened = mark(bench(people=2), 1).open()
    frame_cell(opened, 2).click()
    at_frame(opened, 2)
    opened.press("Tab", "c")
    expect(opened.page.locator('.people li[data-state="carried"] .number')).to_have_text("1")
    first, second = opened.stored(1)
    assert (first.position, first.origin) == (int(opened.street.truth[0][0]), "copied")
    assert (second.position, second.state) == (int(opened.street.truth[1][1]), "validated")


def test_a_missing_person_to_copy_is_chosen_from_those_who_are_missing(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=3, marked=False), 1).open()
    opened.press("Tab", "Backspace", "Tab", "Backspace", "Shift+C")
    expect(opened.page.get_by_role("dialog")).to_contain_text("Whom to copy from frame 2?")
    opened.page.get_by_role("dialog").get_by_role("button", name="2", exact=True).click()
    assert opened.rows() == ["2", "3"]


def test_all_missing_people_can_be_copied_exactly(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=2, marked=False), 1).open()
    opened.press("Tab", "Backspace", "Tab", "Backspace", "Shift+C", "Enter")
    assert opened.rows() == ["1", "2"]
    assert [one.position for one in opened.stored(0)] == [int(place) for place in opened.street.truth[1]]


def test_filling_shows_what_it_will_do_and_is_one_step(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=2, frames=4), 3).open()
    opened.press("Tab", "i")
    dialog = opened.page.get_by_role("dialog")
    expect(dialog).to_contain_text("On the straight line between the keyframes: frames 2, 3.")
    expect(frame_cell(opened, 2)).to_have_attribute("data-state", "empty")
    dialog.get_by_role("button", name="Fill 2 frames").click()
    expect(frame_cell(opened, 3)).to_have_attribute("data-state", "yellow")
    rows = [*opened.stored(1), *opened.stored(2)]
    assert [(one.person, one.state, one.origin) for one in rows] == [(1, "carried", "interpolated")] * 2
    opened.press("Control+z")
    expect(frame_cell(opened, 2)).to_have_attribute("data-state", "empty")
    expect(frame_cell(opened, 3)).to_have_attribute("data-state", "empty")


def test_everybody_can_be_filled_in_at_once(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=3, frames=4), 3).open()
    opened.press("i")
    opened.page.get_by_role("button", name="Fill in everybody").click()
    expect(frame_cell(opened, 2)).to_have_attribute("title", "Frame 2, 3 people, 3 yellow")
    opened.saved()
    for frame in (1, 2):
        for one, truth in zip(opened.stored(frame), opened.street.truth[frame], strict=True):
            assert metres_apart(one.position, int(truth)) <= 0.05  # they walk straight on


def test_moving_a_keyframe_moves_what_was_filled_in_beside_it(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=1), 2).open()
    opened.press("Tab", "i")
    expect(opened.page.locator("dialog:modal")).to_be_visible()
    opened.press("Enter")
    expect(frame_cell(opened, 2)).to_have_attribute("data-state", "yellow")
    before = opened.stored(1)[0].position
    opened.press(*["Shift+ArrowRight"] * 4)
    opened.page.wait_for_timeout(900)
    moved = metres_apart(before, opened.stored(1)[0].position)
    assert moved == pytest.approx(0.5, abs=0.03)  # half of four times ten positions


def test_a_person_in_one_frame_is_pointed_out_and_extended(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, marked=False)
    for frame, people in zip(opened.street.frames, (1, 2, 1), strict=True):
        positions = opened.street.truth[frame.number // 5][:people]
        annotate(opened.assignment, frame, positions)
    LayerFrame.objects.update(done=True)
    opened.open()
    opened.press("g")
    at_frame(opened, 2)
    expect(opened.page.locator(".notices .notice")).to_contain_text("Person 2 is in this frame only")
    assert opened.selected() == "2"
    opened.press("i")
    dialog = opened.page.get_by_role("dialog")
    expect(dialog).to_contain_text("2 of them are done now")
    dialog.get_by_role("button", name="Fill all frames of the batch").click()
    for place in (1, 3):
        expect(frame_cell(opened, place)).to_have_attribute("title", f"Frame {place}, 2 people, 1 yellow")


def test_the_next_thing_to_do_is_the_next_yellow_person_then_the_next_frame(
    bench: Callable[..., Bench],
) -> None:
    opened = mark(bench(people=2), 2).open()
    mark(opened, 1, state="carried").open()
    opened.press("g")
    at_frame(opened, 2)
    assert opened.selected() == "1"
    opened.press("e", "g")
    assert opened.selected() == "2"
    opened.press("e", "g")
    at_frame(opened, 3)


def test_playing_shows_every_frame_and_stops_at_the_last(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=2, frames=4), 1, 2, 3).open()
    opened.page.evaluate(
        """() => {
          const place = document.querySelector("strong.place");
          window.seen = [];
          new MutationObserver(() => window.seen.push(place.textContent)).observe(place, {childList: true});
        }"""
    )
    opened.press("k")
    expect(opened.page.locator('[data-action="play"]')).to_have_attribute("aria-pressed", "true")
    at_frame(opened, 4, of=4)
    expect(opened.page.locator('[data-action="play"]')).to_have_attribute("aria-pressed", "false")
    assert opened.page.evaluate("window.seen") == [f"Frame {place} of 4" for place in (2, 3, 4)]


def test_playing_carries_nobody_over_and_finishes_nothing(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2, frames=4).open()
    opened.press("k")
    at_frame(opened, 4, of=4)
    expect(opened.page.locator('[data-action="play"]')).to_have_attribute("aria-pressed", "false")
    expect(frame_cell(opened, 2)).to_have_attribute("data-state", "empty")
    expect(frame_cell(opened, 1)).to_have_attribute("data-state", "open")


def test_an_edit_stops_the_film(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=1, frames=4), 1, 2, 3).open()
    opened.press("Tab", "k", "ArrowLeft")
    expect(opened.page.locator('[data-action="play"]')).to_have_attribute("aria-pressed", "false")
    at_frame(opened, 1, of=4)


def test_the_scrubber_shows_the_frame_under_the_pointer(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press("Tab")
    boxes = [frame_cell(opened, place).bounding_box() for place in (1, 2, 3)]
    places = [(box["x"] + box["width"] / 2, box["y"] + 15) for box in boxes if box]
    opened.page.mouse.move(*places[0])
    opened.page.mouse.down()
    opened.page.mouse.move(*places[1], steps=4)
    at_frame(opened, 2)
    expect(opened.page.locator(".people li")).to_have_count(0)  # only looking
    opened.page.mouse.move(*places[2], steps=4)
    at_frame(opened, 3)
    opened.page.mouse.up()
    expect(opened.page.locator('.people li[data-state="carried"]')).to_have_count(2)
    assert opened.selected() == "1"


def test_the_timeline_says_what_every_frame_is_like(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=2), 1, state="carried").open()
    states = [frame_cell(opened, place).get_attribute("data-state") for place in (1, 2, 3)]
    assert states == ["open", "yellow", "empty"]
    opened.page.route("**/frames/*/", lambda route: route.abort())
    opened.press("Tab", "ArrowLeft")
    expect(frame_cell(opened, 1)).to_have_attribute("data-unsaved", "true")
    opened.page.unroute("**/frames/*/")
    expect(frame_cell(opened, 1)).to_have_attribute("data-unsaved", "false", timeout=10_000)


def test_the_timeline_is_a_slider_for_the_keyboard(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=1), 1, 2).open()
    slider = opened.page.get_by_role("slider", name="Frames")
    slider.focus()
    opened.press("End")
    at_frame(opened, 3)
    expect(slider).to_have_attribute("aria-valuetext", "Frame 3, 1 person, not done")
    opened.press("ArrowLeft")
    at_frame(opened, 2)


def test_looking_on_leaves_frames_as_they_are(bench: Callable[..., Bench]) -> None:
    opened = bench(people=2).open()
    opened.press(">")
    at_frame(opened, 2)
    expect(opened.page.locator(".people li")).to_have_count(0)
    opened.press("<")
    at_frame(opened, 1)
    expect(frame_cell(opened, 1)).to_have_attribute("data-state", "open")


def test_a_person_stays_selected_over_a_frame_where_nobody_is(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=2), 2).open()
    opened.press("Tab", "Tab", ">", ">")
    at_frame(opened, 3)
    assert opened.selected() == "2"


def pixels(opened: Bench, selector: str) -> int:
    """How many pixels of a canvas are painted."""
    opened.painted()
    return opened.page.evaluate(
        """(selector) => {
          const canvas = document.querySelector(selector);
          const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          let painted = 0;
          for (let i = 3; i < data.length; i += 4) if (data[i]) painted += 1;
          return painted;
        }""",
        selector,
    )


def test_the_strip_shows_the_selected_person_and_a_click_goes_there(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=2), 1, 2).open()
    opened.press("m")
    expect(opened.page.locator(".filmstrip-note")).to_contain_text("Select somebody")
    opened.press("Tab", "Tab")
    button = opened.page.get_by_role("button", name="Person 2 in frame 3")
    button.click()
    at_frame(opened, 3)
    assert opened.selected() == "2"
    assert pixels(opened, ".filmstrip canvas") > 10_000


def test_the_strip_is_remembered(bench: Callable[..., Bench]) -> None:
    opened = bench(people=1).open()
    opened.press("m")
    opened.open()
    expect(opened.page.locator(".filmstrip")).to_be_visible()
    opened.press("m")
    expect(opened.page.locator(".filmstrip")).to_be_hidden()


def test_paths_appear_in_the_views_on_demand(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=3), 1, 2).open()
    marks = '[data-view="camera-0"] .pane-marks'
    plain = pixels(opened, marks)
    opened.press("w", "w")
    expect(opened.page.locator(".notices .notice")).to_have_text("Paths: of everybody")
    assert until(lambda: pixels(opened, marks) > plain + 50, 10)
    opened.press("w")
    assert until(lambda: pixels(opened, marks) == plain, 10)


def test_the_map_shows_the_path_of_the_selected_person(bench: Callable[..., Bench]) -> None:
    opened = mark(bench(people=1), 1, 2).open()
    marks = '[data-view="map"] .pane-marks'
    opened.press("Tab", "Shift+W", "Shift+W")
    expect(opened.page.locator(".notices .notice")).to_have_text("Paths: none")
    without = pixels(opened, marks)
    opened.press("Shift+W")
    assert until(lambda: pixels(opened, marks) > without, 10)
