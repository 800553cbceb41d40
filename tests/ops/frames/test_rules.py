from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.geometry.grid import Grid
from gtm_hit.ops.frames.rules import InvalidFrame, checked
from tests.work_scene import as_sent, row

GRID = Grid(400, 400, 0.025, -5.0, -5.0)


def places(
    annotations: object, *, done: bool = False, nobody: bool = False, seconds: object = 0
) -> list[str]:
    """Where something is wrong."""
    try:
        checked(annotations, GRID, done=done, nobody=nobody, seconds=seconds)
    except InvalidFrame as error:
        return [problem.place for problem in error.problems]
    return []


@pytest.mark.parametrize(
    ("values", "place"),
    [
        ({"position": 160_000}, "position"),
        ({"position": -1}, "position"),
        ({"position": 1.0}, "position"),
        ({"position": True}, "position"),
        ({"position": None}, "position"),
        ({"person": -1}, "person"),
        ({"person": 2**31}, "person"),
        ({"person": "1"}, "person"),
        ({"state": "guessed"}, "state"),
        ({"state": ["validated"]}, "state"),
        ({"origin": "\ud800"}, "origin"),
        ({"height": 0.2}, "height"),
        ({"height": 3.1}, "height"),
        ({"height": math.nan}, "height"),
        ({"height": "1.8"}, "height"),
        ({"radius": 0}, "radius"),
        ({"radius": math.inf}, "radius"),
        ({"radius": 10**400}, "radius"),
    ],
)
def test_an_impossible_value_is_named(values: dict[str, Any], place: str) -> None:
    assert places([row(**values)]) == [f"annotations[0].{place}"]


def test_all_problems_are_found_at_once() -> None:
    assert places([row(1, -1, height=9), 5, row(1, 5), {**row(2), "x": 1}], seconds=-1) == [
        "annotations[0].position",
        "annotations[0].height",
        "annotations[1]",
        "annotations[3]",
        "annotations[2].person",
        "seconds",
    ]


@pytest.mark.parametrize("annotations", [None, "people", {}, 7])
def test_annotations_must_be_a_list(annotations: object) -> None:
    assert places(annotations) == ["annotations"]


def test_a_frame_holds_at_most_five_hundred_people() -> None:
    assert places([row(person) for person in range(500)]) == []
    assert places([row(person) for person in range(501)]) == ["annotations"]


@pytest.mark.parametrize("seconds", [-1, math.nan, math.inf, 86_401, "5", None, True, 10**400])
def test_seconds_lie_within_a_day(seconds: object) -> None:
    assert places([], seconds=seconds) == ["seconds"]


def test_a_frame_with_carried_people_is_not_done() -> None:
    assert places([row(1), row(2, state="carried")], done=True) == ["done"]
    assert places([row(1), row(2, state="carried")]) == []


def test_an_empty_frame_is_done_when_nobody_is_confirmed() -> None:
    assert places([], done=True) == ["done"]
    assert places([], done=True, nobody=True) == []


def test_nobody_and_somebody_exclude_each_other() -> None:
    assert places([row()], nobody=True) == ["nobody"]


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda children: st.lists(children) | st.dictionaries(st.text(), children),
    max_leaves=10,
)


@given(
    st.lists(st.fixed_dictionaries({}, optional=dict.fromkeys(row(), json_values)) | json_values), json_values
)
def test_any_json_is_accepted_or_explained(annotations: list[Any], seconds: Any) -> None:
    for place in places(annotations, seconds=seconds):
        assert place


people = st.fixed_dictionaries(
    {
        "person": st.integers(0, 2**31 - 1),
        "position": st.integers(0, GRID.count - 1),
        "state": st.sampled_from(["validated", "carried"]),
        "origin": st.sampled_from(["clicked", "carried", "copied", "interpolated", "imported", "proposed"]),
        "height": st.none() | st.floats(0.3, 3),
        "radius": st.none() | st.floats(0.05, 2),
    }
)


@given(st.lists(people, unique_by=lambda person: person["person"], max_size=30), st.randoms())
def test_the_order_they_are_sent_in_does_not_matter(rows: list[dict[str, Any]], random: Any) -> None:
    shuffled = random.sample(rows, len(rows))
    found, _seconds = checked(shuffled, GRID, done=False, nobody=False, seconds=0)
    assert as_sent(found) == sorted(rows, key=lambda one: one["person"])


def test_too_many_problems_are_not_all_listed_and_long_words_not_quoted() -> None:
    keys = {f"{number:060d}": 1 for number in range(60_000)}
    with pytest.raises(InvalidFrame) as caught:
        checked([{**row(), **keys}], GRID, done=False, nobody=False, seconds=0)
    problems = caught.value.problems
    assert len(problems) == 201
    assert problems[-1].reason == "more than 200 problems, the rest is not listed"
    assert max(len(problem.reason) for problem in problems) < 100
