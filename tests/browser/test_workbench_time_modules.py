"""Carrying over, filling in and finding what is left: the pure modules, run by the browser."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page

pytestmark = pytest.mark.browser

# 100 × 80 positions of 10 cm; frames 0, 5, 10 … half a second apart; positions are written as [column, row].
SCENE = """
const {Grid} = await import("/static/geometry/grid.js");
const {annotation} = await import("/static/truth/annotation.js");
const {Store} = await import("/static/truth/store.js");
const grid = new Grid({columns: 100, rows: 80, step: 0.1, origin: [-5, 2]});
const neighbours = {before: [], after: []};
const scene = {grid, neighbours, metres: (p) => grid.metres(p), seconds: (n) => n / 10};
const at = ([column, row]) => row * 100 + column;
const cell = ({position}) => [position % 100, Math.floor(position / 100)];
const one = (person, place, values = {}) => annotation({person, position: at(place), ...values});
const people = (...all) => new Map(all.map((a) => [a.person, a]));
const frames = (...all) => {
  const store = new Store(all.map((_, index) => 5 * index), 50);
  all.forEach((list, index) => store.install(5 * index, {people: people(...list)}, "server"));
  return store;
};
const cells = (map) => Object.fromEntries([...map.values()].map((a) => [a.person, cell(a)]));
"""


def run(page: Page, modules: dict[str, str], body: str) -> Any:
    imports = "".join(
        f'const {{{names}}} = await import("/static/{module}.js");' for module, names in modules.items()
    )
    return page.evaluate(f"async () => {{ {SCENE} {imports} {body} }}")


def predicted(page: Page, sources: str, options: str = "{}", time: float = 1.5) -> Any:
    """Column and row of everybody at 1.5 s; sources are at 1.0, 0.5, 0 s."""
    return run(
        page,
        {"truth/propagation": "predictPeople"},
        f"""
        const sources = {sources}.map((list, index) => ({{time: {time} > 0 ? 1 - index / 2 : index / 2 + 0.5,
                                                          people: people(...list)}}));
        return cells(new Map(predictPeople(grid, {time}, sources, {options}).map((a) => [a.person, a])));
        """,
    )


def test_who_was_seen_once_is_carried_over_where_he_stood(module_page: Page) -> None:
    assert predicted(module_page, "[[one(1, [20, 30])]]") == {"1": [20, 30]}


def test_who_stood_still_stays(module_page: Page) -> None:
    assert predicted(module_page, "[[one(1, [20, 30])], [one(1, [20, 30])]]") == {"1": [20, 30]}


def test_who_walked_is_expected_a_little_less_than_a_step_further(module_page: Page) -> None:
    places = predicted(module_page, "[[one(1, [30, 30])], [one(1, [20, 34])]]")
    assert places == {"1": [39, 26]}  # 0.93 of (10, -4)


def test_an_evened_out_movement_of_three_frames_is_continued(module_page: Page) -> None:
    places = predicted(module_page, "[[one(1, [30, 30])], [one(1, [20, 30])], [one(1, [20, 30])]]")
    assert places == {"1": [35, 30]}  # 0.93 of 1 / (1 + 0.8) of the last step


def test_an_evened_out_movement_of_four_frames_is_continued(module_page: Page) -> None:
    sources = "[[one(1, [30, 30])], [one(1, [30, 30])], [one(1, [30, 30])], [one(1, [20, 30])]]"
    assert predicted(module_page, sources) == {"1": [32, 30]}  # 0.93 of 0.64 / (1 + 0.8 + 0.64) of 10


def test_who_only_seems_to_move_stays(module_page: Page) -> None:
    """Half a position of the grid in half a second: clicks are not better than that."""
    sources = "[[one(1, [21, 30])], [one(1, [20, 30])], [one(1, [20, 31])], [one(1, [20, 30])]]"
    assert predicted(module_page, sources) == {"1": [21, 30]}


def test_a_step_faster_than_people_walk_ends_the_movement_before_it(module_page: Page) -> None:
    sources = "[[one(1, [40, 30])], [one(1, [35, 30])], [one(1, [5, 30])], [one(1, [4, 30])]]"
    assert predicted(module_page, sources) == {"1": [45, 30]}


def test_going_backwards_the_movement_is_continued_backwards(module_page: Page) -> None:
    places = predicted(module_page, "[[one(1, [30, 30])], [one(1, [36, 30])]]", time=0)
    assert places == {"1": [24, 30]}


def test_yellow_people_come_nearest_first_and_keep_their_turn(module_page: Page) -> None:
    turns = run(
        module_page,
        {"workbench/people/queue": "Queue"},
        """
        const store = frames([one(1, [0, 0]), one(2, [50, 0]), one(3, [10, 0]), one(4, [60, 0])].map(
          (a) => annotation({...a, state: "carried"})));
        const tour = new Queue({scene, store});
        const walk = (from) => { const found = []; for (let next = tour.next(from); found.length < 4;
          next = tour.next(next.person)) found.push(next.person); return found; };
        const before = walk(null);
        store.apply([{frame: 0, person: 3, after: annotation({...store.person(3), position: at([58, 0])})}]);
        return [before, walk(null), walk(3)];
        """,
    )
    assert turns == [[1, 3, 2, 4], [1, 3, 2, 4], [2, 4, 1, 3]]


def test_nobody_is_expected_to_run_faster_than_people_walk(module_page: Page) -> None:
    """Half a second for 2 m: two people were mixed up."""
    assert predicted(module_page, "[[one(1, [40, 30])], [one(1, [20, 30])]]") == {"1": [40, 30]}


def test_predictions_stay_on_the_grid(module_page: Page) -> None:
    assert predicted(module_page, "[[one(1, [98, 78])], [one(1, [90, 70])]]") == {"1": [99, 79]}


def test_nobody_is_put_onto_somebody_elses_position(module_page: Page) -> None:
    places = predicted(
        module_page, "[[one(1, [20, 30]), one(2, [20, 30])]]", "{except: people(one(7, [20, 30]))}"
    )
    assert len({tuple(place) for place in [*places.values(), [20, 30]]}) == 3
    assert all(abs(column - 20) <= 1 and abs(row - 30) <= 1 for column, row in places.values())


def test_who_is_there_already_is_not_brought_again(module_page: Page) -> None:
    places = predicted(
        module_page, "[[one(1, [20, 30]), one(2, [50, 50])]]", "{except: people(one(1, [1, 1]))}"
    )
    assert places == {"2": [50, 50]}


def test_a_carried_person_keeps_the_height_and_is_to_be_looked_at(module_page: Page) -> None:
    result = run(
        module_page,
        {"truth/propagation": "predictPeople"},
        """
        const sources = [{time: 0, people: people(one(1, [5, 5], {height: 1.62, radius: 0.2}))}];
        return predictPeople(grid, 0.5, sources)[0];
        """,
    )
    assert (result["height"], result["radius"]) == (1.62, 0.2)
    assert (result["state"], result["origin"]) == ("carried", "carried")


def filled(page: Page, frames: str, person: int = 1) -> Any:
    return run(
        page,
        {"truth/keyframes": "fillEdits", "truth/merge": "same"},
        f"""
        const store = frames({frames});
        const edits = fillEdits(store, scene, {person});
        return edits.map(({{frame, after}}) => ({{frame, cell: cell(after), ...after}}));
        """,
    )


def test_between_keyframes_people_walk_on_the_straight_line(module_page: Page) -> None:
    edits = filled(module_page, "[one(1, [10, 10])], [], [], [one(1, [40, 16])]")
    assert [(edit["frame"], edit["cell"]) for edit in edits] == [(5, [20, 12]), (10, [30, 14])]
    assert {(edit["state"], edit["origin"]) for edit in edits} == {("carried", "interpolated")}


def test_filling_keeps_the_height(module_page: Page) -> None:
    edits = filled(module_page, "[one(1, [10, 10], {height: 1.5})], [], [one(1, [20, 10], {height: 1.5})]")
    assert [edit["height"] for edit in edits] == [1.5]


def test_validated_people_are_never_filled_over(module_page: Page) -> None:
    edits = filled(module_page, "[one(1, [10, 10])], [one(1, [50, 50])], [one(1, [30, 10])]")
    assert edits == []


def test_carried_people_between_keyframes_are_put_on_the_line(module_page: Page) -> None:
    edits = filled(
        module_page,
        "[one(1, [10, 10])], [one(1, [11, 10], {state: 'carried', origin: 'carried'})], [one(1, [30, 10])]",
    )
    assert [(edit["frame"], edit["cell"]) for edit in edits] == [(5, [20, 10])]


def test_somebody_standing_on_the_line_is_walked_around(module_page: Page) -> None:
    edits = filled(module_page, "[one(1, [10, 10])], [one(2, [20, 10])], [one(1, [30, 10])]")
    assert edits[0]["cell"] != [20, 10]
    assert max(abs(edits[0]["cell"][0] - 20), abs(edits[0]["cell"][1] - 10)) == 1


def test_a_moved_keyframe_takes_what_was_filled_beside_it_along(module_page: Page) -> None:
    """Frame 10 was looked at since: it stays, and nothing beyond it changes. One undo takes all back."""
    result = run(
        module_page,
        {
            "truth/keyframes": "fillEdits, withRefill",
            "truth/history": "History",
            "truth/commands": "fill, validate, move",
        },
        """
        const store = frames([one(1, [10, 10])], [], [], [], [one(1, [50, 10])]);
        const history = new History(store, (patch) => withRefill(store, scene, patch));
        const places = () => store.numbers.map((number) => cell(store.person(1, number)));
        history.run(fill(store, fillEdits(store, scene, 1)));
        store.open(10);
        history.run(validate(store, [1]));
        store.open(0);
        const before = places();
        history.run(move(store, 1, at([10, 30])));
        const after = places();
        history.undo();
        return {before, after, undone: places()};
        """,
    )
    assert result["before"] == [[10, 10], [20, 10], [30, 10], [40, 10], [50, 10]]
    assert result["after"] == [[10, 30], [20, 20], [30, 10], [40, 10], [50, 10]]
    assert result["undone"] == result["before"]


def test_a_keyframe_taken_away_lets_the_line_go_straight(module_page: Page) -> None:
    places = run(
        module_page,
        {
            "truth/keyframes": "fillEdits, withRefill",
            "truth/history": "History",
            "truth/commands": "fill, remove",
        },
        """
        const store = frames([one(1, [10, 10])], [], [one(1, [30, 50])], [], [one(1, [50, 10])]);
        const history = new History(store, (patch) => withRefill(store, scene, patch));
        history.run(fill(store, fillEdits(store, scene, 1)));
        store.open(10);
        history.run(remove(store, 1));
        return store.numbers.map((number) => store.person(1, number)).map((a) => a && cell(a));
        """,
    )
    assert places == [[10, 10], [20, 10], None, [40, 10], [50, 10]]


def test_numbers_of_another_batch_are_kept_only_where_they_are_free(module_page: Page) -> None:
    numbers = run(
        module_page,
        {"truth/sources": "withFreeNumbers"},
        """
        const store = frames([]);
        const brought = [one(7, [1, 1]), one(80, [2, 2]), one(60, [3, 3])];
        return withFreeNumbers(store, brought).map(({person}) => person);
        """,
    )
    assert numbers == [81, 80, 60]


def test_people_come_from_the_nearer_side(module_page: Page) -> None:
    sides = run(
        module_page,
        {"truth/sources": "nearestSide"},
        """
        const store = frames([one(1, [1, 1])], [], [], [one(2, [2, 2])], []);
        return [5, 10, 20].map((number) => nearestSide(store, scene, number).map((source) => source.number));
        """,
    )
    assert sides == [[0], [15], [15, 0]]


def tasks(page: Page, frames: str, current: int = 0) -> Any:
    """The next thing to do, and the one after it."""
    return run(
        page,
        {"truth/todo": "nextTask"},
        f"""
        const store = frames({frames});
        store.open({current});
        return nextTask(store, false);
        """,
    )


YELLOW = "{state: 'carried'}"


def test_a_yellow_person_here_comes_first(module_page: Page) -> None:
    task = tasks(module_page, f"[one(1, [1, 1]), one(2, [2, 2], {YELLOW})], [one(1, [1, 1], {YELLOW})]")
    assert (task["kind"], task["number"], task["person"]) == ("person", 0, 2)


def test_then_the_next_frame_with_something_left(module_page: Page) -> None:
    task = tasks(module_page, f"[one(1, [1, 1])], [one(1, [1, 1])], [one(1, [1, 1], {YELLOW})]")
    assert (task["kind"], task["number"], task["person"]) == ("person", 10, 1)


def test_frames_before_this_one_are_not_forgotten(module_page: Page) -> None:
    task = tasks(module_page, "[], [one(1, [1, 1])], [one(1, [1, 1])]", current=10)
    assert (task["kind"], task["number"], task["left"]) == ("frame", 0, "empty")


def test_somebody_in_one_frame_only_is_pointed_out_last(module_page: Page) -> None:
    task = tasks(module_page, "[one(1, [1, 1])], [one(1, [1, 1]), one(2, [5, 5])], [one(1, [1, 1])]")
    assert (task["kind"], task["number"], task["person"]) == ("single", 5, 2)


def test_when_all_is_done_there_is_nothing_left(module_page: Page) -> None:
    assert tasks(module_page, "[one(1, [1, 1])], [one(1, [1, 1])]") is None


def test_steps_of_a_path_are_told_apart(module_page: Page) -> None:
    kinds = run(
        module_page,
        {"views/paths": "trail, kindOfStep"},
        f"""
        const yellow = one(1, [3, 3], {YELLOW});
        const store = frames([one(1, [1, 1])], [one(1, [2, 2])], [yellow], [], [one(1, [4, 4])]);
        const steps = trail(store, 1);
        return steps.slice(1).map((step, index) => kindOfStep(store, steps[index], step));
        """,
    )
    assert kinds == ["validated", "carried", "missing"]


def test_the_views_that_show_a_person_whole_and_tall_are_chosen(module_page: Page) -> None:
    chosen = run(
        module_page,
        {"views/crops": "bestViews"},
        """
        const box = (xmin, ymin, xmax, ymax) => ({xmin, ymin, xmax, ymax});
        const boxes = [box(10, 10, 30, 60), null, box(90, 10, 150, 210), box(10, 10, 40, 90),
                       box(10, 10, 20, 40)];
        const seen = {cameras: boxes.map(() => ({width: 100, height: 100})), rectangles: () => boxes};
        return bestViews(seen, [one(1, [1, 1])], 3);
        """,
    )
    assert chosen == [0, 3, 4]
