"""Who is who, over several frames: each change is shown before it is made, and is one step of undo."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from gtm_hit.models import Annotation
from tests.browser.bench import Bench
from tests.browser.modules import run
from tests.browser.street import annotate

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

LOOK = """
const store = new Store([0, 5, 10, 15], 5);
const history = new History(store);
for (const [number, places] of Object.entries(%s)) {
  store.install(Number(number), { people: new Map(Object.entries(places).map(([person, position]) =>
    [Number(person), annotation({ person: Number(person), position })])) }, "server");
}
store.open(%d);
const look = () => Object.fromEntries(store.numbers.map((number) => [number,
  Object.fromEntries([...store.people(number)].map(([person, { position }]) => [person, position]))]));
"""
MODULES = {
    "truth/store": "Store",
    "truth/history": "History",
    "truth/annotation": "annotation",
    "truth/identity": "plan",
}
TWO = {0: {1: 10, 2: 20}, 5: {1: 11, 2: 21}, 10: {1: 12, 2: 22}, 15: {1: 13}}


def planned(page: Page, people: dict[int, dict[int, int]], choice: dict[str, Any], here: int = 5) -> Any:
    """What a choice leads to, what undoing it leads back to, and what the plan says about itself."""
    wanted = {"scope": "everywhere", "keep": "present", "other": None, **choice}
    return run(
        page,
        MODULES,
        LOOK % (people, here)
        + f"""
        const before = JSON.stringify(look());
        const found = plan(store, {str(wanted).replace("None", "null")});
        if (!found.patch) return {{ problem: found.problem }};
        history.run(found.patch);
        const after = look();
        history.undo();
        return {{ after, both: found.both, next: store.nextPerson,
                 undone: JSON.stringify(look()) === before }};
        """,
    )


def frames(*people: dict[int, int]) -> dict[str, dict[str, int]]:
    return {
        str(5 * index): {str(person): place for person, place in one.items()}
        for index, one in enumerate(people)
    }


def test_renaming_gives_the_new_number_everywhere(module_page: Page) -> None:
    found = planned(module_page, TWO, {"kind": "rename", "person": 1, "other": 8})
    assert found["after"] == frames({8: 10, 2: 20}, {8: 11, 2: 21}, {8: 12, 2: 22}, {8: 13})
    assert found["undone"]


def test_renaming_can_begin_here(module_page: Page) -> None:
    found = planned(module_page, TWO, {"kind": "rename", "person": 1, "other": 8, "scope": "onwards"})
    assert found["after"] == frames({1: 10, 2: 20}, {8: 11, 2: 21}, {8: 12, 2: 22}, {8: 13})


@pytest.mark.parametrize(
    ("keep", "expected"),
    [
        ("present", [{2: 20}, {2: 21}, {2: 22}, {2: 13}]),
        ("moved", [{2: 10}, {2: 11}, {2: 12}, {2: 13}]),
        ("both", [{2: 10, 1: 20}, {2: 11, 1: 21}, {2: 12, 1: 22}, {2: 13}]),
    ],
)
def test_a_taken_number_is_a_clash_that_the_annotator_decides(
    module_page: Page, keep: str, expected: list[dict[int, int]]
) -> None:
    found = planned(module_page, TWO, {"kind": "rename", "person": 1, "other": 2, "keep": keep})
    assert found["both"] == [0, 5, 10]
    assert found["after"] == frames(*expected)
    assert found["undone"]


def test_a_number_somebody_had_is_never_given_to_somebody_else(module_page: Page) -> None:
    found = planned(module_page, TWO, {"kind": "rename", "person": 1, "other": 4})
    assert "never given twice" in found["problem"]
    assert "Free from 5 on" in found["problem"]


def test_splitting_gives_a_new_number_from_here_on(module_page: Page) -> None:
    found = planned(module_page, TWO, {"kind": "split", "person": 1})
    assert found["after"] == frames({1: 10, 2: 20}, {5: 11, 2: 21}, {5: 12, 2: 22}, {5: 13})
    assert found["undone"]
    assert found["next"] == 6, "the number is spent, also when the split is undone"


def test_there_is_nothing_to_split_in_the_first_frame_of_a_person(module_page: Page) -> None:
    assert "nothing to split" in planned(module_page, TWO, {"kind": "split", "person": 1}, here=0)["problem"]


def test_joining_makes_two_numbers_one_person(module_page: Page) -> None:
    parts = {0: {1: 10}, 5: {1: 11}, 10: {2: 12}, 15: {2: 13}}
    found = planned(module_page, parts, {"kind": "join", "person": 1, "other": 2})
    assert found["after"] == frames({1: 10}, {1: 11}, {1: 12}, {1: 13})
    assert found["undone"]


def test_swapping_exchanges_two_people_from_here_on(module_page: Page) -> None:
    found = planned(module_page, TWO, {"kind": "swap", "person": 1, "other": 2})
    assert found["after"] == frames({1: 10, 2: 20}, {2: 11, 1: 21}, {2: 12, 1: 22}, {2: 13})
    assert found["undone"]


@pytest.mark.parametrize(("scope", "left"), [("here", [0, 10, 15]), ("onwards", [0]), ("everywhere", [])])
def test_removing_reaches_as_far_as_said(module_page: Page, scope: str, left: list[int]) -> None:
    found = planned(module_page, TWO, {"kind": "remove", "person": 1, "scope": scope})
    assert [int(number) for number, people in found["after"].items() if "1" in people] == left
    assert found["undone"]


def test_renaming_shows_what_changes_and_undo_takes_all_of_it_back(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    opened.press("Tab", "r")
    dialog = opened.page.get_by_role("dialog")
    expect(dialog.get_by_role("button", name="Rename")).to_be_disabled()
    dialog.get_by_label("New number").fill("17")
    expect(dialog.locator(".change-list")).to_have_text("Frames 1–3: 1 becomes 17")
    expect(dialog.get_by_role("img", name=re.compile("After.*person 17 in 3 frames"))).to_be_visible()
    assert persons(opened) == [[1, 2, 3]] * 3, "nothing happens before it is agreed to"
    opened.press("Enter")
    expect(dialog).to_have_count(0)
    assert opened.selected() == "17"
    saved_with(opened, [[2, 3, 17]] * 3)
    opened.press("Control+z")
    saved_with(opened, [[1, 2, 3]] * 3)


def test_a_clash_can_become_a_swap_of_numbers(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    opened.press("Tab", "r")
    dialog = opened.page.get_by_role("dialog")
    dialog.get_by_label("New number").fill("2")
    expect(dialog.locator(".identity-clash")).to_contain_text("1 and 2 are both marked in 3 frames")
    dialog.get_by_label("Who stays").select_option("both")
    expect(dialog.locator(".change-list")).to_have_text("Frames 1–3: 1 becomes 2; 2 becomes 1")
    before = [place for _person, place in places(opened, 1)]
    dialog.get_by_role("button", name="Rename").click()
    saved_with(opened, [[1, 2, 3]] * 3)
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2")
    assert [place for _person, place in places(opened, 1)] == [before[1], before[0], before[2]]


def test_splitting_joining_and_back_by_undo(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    go_to(opened.page, 2)
    opened.press("Tab", "x")
    apply(opened.page, "Split", "Frames 2–3: 1 becomes 4")
    saved_with(opened, [[1, 2, 3], [2, 3, 4], [2, 3, 4]])
    assert opened.selected() == "4"
    opened.press("Shift+J")
    dialog = opened.page.get_by_role("dialog")
    dialog.get_by_label("The other person").select_option("1")
    expect(dialog.locator(".change-list")).to_have_text("Frame 1: 1 becomes 4")
    dialog.get_by_role("button", name="Join").click()
    saved_with(opened, [[2, 3, 4]] * 3)
    opened.press("Control+z", "Control+z")
    saved_with(opened, [[1, 2, 3]] * 3)


def test_swapping_offers_whoever_is_nearest_first(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    go_to(opened.page, 2)
    before = [places(opened, index) for index in range(3)]
    opened.press("Tab", "Shift+X")
    dialog = opened.page.get_by_role("dialog")
    other = int(dialog.get_by_label("The other person").input_value())
    dialog.get_by_role("button", name="Swap").click()
    expect(opened.page.locator(".notices")).to_contain_text("in 2 frames")
    opened.saved()
    assert places(opened, 0) == before[0]
    assert dict(places(opened, 1))[1] == dict(before[1])[other]
    assert dict(places(opened, 2))[other] == dict(before[2])[1]
    assert opened.selected() == str(other)


def test_removing_from_here_on_is_one_step_back(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    go_to(opened.page, 2)
    opened.press("Tab", "Shift+Delete")
    apply(opened.page, "Remove", "Frames 2–3: 1 is removed")
    saved_with(opened, [[1, 2, 3], [2, 3], [2, 3]])
    opened.press("Control+z")
    saved_with(opened, [[1, 2, 3]] * 3)


def test_escape_changes_nothing(bench: Callable[..., Bench]) -> None:
    opened = walked(bench)
    opened.press("Tab", "Shift+Delete")
    expect(opened.page.get_by_role("dialog")).to_be_visible()
    opened.press("Escape")
    expect(opened.page.get_by_role("dialog")).to_have_count(0)
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r1")
    assert persons(opened) == [[1, 2, 3]] * 3


def walked(bench: Callable[..., Bench], people: int = 3, frames: int = 3) -> Bench:
    """A batch in which everybody is validated everywhere."""
    made = bench(people=people, frames=frames, marked=False)
    for frame, truth in zip(made.street.frames, made.street.truth, strict=True):
        annotate(made.assignment, frame, truth)
    return made.open()


def go_to(page: Page, place: int) -> None:
    """Without saying that the frames before are done."""
    for _ in range(place - 1):
        page.keyboard.press("n")
    expect(page.locator("strong.place")).to_have_text(re.compile(f"Frame {place} of"))


def apply(page: Page, button: str, changes: str) -> None:
    dialog: Locator = page.get_by_role("dialog")
    expect(dialog.locator(".change-list")).to_have_text(changes)
    dialog.get_by_role("button", name=button).click()
    expect(dialog).to_have_count(0)


def places(opened: Bench, frame: int) -> list[tuple[int, int]]:
    rows = Annotation.objects.filter(layer=opened.assignment.layer, frame=opened.street.frames[frame])
    return list(rows.order_by("person").values_list("person", "position"))


def persons(opened: Bench) -> list[list[int]]:
    return [[person for person, _ in places(opened, index)] for index in range(len(opened.street.frames))]


def saved_with(opened: Bench, expected: list[list[int]]) -> None:
    """Wait until the server has exactly these people in the frames."""
    for _ in range(40):
        if persons(opened) == expected:
            break
        opened.page.wait_for_timeout(100)
    assert persons(opened) == expected
    opened.saved()
