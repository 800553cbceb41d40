from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.geometry.grouping import RADIUS, group_by_place, link, same_ids_same_people


def group(points: list[tuple[float, float]], cameras: list[int]) -> list[int]:
    found = group_by_place(np.array(points, dtype=float), np.ones(len(points)), np.array(cameras))
    return found.tolist()


def test_points_of_different_cameras_close_together_are_one_person() -> None:
    assert group([(0, 0), (0.2, 0), (3, 0), (3, 0.3)], [0, 1, 0, 1]) == [0, 0, 1, 1]


def test_two_points_of_one_camera_are_two_people_however_close() -> None:
    assert group([(0, 0), (0.1, 0)], [0, 0]) == [0, 1]


def test_a_point_goes_to_the_nearer_of_two_people() -> None:
    assert group([(0, 0), (0.4, 0), (0.3, 0)], [0, 0, 1]) == [0, 1, 1]


def test_half_a_metre_is_too_far() -> None:
    assert group([(0, 0), (RADIUS, 0)], [0, 1]) == [0, 1]


def test_a_chain_of_near_points_does_not_grow_beyond_its_middle() -> None:
    assert len(set(group([(0, 0), (0.4, 0), (0.8, 0), (1.2, 0)], [0, 1, 2, 3]))) > 1


def test_points_that_are_not_known_stay_alone() -> None:
    assert len(set(group([(np.nan, np.nan), (0, 0), (0, 0)], [0, 1, 2]))) == 2


@given(
    st.lists(st.tuples(st.floats(0, 3), st.floats(0, 3), st.integers(0, 3)), max_size=30),
)
def test_no_group_has_a_camera_twice(seen: list[tuple[float, float, int]]) -> None:
    groups = group([(x, y) for x, y, _ in seen], [camera for _, _, camera in seen]) if seen else []
    pairs = list(zip(groups, [camera for _, _, camera in seen], strict=True))
    assert len(set(pairs)) == len(pairs)
    assert sorted(set(groups)) == list(range(len(set(groups))))


def test_ids_are_shared_when_they_lie_together() -> None:
    points = np.array([(0, 0), (0.1, 0), (5, 5), (5.1, 5)])
    assert same_ids_same_people(points, [(1, 7), (1, 7), (1, 8), (1, 8)])


def test_ids_are_not_shared_when_they_lie_apart_or_never_meet() -> None:
    points = np.array([(0, 0), (4, 0), (5, 5), (9, 5)])
    assert not same_ids_same_people(points, [(1, 7), (1, 7), (1, 8), (1, 8)])
    assert not same_ids_same_people(points, [(1, 7), (1, 8), (1, 9), (1, 10)])


def test_a_person_keeps_its_number_as_long_as_any_view_keeps_its_track() -> None:
    one, other = (0, 5), (1, 9)
    assert link([(0, [one, other]), (1, [one]), (2, [other])]) == [0, 0, 0]


def test_tracks_seen_apart_at_one_instant_are_never_joined() -> None:
    one, other = (0, 5), (1, 9)
    persons = link([(0, [one, other]), (1, [one]), (1, [other])])
    assert persons[1] != persons[2]


def test_groups_without_tracks_are_people_of_their_own() -> None:
    assert link([(0, []), (0, []), (1, [])]) == [0, 1, 2]


def test_nobody_has_a_number_twice_at_one_instant() -> None:
    one, other = (0, 5), (1, 9)
    groups = [(0, [one, other]), (0, [one]), (1, [one, other])]
    persons = link(groups)
    assert persons[0] != persons[1]
