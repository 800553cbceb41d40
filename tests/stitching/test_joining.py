from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.stitching.rules import Rules, RulesError
from gtm_hit.stitching.stitching import stitch
from gtm_hit.stitching.tracks import Batch
from gtm_hit.stitching.verdicts import Verdict
from tests.stitching.crowd import Ways, cut, people

RULES = Rules()
TWO: Ways = {1: ((0.0, 0.0), (0.5, 0.0)), 2: ((0.0, 3.0), (0.5, 0.0))}


def one_person(layers: int, person: int) -> frozenset[tuple[int, int]]:
    return frozenset((layer, person) for layer in range(layers))


def test_neighbours_are_joined_by_the_frame_they_share() -> None:
    found = stitch([[cut(0, range(0, 11), TWO)], [cut(1, range(10, 21), TWO)]], RULES)
    assert people(found.people) == {one_person(2, 1), one_person(2, 2)}
    assert found.doubts == []


def test_without_a_shared_frame_they_are_joined_by_how_people_move() -> None:
    crossing: Ways = {1: ((0.0, 0.0), (0.5, 0.5)), 2: ((0.0, 10.0), (0.5, -0.5))}
    # They pass each other between frames 9 and 11: who is nearest there is somebody else.
    found = stitch([[cut(0, range(0, 10), crossing)], [cut(1, range(11, 20), crossing)]], RULES)
    assert people(found.people) == {one_person(2, 1), one_person(2, 2)}


def test_a_frame_two_batches_share_holds_everybody_once_in_the_middle_of_both_places() -> None:
    found = stitch([[cut(0, [0, 1, 2], TWO)], [cut(1, [2, 3, 4], TWO, off=(0.1, 0.0))]], RULES)
    track = next(track for track in found.people if (0, 1) in track.sources)
    assert track.frames.tolist() == [0, 1, 2, 3, 4]
    assert track.xy[2].tolist() == pytest.approx([1.05, 0.0])
    assert track.votes[2] == ((0, 1), (1, 1))


def test_somebody_overlooked_in_the_shared_frame_goes_on_as_the_same() -> None:
    parts = [cut(0, range(0, 11), TWO, absent=[(1, 10)]), cut(1, range(10, 21), TWO)]
    assert people(stitch([[part] for part in parts], RULES).people) == {one_person(2, 1), one_person(2, 2)}


def test_two_who_could_both_be_meant_are_left_apart_and_asked_about() -> None:
    before: Ways = {1: ((0.0, 0.0), (0.0, 0.0))}
    after: Ways = {1: ((0.17, 0.0), (0.0, 0.0)), 2: ((-0.18, 0.0), (0.0, 0.0))}
    found = stitch([[cut(0, range(0, 10), before)], [cut(1, range(10, 20), after)]], RULES)
    assert len(found.people) == 3
    assert [doubt.before.sources for doubt in found.doubts] == [frozenset([(0, 1)])]


def doubtful() -> list[list[Batch]]:
    before: Ways = {1: ((0.0, 0.0), (0.0, 0.0))}
    after: Ways = {1: ((0.17, 0.0), (0.0, 0.0)), 2: ((-0.18, 0.0), (0.0, 0.0))}
    return [[cut(0, range(0, 10), before)], [cut(1, range(10, 20), after)]]


@pytest.mark.parametrize("chosen", [1, 2])
def test_what_was_decided_is_done_and_not_asked_again(chosen: int) -> None:
    said = Verdict(frozenset([(0, 1)]), frozenset([(1, chosen)]), same=True)
    found = stitch(doubtful(), RULES, [said])
    assert frozenset([(0, 1), (1, chosen)]) in people(found.people)
    assert found.doubts == []


def test_who_is_kept_apart_from_one_may_still_be_the_other() -> None:
    said = Verdict(frozenset([(0, 1)]), frozenset([(1, 1)]), same=False)
    assert people(stitch(doubtful(), RULES, [said]).people) == {
        frozenset([(0, 1), (1, 2)]),
        frozenset([(1, 1)]),
    }


def test_nobody_is_joined_over_more_frames_than_the_gap() -> None:
    still: Ways = {1: ((0.0, 0.0), (0.0, 0.0))}
    parts = [[cut(0, range(0, 10), still)], [cut(1, range(16, 20), still)]]
    assert len(stitch(parts, RULES).people) == 2
    assert len(stitch(parts, Rules(gap=6)).people) == 1


def test_who_leaves_and_comes_back_is_proposed_and_not_joined() -> None:
    parts = [[cut(0, range(0, 10), TWO)], [cut(1, range(40, 50), {7: ((-15.0, 0.5), (0.5, 0.0))})]]
    found = stitch(parts, RULES)
    assert len(found.people) == 3
    assert [(back.before.sources, back.after.sources) for back in found.returns] == [
        (one_person(1, 1), frozenset([(1, 7)]))
    ]


def test_a_return_that_somebody_confirmed_is_one_person() -> None:
    parts = [[cut(0, range(0, 10), TWO)], [cut(1, range(40, 50), {7: ((-15.0, 0.5), (0.5, 0.0))})]]
    said = Verdict(frozenset([(0, 1)]), frozenset([(1, 7)]), same=True)
    found = stitch(parts, RULES, [said])
    assert frozenset([(0, 1), (1, 7)]) in people(found.people)
    assert found.returns == []


def test_two_people_seen_at_once_are_never_one_whatever_was_said() -> None:
    said = Verdict(frozenset([(0, 1)]), frozenset([(0, 2)]), same=True)
    assert len(stitch([[cut(0, range(0, 10), TWO)]], RULES, [said]).people) == 2


@pytest.mark.parametrize("wrong", [{"gate": 0.0}, {"gap": -1}, {"margin": float("nan")}])
def test_rules_that_make_no_sense_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(RulesError, match=next(iter(wrong))):
        Rules(**wrong)  # type: ignore[arg-type]


@st.composite
def crowds(draw: st.DrawFn) -> Ways:
    """People apart from each other by more than the gate, walking."""
    count = draw(st.integers(1, 6))
    metres = st.floats(-0.4, 0.4, allow_nan=False)
    return {n: ((draw(metres), 4.0 * n + draw(metres)), (draw(metres), draw(metres))) for n in range(count)}


@settings(max_examples=40, deadline=None)
@given(crowds(), st.integers(0, 2), st.randoms(use_true_random=False))
def test_neither_the_order_of_batches_nor_the_numbering_of_people_matters(
    ways: Ways, overlap: int, random: np.random.Generator
) -> None:
    spans = [range(start, start + 8 + overlap) for start in range(0, 32, 8)]
    numbers = list(ways)
    random.shuffle(numbers)  # type: ignore[arg-type]
    names = dict(zip(ways, [number + 100 for number in numbers], strict=True))
    plain = stitch([[cut(layer, span, ways)] for layer, span in enumerate(spans)], RULES)
    renamed = [[cut(layer, span, ways, names=names)] for layer, span in enumerate(spans)]
    random.shuffle(renamed)  # type: ignore[arg-type]
    found = stitch(renamed, RULES)
    assert people(found.people) == {
        frozenset((layer, names[person]) for layer, person in sources) for sources in people(plain.people)
    }
    for one, other in zip(plain.people, found.people, strict=True):
        assert np.array_equal(one.frames, other.frames)
        assert np.allclose(one.xy, other.xy)
