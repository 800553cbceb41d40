"""People keep who they are from frame to frame."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.vision.link import FILLED, NOBODY, Linked, Places, link


def walkers(*people: list[tuple[float, float, float]], persons: list[int] | None = None) -> Places:
    """Places of people given as (frame, x, y) each; persons give one identity per walker."""
    rows = [row for person in people for row in person]
    given = None
    if persons is not None:
        given = np.array([who for who, person in zip(persons, people, strict=True) for _ in person])
    array = np.array(rows, dtype=float).reshape(-1, 3)
    return Places(array[:, 0].astype(np.int64), array[:, 1:], given)


def line(frames: range, x: float, y: float, dx: float, dy: float) -> list[tuple[float, float, float]]:
    return [(frame, x + dx * frame, y + dy * frame) for frame in frames]


def track_of(linked: Linked, row: int) -> int:
    return int(linked.tracks[linked.rows == row][0])


def test_one_walker_is_one_track() -> None:
    linked = link(walkers(line(range(10), 0, 0, 0.6, 0)))
    assert len(linked.rows) == 10
    assert len(set(linked.tracks.tolist())) == 1


def test_two_who_cross_keep_their_identities() -> None:
    one, other = line(range(11), 0, 0, 0.6, 0.05), line(range(11), 6, 0, -0.6, 0.05)
    linked = link(walkers(one, other))
    first = {track_of(linked, row) for row in range(11)}
    second = {track_of(linked, row) for row in range(11, 22)}
    assert len(first) == len(second) == 1
    assert first != second


def test_a_hole_of_one_frame_is_filled_on_the_straight_line() -> None:
    rows = [row for row in line(range(6), 1, 2, 0.4, 0) if row[0] != 3]
    linked = link(walkers(rows))
    filled = linked.rows == FILLED
    assert linked.frames[filled].tolist() == [3]
    assert linked.xy[filled][0] == pytest.approx([1 + 0.4 * 3, 2])
    assert len(set(linked.tracks.tolist())) == 1


def test_two_frames_of_a_hole_are_filled() -> None:
    rows = [row for row in line(range(9), 1, 2, 0.4, 0) if row[0] not in {3, 4}]
    linked = link(walkers(rows))
    filled = linked.rows == FILLED
    assert linked.frames[filled].tolist() == [3, 4]
    np.testing.assert_allclose(linked.xy[filled], [[2.2, 2], [2.6, 2]], atol=1e-9)


def test_two_who_change_direction_where_they_meet_keep_their_names() -> None:
    """The first velocities pair them wrong, and then a track leaves out where they met; as in MultiviewX."""
    one = [(0, 10.12, 12.32), (1, 9.68, 12.72), (2, 9.22, 13.12), (3, 8.78, 13.52), (4, 8.43, 13.92)]
    other = [(0, 9.22, 12.18), (1, 9.82, 12.18), (2, 10.42, 12.18), (3, 11.02, 12.18), (4, 11.62, 12.18)]
    linked = link(walkers(one, other))
    assert len({track_of(linked, row) for row in range(5)}) == 1
    assert len({track_of(linked, row) for row in range(5, 10)}) == 1


def test_a_longer_hole_is_bridged_and_stays_a_hole() -> None:
    rows = [row for row in line(range(9), 1, 2, 0.4, 0) if row[0] not in {3, 4, 5}]
    linked = link(walkers(rows))
    assert FILLED not in linked.rows
    assert len(set(linked.tracks.tolist())) == 1


def test_numbers_of_accepted_neighbours_win() -> None:
    places = walkers(
        line(range(3), 0, 0, 0.5, 0), line(range(3, 8), 0, 0, 0.5, 0), line(range(8), 0, 5, 0.5, 0)
    )
    persons = np.array([17] * 3 + [NOBODY] * 13)
    linked = link(Places(places.frames, places.xy, persons))
    assert {track_of(linked, row) for row in range(8)} == {17}
    assert {track_of(linked, row) for row in range(8, 16)} == {18}


def test_two_accepted_people_never_become_one() -> None:
    whole = line(range(9), 0, 0, 0.5, 0)
    places = walkers(whole[:3], whole[3:6], whole[6:], persons=[4, NOBODY, 9])
    linked = link(places)
    assert [track_of(linked, row) for row in range(3)] == [4, 4, 4]
    assert [track_of(linked, row) for row in range(6, 9)] == [9, 9, 9]
    pairs = list(zip(linked.tracks.tolist(), linked.frames.tolist(), strict=True))
    assert len(pairs) == len(set(pairs))


def test_somebody_seen_once_is_no_track() -> None:
    linked = link(walkers(line(range(6), 0, 0, 0.5, 0), [(2, 9.0, 9.0)]))
    assert 6 not in linked.rows


def test_nobody_jumps_farther_than_people_walk() -> None:
    linked = link(walkers(line(range(4), 0, 0, 0.5, 0), line(range(4, 8), 5, 5, 0.5, 0)))
    assert track_of(linked, 0) != track_of(linked, 7)


def test_a_step_that_two_could_have_taken_is_less_certain() -> None:
    alone = link(walkers(line(range(6), 0, 0, 0.5, 0)))
    close = link(walkers(line(range(6), 0, 0, 0.5, 0), line(range(6), 0, 0.15, 0.5, 0)))
    assert close.certainty[close.frames == 3].max() < alone.certainty[alone.frames == 3].min()


def test_somebody_alone_is_certain_whether_they_stand_or_walk() -> None:
    for pace in (0.0, 0.5):
        assert link(walkers(line(range(6), 0, 0, pace, 0))).certainty.min() > 0.95


def test_an_empty_batch_has_no_tracks() -> None:
    assert len(link(walkers()).tracks) == 0
