"""The workbench's pure modules, run by the browser they are made for."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page

pytestmark = pytest.mark.browser

PEOPLE = """
const people = (places) => new Map(Object.entries(places).map(([person, position]) =>
  [Number(person), annotation({person: Number(person), position})]));
const places = (map) => Object.fromEntries([...map].map(([person, {position}]) => [person, position]));
"""


def run(page: Page, modules: dict[str, str], body: str) -> Any:
    """Evaluate a function body with names imported from modules of the workbench."""
    imports = "".join(
        f'const {{{names}}} = await import("/static/{module}.js");' for module, names in modules.items()
    )
    return page.evaluate(f"async () => {{ {imports} {body} }}")


def merged(page: Page, base: dict[int, int], ours: dict[int, int], theirs: dict[int, int]) -> Any:
    return run(
        page,
        {"truth/annotation": "annotation", "truth/merge": "mergePeople"},
        PEOPLE
        + f"""
        const result = mergePeople(people({base}), people({ours}), people({theirs}));
        return {{places: places(result.people), renumber: result.renumber,
                 conflicts: result.conflicts.map(({{person}}) => person)}};
        """,
    )


@pytest.mark.parametrize(
    ("base", "ours", "theirs", "expected"),
    [
        ({1: 10, 2: 20}, {1: 11, 2: 20}, {1: 10, 2: 21}, {"1": 11, "2": 21}),
        ({1: 10, 2: 20}, {2: 20}, {1: 10, 2: 21}, {"2": 21}),
        ({1: 10}, {1: 10, 2: 5}, {}, {"2": 5}),
        ({1: 10}, {1: 12}, {1: 12}, {"1": 12}),
    ],
)
def test_a_merge_takes_each_person_from_the_side_that_changed_it(
    module_page: Page,
    base: dict[int, int],
    ours: dict[int, int],
    theirs: dict[int, int],
    expected: dict[str, int],
) -> None:
    result = merged(module_page, base, ours, theirs)
    assert result == {"places": expected, "renumber": [], "conflicts": []}


@pytest.mark.parametrize(
    ("ours", "theirs"), [({1: 11}, {1: 12}), ({}, {1: 12}), ({1: 11}, {})], ids=["moved", "removed", "lost"]
)
def test_a_merge_asks_when_both_sides_changed_the_same_person(
    module_page: Page, ours: dict[int, int], theirs: dict[int, int]
) -> None:
    result = merged(module_page, {1: 10}, ours, theirs)
    assert result["conflicts"] == [1]
    assert result["places"] == {str(person): place for person, place in ours.items()}


def test_a_number_given_twice_means_two_people(module_page: Page) -> None:
    result = merged(module_page, {}, {1: 10}, {1: 99})
    assert result == {"places": {"1": 99}, "renumber": [1], "conflicts": []}


def test_undo_takes_back_everything_and_redo_brings_it_all_again(module_page: Page) -> None:
    steps = run(
        module_page,
        {
            "truth/store": "Store",
            "truth/history": "History",
            "truth/annotation": "asList",
            "truth/commands": "place, move, remove",
        },
        """
        const store = new Store([0, 5], 1);
        const history = new History(store);
        const seen = [];
        const look = () => seen.push(JSON.stringify([asList(store.people(0)), asList(store.people(5))]));
        const step = (patch) => { history.run({...patch, group: null}); look(); };
        look();
        step(place(store, {position: 10}));
        step(place(store, {position: 20}));
        step(move(store, 1, 11));
        store.open(5);
        step(place(store, {position: 30}));
        store.open(0);
        step(remove(store, 1));
        const there = [...seen];
        while (history.undo()) look();
        const back = seen.slice(there.length);
        while (history.redo()) look();
        return {there, back, again: seen.slice(there.length + back.length)};
        """,
    )
    assert steps["back"] == steps["there"][-2::-1]
    assert steps["again"] == steps["there"][1:]


def test_a_removed_validation_takes_the_done_mark_away_and_undo_restores_it(module_page: Page) -> None:
    done = run(
        module_page,
        {
            "truth/store": "Store",
            "truth/history": "History",
            "truth/commands": "place, remove",
            "truth/annotation": "annotation",
        },
        """
        const store = new Store([0], 1);
        const history = new History(store);
        const people = new Map([[1, annotation({person: 1, position: 4})]]);
        store.install(0, {people, done: true}, "server");
        const seen = [store.frame().done];
        history.run(remove(store, 1));
        seen.push(store.frame().done);
        history.undo();
        seen.push(store.frame().done);
        return seen;
        """,
    )
    assert done == [True, False, True]


def test_zooming_keeps_the_point_under_the_pointer(module_page: Page) -> None:
    far, back = run(
        module_page,
        {"views/transform": "Transform"},
        """
        const before = new Transform(0.3, 12, 40);
        const at = before.toSource(200, 120);
        const {x, y} = before.zoomAt(3.7, 200, 120).toPane(at.x, at.y);
        const round = before.toPane(at.x, at.y);
        return [Math.hypot(x - 200, y - 120), Math.hypot(round.x - 200, round.y - 120)];
        """,
    )
    assert far < 1e-9
    assert back < 1e-9


@pytest.mark.parametrize(
    ("width", "height", "expected"),
    [(1920, 1044, [3, 3, "cell"]), (1280, 764, [3, 3, "cell"]), (5120, 1400, [4, 2, "column"])],
)
def test_panes_are_laid_out_so_that_pictures_come_out_largest(
    module_page: Page, width: int, height: int, expected: list[Any]
) -> None:
    found = run(
        module_page,
        {"views/layout": "arrange"},
        f"""
        const {{columns, rows, panel}} = arrange(8, {{width: {width}, height: {height}}}, 16 / 9);
        return [columns, rows, panel];
        """,
    )
    assert found == expected
