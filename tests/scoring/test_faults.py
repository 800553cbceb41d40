"""Planted faults: what is planted is found again, and nothing stays of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.scoring.faults import (
    ALL_KINDS,
    SHIFTS,
    FaultKind,
    Positions,
    apart,
    plant,
    planted,
    repaired,
    unplanted,
)
from gtm_hit.scoring.undoing import changed, changes
from tests.scoring.people import GRID, moved, walking


def made(seed: int, kinds: tuple[FaultKind, ...] = ALL_KINDS, count: int = 3):  # type: ignore[no-untyped-def]
    return plant(walking(), GRID, kinds, count, np.random.default_rng(seed))


def undone(faults: list, now: dict[int, Positions]) -> dict[int, Positions]:  # type: ignore[type-arg]
    found = [change for one in changes(faults, walking(), now, GRID).values() for change in one]
    return {
        number: changed(people, [change for change in found if change.frame == number])
        for number, people in now.items()
    }


@given(st.integers(0, 10_000))
def test_whoever_confirms_everything_repaired_nothing(seed: int) -> None:
    faults = made(seed)
    shown = planted(walking(), faults)
    assert len(faults) == 3
    assert not [fault for fault in faults if repaired(fault, walking(), shown, GRID)]


@given(st.integers(0, 10_000))
def test_whoever_sees_the_truth_repaired_all(seed: int) -> None:
    assert all(repaired(fault, walking(), walking(), GRID) for fault in made(seed))


@given(st.integers(0, 10_000))
def test_what_was_left_is_taken_back_to_the_last_position_and_number(seed: int) -> None:
    faults = made(seed)
    assert undone(faults, planted(walking(), faults)) == walking()


@given(st.integers(0, 10_000))
def test_what_was_repaired_is_not_touched(seed: int) -> None:
    assert undone(made(seed), walking()) == walking()


@given(st.integers(0, 10_000))
def test_a_worker_who_is_5_cm_off_everywhere_repaired_all(seed: int) -> None:
    rng = np.random.default_rng(seed)
    found = {
        number: {p: moved(at, *rng.uniform(-0.05, 0.05, 2)) for p, at in people.items()}
        for number, people in walking().items()
    }
    assert all(repaired(fault, walking(), found, GRID) for fault in made(seed))


@given(st.integers(0, 10_000))
def test_what_was_there_before_is_known_from_what_was_shown(seed: int) -> None:
    assert unplanted(planted(walking(), made(seed)), made(seed)) == walking()


@given(st.integers(0, 10_000))
def test_the_same_seed_plants_the_same(seed: int) -> None:
    assert made(seed) == made(seed)


@given(st.integers(0, 10_000))
def test_a_shift_is_between_25_and_50_cm(seed: int) -> None:
    (fault,) = made(seed, (FaultKind.SHIFTED,), 1)
    assert fault.right is not None and fault.wrong is not None
    assert SHIFTS[0] - 0.02 <= apart(GRID, fault.right, fault.wrong) <= SHIFTS[1] + 0.02


@given(st.integers(0, 10_000))
def test_an_invented_person_stands_a_metre_from_everybody_under_a_number_nobody_has(seed: int) -> None:
    (fault,) = made(seed, (FaultKind.INVENTED,), 1)
    people = walking()[fault.frame]
    assert fault.wrong is not None and fault.person not in people
    assert min(apart(GRID, fault.wrong, place) for place in people.values()) >= 1.0


def test_a_swap_lasts_to_the_end_and_is_of_two_who_were_there_before() -> None:
    (fault,) = made(3, (FaultKind.SWAPPED,), 1)
    shown, right = planted(walking(), [fault]), walking()
    assert fault.frame > 0 and fault.other is not None
    for number in right:
        expected = right[number][fault.other if number >= fault.frame else fault.person]
        assert shown[number][fault.person] == expected


def test_a_swap_repaired_in_its_first_frame_only_is_taken_back_in_the_others() -> None:
    (fault,) = made(3, (FaultKind.SWAPPED,), 1)
    now = planted(walking(), [fault])
    now[fault.frame] = walking()[fault.frame]
    if len([number for number in now if number > fault.frame]):
        assert not repaired(fault, walking(), now, GRID)
    assert undone([fault], now) == walking()


def test_a_removed_person_comes_back_under_the_number_the_worker_gave_him() -> None:
    (fault,) = made(1, (FaultKind.REMOVED,), 1)
    now = {
        number: {p + 40: at for p, at in people.items()}
        for number, people in planted(walking(), [fault]).items()
    }
    assert undone([fault], now)[fault.frame][fault.person + 40] == fault.right


def test_a_shifted_person_whom_the_worker_removed_stays_removed() -> None:
    (fault,) = made(1, (FaultKind.SHIFTED,), 1)
    now = planted(walking(), [fault])
    del now[fault.frame][fault.person]
    assert not repaired(fault, walking(), now, GRID)
    assert undone([fault], now) == now


@pytest.mark.parametrize("frames", [{}, {0: {}}, {0: {}, 5: {}}])
def test_where_nobody_is_nothing_is_planted(frames: dict[int, Positions]) -> None:
    assert plant(frames, GRID, ALL_KINDS, 5, np.random.default_rng(1)) == []


def test_one_frame_of_one_person_takes_what_fits() -> None:
    frames = {0: {1: GRID.count // 2 + 200}}
    kinds = {
        fault.kind
        for seed in range(20)
        for fault in plant(frames, GRID, ALL_KINDS, 4, np.random.default_rng(seed))
    }
    assert FaultKind.SWAPPED not in kinds
    assert kinds <= set(ALL_KINDS)
