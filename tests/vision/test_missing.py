"""A finished layer from which people were taken is looked through."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.vision.missing import Area, Case, Marked, Seen, Why, find

AREA = Area(-10.0, -10.0, 10.0, 10.0)
FRAMES = 10


def crowd(people: int = 12, frames: int = FRAMES, seed: int = 3) -> Marked:
    """On a lattice 1.6 m apart, everybody walking slowly to the east."""
    rng = np.random.default_rng(seed)
    start = np.array([(-4 + 1.6 * (one % 4), -4 + 1.6 * (one // 4)) for one in range(people)])
    pace = rng.uniform(0.05, 0.12, people)
    frame, person = (array.ravel() for array in np.mgrid[0:frames, 0:people])
    xy = start[person] + np.column_stack((pace[person] * frame, np.zeros(len(frame))))
    return Marked(frame, xy, person + 1, np.ones(len(frame), bool))


def proposals_of(marked: Marked, noise: float = 0.05) -> Seen:
    rng = np.random.default_rng(1)
    xy = marked.xy + rng.normal(0, noise, marked.xy.shape)
    return Seen(marked.frames, xy, np.full(len(xy), 0.9), marked.persons)


def without(marked: Marked, rows: list[int]) -> Marked:
    return Marked(*(np.delete(column, rows, axis=0) for column in vars(marked).values()))


def only(seen: Seen, rows: np.ndarray) -> Seen:
    return Seen(seen.frames[rows], seen.xy[rows], seen.scores[rows], seen.tracks[rows])


NOBODY = Seen(np.zeros(0, np.int64), np.zeros((0, 2)), np.zeros(0), np.zeros(0, np.int64))


def cases(marked: Marked, seen: Seen) -> list[Case]:
    return find(marked, seen, FRAMES, AREA)


def test_a_whole_layer_has_no_case() -> None:
    marked = crowd()
    assert cases(marked, proposals_of(marked)) == []


def test_people_taken_out_at_random_are_listed_each_once() -> None:
    whole = crowd()
    rows = np.random.default_rng(7).choice(len(whole.frames), 20, replace=False).tolist()
    found = cases(without(whole, rows), proposals_of(whole))
    assert len(found) == 20
    for row in rows:
        x, y = whole.xy[row]
        assert any(one.frame == whole.frames[row] and np.hypot(one.x - x, one.y - y) < 0.3 for one in found)


def test_a_hole_is_listed_even_where_nobody_is_proposed() -> None:
    whole = crowd(people=1)
    (case,) = cases(without(whole, [4]), NOBODY)
    assert (case.why, case.frame, case.person) == (Why.HOLE, 4, 1)
    assert (case.x, case.y) == pytest.approx(tuple(whole.xy[4]))


def test_a_track_that_ends_inside_is_listed_where_something_confirms_it() -> None:
    whole = crowd(people=1)
    ended = without(whole, [8, 9])
    faint = proposals_of(whole)
    faint = Seen(faint.frames, faint.xy, np.full(10, 0.3), faint.tracks)
    (case,) = cases(ended, faint)
    assert (case.why, case.frame, case.person) == (Why.ENDS, 8, 1)
    assert cases(ended, NOBODY) == []


def test_who_leaves_over_the_border_is_not_missing() -> None:
    whole = crowd(people=1)
    near = Marked(whole.frames[:8], whole.xy[:8] + np.array([13.0, 0.0]), whole.persons[:8], whole.seen)
    seen = proposals_of(Marked(whole.frames, whole.xy + np.array([13.0, 0.0]), whole.persons))
    faint = Seen(seen.frames, seen.xy, np.full(10, 0.3), seen.tracks)
    assert cases(Marked(near.frames, near.xy, near.persons), faint) == []


def test_somebody_marked_whom_no_view_shows_is_listed() -> None:
    whole = crowd(people=3)
    shown = np.ones(len(whole.frames), bool)
    ghost = int(np.flatnonzero((whole.frames == 5) & (whole.persons == 2))[0])
    shown[ghost] = False
    seen = proposals_of(whole)
    found = cases(Marked(whole.frames, whole.xy, whole.persons, shown), only(seen, np.arange(30) != ghost))
    assert [(one.why, one.frame, one.person) for one in found] == [(Why.UNSUPPORTED, 5, 2)]


def test_a_box_left_standing_while_the_person_walked_on_is_listed() -> None:
    frames = np.arange(5)
    walk = Seen(frames, np.column_stack((0.6 * frames, 0.0 * frames)), np.full(5, 0.45), np.full(5, 1))
    xy = walk.xy.copy()
    xy[3] = xy[2]
    found = cases(Marked(frames, xy, np.full(5, 1)), walk)
    assert [(one.why, one.frame) for one in found] == [(Why.STILL, 3)]


def test_somebody_seen_beside_their_place_once_has_not_walked_on() -> None:
    frames = np.arange(5)
    stands = np.zeros((5, 2))
    seen = stands.copy()
    seen[3, 0] = 0.6
    walk = Seen(frames, seen, np.full(5, 0.45), np.full(5, 1))
    assert cases(Marked(frames, stands, np.full(5, 1)), walk) == []


def test_somebody_proposed_a_step_beside_a_person_whom_nothing_else_shows_is_that_person() -> None:
    one = Marked(np.array([0]), np.array([[0.0, 0.0]]), np.array([1]))
    beside = Seen(np.array([0]), np.array([[0.7, 0.0]]), np.array([0.9]), np.array([-1]))
    assert cases(one, beside) == []
    both = Seen(
        np.zeros(2, np.int64), np.array([[0.7, 0.0], [0.1, 0.0]]), np.full(2, 0.9), np.array([-1, -1])
    )
    (case,) = cases(one, both)
    assert (case.why, case.x) == (Why.PROPOSED, 0.7)


def test_a_single_sighting_needs_a_high_score() -> None:
    whole = crowd(people=1)
    for score, count in ((0.6, 0), (0.9, 1)):
        once = Seen(np.array([3]), np.array([[5.0, 5.0]]), np.array([score]), np.array([-1]))
        assert len(cases(whole, once)) == count


def test_the_likeliest_comes_first() -> None:
    whole = crowd()
    found = cases(without(whole, [13, 40]), proposals_of(whole))
    assert [one.weight for one in found] == sorted((one.weight for one in found), reverse=True)
