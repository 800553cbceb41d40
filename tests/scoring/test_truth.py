from __future__ import annotations

import pytest

from gtm_hit.scoring import truth
from gtm_hit.scoring.truth import MistakeKind
from tests.scoring.people import as_annotations, moved, walking


def test_the_truth_itself_is_perfect() -> None:
    people = as_annotations(walking())
    score = truth.score(people, people)
    assert (score.recall, score.precision, score.idf1, score.median, score.p95) == (1, 1, 1, 0, 0)
    assert truth.mistakes(people, people) == []


def test_nobody_where_nobody_is_is_perfect_too() -> None:
    nobody = as_annotations({})
    score = truth.score(nobody, nobody)
    assert (score.recall, score.precision, score.idf1) == (1, 1, 1)


def test_distances_are_metres_on_the_ground() -> None:
    right = walking(people=4, frames=5)
    shifted = {number: {p: moved(at, 0.1) for p, at in people.items()} for number, people in right.items()}
    score = truth.score(as_annotations(right), as_annotations(shifted))
    assert score.median == pytest.approx(0.1)
    assert score.p95 == pytest.approx(0.1)


def test_misses_extras_and_offsets_come_worst_first() -> None:
    right, found = walking(people=4, frames=2), walking(people=4, frames=2)
    del found[0][3]
    found[5][90] = moved(found[5][3], 0.0, -0.9)
    found[5][4] = moved(found[5][4], 0.3)
    found[5][5] = moved(found[5][5], 0.2)
    made = truth.mistakes(as_annotations(right), as_annotations(found))
    assert [one.kind for one in made] == [
        MistakeKind.MISSED,
        MistakeKind.EXTRA,
        MistakeKind.OFF,
        MistakeKind.OFF,
    ]
    assert made[2].distance == pytest.approx(0.3)


def test_somebody_who_goes_on_under_another_number_is_told_once() -> None:
    right, found = walking(people=2, frames=4), walking(people=2, frames=4)
    for number in (10, 15):
        found[number] = {3: found[number][4], 4: found[number][3]}
    made = truth.mistakes(as_annotations(right), as_annotations(found))
    assert [(one.kind, one.frame, one.before) for one in made] == [
        (MistakeKind.RENUMBERED, 10, 3),
        (MistakeKind.RENUMBERED, 10, 4),
    ]
    assert truth.score(as_annotations(right), as_annotations(found)).idf1 == 0.5


def test_numbers_of_the_truth_need_not_be_known() -> None:
    right = walking()
    found = {number: {p + 50: at for p, at in people.items()} for number, people in right.items()}
    assert truth.score(as_annotations(right), as_annotations(found)).idf1 == 1
