from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from gtm_hit.geometry.grid import Grid
from gtm_hit.ops.tutorial.exercise import (
    LONELY,
    SHIFT,
    Exercise,
    NoRoom,
    Positions,
    between,
    make_exercise,
)

GRID = Grid(400, 400, 0.025, -5.0, -5.0)


def equally_well(places: list[int], others: list[int]) -> NDArray[np.int64]:
    return np.full(len(places), 7)


def exercise(*truth: Positions, grid: Grid = GRID) -> Exercise:
    return make_exercise([0, 5, 10], list(truth), grid, equally_well)


positions = st.integers(0, GRID.count - 1)
crowds = st.dictionaries(st.integers(0, 60), positions, min_size=3, max_size=30)


@st.composite
def walks(draw: st.DrawFn) -> list[Positions]:
    """Three frames with the same people at any places."""
    first = draw(crowds)
    return [first, *({person: draw(positions) for person in first} for _frame in range(2))]


@given(walks())
def test_the_first_frame_shows_three_boxes_with_two_mistakes(truth: list[Positions]) -> None:
    made = exercise(*truth)
    shown, right = made.shown(0), truth[0]
    assert made.missing in right.keys() - shown.keys()
    assert len(shown) == 3
    assert shown.keys() - right.keys() == {made.invented}
    assert {person for person in shown.keys() & right.keys() if shown[person] != right[person]} == {
        made.shifted
    }
    assert made.yellow(0) == {made.shifted}


@given(walks())
def test_the_misplaced_person_stands_forty_centimetres_off(truth: list[Positions]) -> None:
    made = exercise(*truth)
    off = between([made.shifted_to], [truth[0][made.shifted]], GRID)[0, 0]
    assert abs(off - SHIFT) <= GRID.step


@given(walks())
def test_in_the_second_frame_two_people_stand_where_they_were(truth: list[Positions]) -> None:
    made = exercise(*truth)
    shown = made.shown(1)
    assert len(set(made.carried)) == 2
    assert {person: shown[person] for person in made.carried} == {p: truth[0][p] for p in made.carried}
    assert {p: place for p, place in shown.items() if p not in made.carried} == {
        p: place for p, place in truth[1].items() if p not in made.carried
    }
    assert made.shown(2) == truth[2]


@given(walks())
def test_the_same_truth_makes_the_same_exercise(truth: list[Positions]) -> None:
    backwards = [dict(reversed(people.items())) for people in truth]
    assert exercise(*truth) == exercise(*backwards)


@given(walks())
def test_the_next_person_is_nobody_who_is_there(truth: list[Positions]) -> None:
    made = exercise(*truth)
    assert all(made.next_person > person for index in range(3) for person in made.shown(index))


def test_the_invented_person_is_alone_where_there_is_room() -> None:
    corners = {1: 0, 2: 399, 3: 159_600, 4: 159_999}
    made = exercise(corners, corners, corners)
    assert between([made.invented_at], list(corners.values()), GRID).min() >= LONELY


def test_the_invented_persons_number_is_not_the_odd_one_out() -> None:
    people = {1: 0, 2: 399, 4: 159_600, 9: 159_999}
    assert exercise(people, people, people).invented == 3


def test_people_whom_few_cameras_see_are_left_alone() -> None:
    people = {1: 0, 2: 399, 3: 159_600, 4: 159_999, 5: 80_200}

    def but_person_five(places: list[int], others: list[int]) -> NDArray[np.int64]:
        return np.array([0 if place == people[5] else 3 for place in places])

    made = make_exercise([0, 5, 10], [people] * 3, GRID, but_person_five)
    assert 5 not in {made.missing, made.shifted, *made.carried}


@pytest.mark.parametrize(
    "truth",
    [
        [{}, {}, {}],
        [{1: 5, 2: 6}] * 3,
        [{1: 5, 2: 6, 3: 7}, {4: 5, 1: 6}, {}],
        [{1: 5, 2: 6, 3: 7}] * 2,
        [{1: 5, 2: 6, 3: 7}],
        [],
    ],
)
def test_too_few_people_or_frames_make_no_exercise(truth: list[Positions]) -> None:
    with pytest.raises(NoRoom):
        make_exercise([0, 5, 10][: len(truth)], truth, GRID, equally_well)


def test_a_grid_without_room_makes_no_exercise() -> None:
    with pytest.raises(NoRoom):
        exercise(*[{1: 0, 2: 1, 3: 2}] * 3, grid=Grid(3, 1, 0.1, 0, 0))
