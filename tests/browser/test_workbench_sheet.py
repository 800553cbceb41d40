"""Everybody of a frame side by side: clicked on, refused, accepted, with proposals and without."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, expect

from gtm_hit.models import Refusal
from tests.browser.bench import Bench, metres_apart
from tests.browser.test_workbench_proposals import propose, ready

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

PEOPLE, FRAMES = 8, 3
FEET = (0.25, 0.66)  # of a cell's canvas: where its first tile shows the feet
ALL = PEOPLE + 1  # and one proposal of nobody


def open_sheet(made: Bench) -> Bench:
    made.press("Shift+S")
    expect(made.page.locator('.sheet[data-sharp="true"]')).to_be_visible()
    return made


def cells(made: Bench, state: str = "") -> Locator:
    made.painted()
    return made.page.locator(".sheet-cells li" + (f'[data-state="{state}"]' if state else ""))


def over(made: Bench, cell: Locator, right: float = 0, click: bool = False) -> None:
    """The pointer goes to the feet in the first tile, or so many pixels to the right of them."""
    bounds = cell.locator("canvas").bounding_box()
    assert bounds is not None
    x, y = bounds["x"] + FEET[0] * bounds["width"] + right, bounds["y"] + FEET[1] * bounds["height"]
    made.page.mouse.move(x, y)
    if click:
        made.page.mouse.click(x, y)


def frame_name(made: Bench, place: int) -> None:
    expect(made.page.locator(".sheet-head h2")).to_have_text(f"Everybody of frame {place} of {FRAMES}")


@pytest.fixture
def proposed(bench: Callable[..., Bench]) -> Bench:
    made = bench(people=PEOPLE, frames=FRAMES, marked=False)
    propose(made.street)
    return open_sheet(ready(made))


def test_a_click_moves_one_person_and_one_key_accepts_the_rest(proposed: Bench) -> None:
    assert cells(proposed).count() == ALL
    over(proposed, cells(proposed, "open").first, right=12, click=True)
    assert cells(proposed, "accepted").count() == 1
    proposed.press("Enter")
    assert cells(proposed, "accepted").count() == ALL
    assert sorted(row.origin for row in proposed.stored()) == ["clicked"] + ["proposed"] * PEOPLE
    proposed.press("Control+z")
    assert cells(proposed, "accepted").count() == 1
    proposed.press("Control+z")
    assert cells(proposed, "accepted").count() == 0


def test_the_doubtful_come_first(proposed: Bench) -> None:
    states = [cells(proposed).nth(place).get_attribute("data-state") for place in range(ALL)]
    assert states == ["doubtful"] * 2 + ["open"] * (ALL - 2)


def test_a_key_refuses_whoever_is_under_the_pointer_and_does_nothing_the_second_time(proposed: Bench) -> None:
    over(proposed, cells(proposed).first)
    proposed.press("Backspace", "Backspace")
    assert cells(proposed, "refused").count() == 1
    proposed.saved()
    assert Refusal.objects.count() == 1
    proposed.press("Control+z", "Backspace", "Enter")
    assert cells(proposed, "refused").count() == 1
    assert len(proposed.stored()) == ALL - 1


def test_a_click_brings_back_who_was_refused(proposed: Bench) -> None:
    over(proposed, cells(proposed).first)
    proposed.press("Backspace")
    over(proposed, cells(proposed, "refused").first, click=True)
    assert cells(proposed, "accepted").count() == 1
    assert cells(proposed, "refused").count() == 0


def test_a_correction_holds_in_the_next_frame_for_who_stands(proposed: Bench) -> None:
    truth = proposed.street.truth
    stands = next(person for person in range(1, PEOPLE) if truth[0][person] == truth[1][person])
    proposed.press("Enter")
    feet = int(truth[0][stands])
    person = min(proposed.stored(), key=lambda row: metres_apart(row.position, feet)).person
    cell = cells(proposed).filter(has=proposed.page.get_by_text(str(person), exact=True))
    over(proposed, cell, right=90, click=True)
    proposed.press("Enter")
    frame_name(proposed, 2)
    proposed.press("Enter")
    before, after = [
        next(row.position for row in proposed.stored(frame) if row.person == person) for frame in (0, 1)
    ]
    assert metres_apart(before, feet) > 0.15  # it was clicked away from there
    assert metres_apart(after, before) < metres_apart(after, feet)


def test_without_proposals_it_checks_who_was_carried_over(bench: Callable[..., Bench]) -> None:
    made = open_sheet(bench(people=4, frames=FRAMES).open())
    assert cells(made, "accepted").count() == 4
    made.press("Enter")  # nobody is left: on to the next frame
    frame_name(made, 2)
    assert cells(made, "open").count() == 4
    assert cells(made).locator(".sheet-state").all_inner_texts() == ["carried over"] * 4
    made.press("Shift+Enter")
    frame_name(made, 3)
    assert [row.state for row in made.stored(1)] == ["validated"] * 4


def test_by_keyboard_alone_somebody_is_gone_to_and_moved_by_one_position(bench: Callable[..., Bench]) -> None:
    made = open_sheet(bench(people=4, frames=FRAMES).open())
    before = {row.person: row.position for row in made.stored()}
    made.press("Tab", "ArrowRight")
    after = {row.person: row.position for row in made.stored()}
    [moved] = [person for person in before if before[person] != after[person]]
    assert metres_apart(before[moved], after[moved]) == pytest.approx(0.025)
    made.press("Escape")
    expect(made.page.locator(".sheet")).to_be_hidden()


def test_of_many_people_only_those_are_accepted_who_were_in_sight(bench: Callable[..., Bench]) -> None:
    made = bench(people=PEOPLE, frames=FRAMES, marked=False)
    propose(made.street)
    made.page.set_viewport_size({"width": 900, "height": 420})
    open_sheet(ready(made))
    made.press("Enter")
    some = cells(made, "accepted").count()
    assert 0 < some < ALL
    while cells(made, "accepted").count() < ALL:
        made.press("Enter")
    frame_name(made, 1)
    made.press("Enter")
    frame_name(made, 2)


def test_where_nobody_is_the_sheet_says_what_to_do(bench: Callable[..., Bench]) -> None:
    made = bench(people=4, frames=FRAMES, marked=False).open()
    made.press("Shift+S")
    expect(made.page.locator(".sheet-empty")).to_contain_text("Shift + S shows the views")
