from __future__ import annotations

from gtm_hit.scoring.plausibility import count_warnings
from tests.scoring.people import as_annotations, moved, walking

SECONDS = 0.1  # between two frame numbers


def test_people_who_walk_raise_no_warning() -> None:
    assert count_warnings(as_annotations(walking()), SECONDS) == 0


def test_two_in_one_place_are_one_warning() -> None:
    people = walking()
    people[5][90] = moved(people[5][3], 0.2)
    assert count_warnings(as_annotations(people), SECONDS) == 1


def test_somebody_faster_than_people_are_is_one_warning_for_each_leap() -> None:
    people = walking()
    people[5][3] = moved(people[5][3], 0.5, 2.8)
    assert count_warnings(as_annotations(people), SECONDS) == 2


def test_nobody_raises_no_warning() -> None:
    assert count_warnings(as_annotations({}), SECONDS) == 0
