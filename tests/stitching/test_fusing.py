from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.stitching.fusing import fuse
from gtm_hit.stitching.merging import place_of
from gtm_hit.stitching.rules import Rules
from gtm_hit.stitching.tracks import Batch, batch
from tests.stitching.crowd import Ways, cut, people

RULES = Rules()
TWO: Ways = {1: ((0.0, 0.0), (0.3, 0.0)), 2: ((0.0, 2.0), (0.3, 0.0))}
FRAMES = range(10)


def replicas(*, absent: list[tuple[int, int]]) -> list[Batch]:
    """Three workers, each with a numbering of his own; the first one overlooks somebody."""
    return [
        cut(0, FRAMES, TWO, absent=absent),
        cut(1, FRAMES, TWO, names={1: 2, 2: 1}),
        cut(2, FRAMES, TWO, names={1: 9, 2: 4}),
    ]


def test_tracks_are_matched_by_where_people_are() -> None:
    found = fuse(replicas(absent=[]), RULES)
    assert people(found.batch.tracks) == {
        frozenset([(0, 1), (1, 2), (2, 9)]),
        frozenset([(0, 2), (1, 1), (2, 4)]),
    }


def test_somebody_one_of_three_overlooks_is_there_and_he_is_told() -> None:
    found = fuse(replicas(absent=[(1, 4), (1, 5)]), RULES)
    assert all(len(track.frames) == 10 for track in found.batch.tracks)
    assert [each.missed for each in found.disagreements] == [2, 0, 0]


def test_somebody_only_one_of_three_sees_is_not_there() -> None:
    three = {**TWO, 3: ((0.0, 5.0), (0.0, 0.0))}
    found = fuse([cut(0, FRAMES, three), cut(1, FRAMES, TWO), cut(2, FRAMES, TWO)], RULES)
    assert len(found.batch.tracks) == 2
    assert [each.extra for each in found.disagreements] == [10, 0, 0]


def test_of_two_workers_one_suffices() -> None:
    found = fuse([cut(0, FRAMES, TWO, absent=[(1, 3)]), cut(1, FRAMES, TWO)], RULES)
    assert [len(track.frames) for track in found.batch.tracks] == [10, 10]


def test_swapped_identities_of_one_worker_leave_everybody_where_they_are() -> None:
    swapped = cut(0, range(5), TWO), cut(0, range(5, 10), TWO, names={1: 2, 2: 1})
    rows = [
        (track.frames, track.xy, next(iter(track.sources))[1]) for part in swapped for track in part.tracks
    ]
    mixed = batch(
        0,
        FRAMES,
        np.concatenate([frames for frames, _, _ in rows]),
        np.concatenate([np.full(len(frames), name) for frames, _, name in rows]),
        np.concatenate([xy for _, xy, _ in rows]),
    )
    found = fuse([mixed, cut(1, FRAMES, TWO), cut(2, FRAMES, TWO)], RULES)
    for track, y in zip(found.batch.tracks, (0.0, 2.0), strict=True):
        assert len(track.frames) == 10
        assert np.allclose(track.xy[:, 1], y, atol=0.01)
    assert found.disagreements[0].renumbered > 0


def test_one_slip_among_three_moves_nobody() -> None:
    points = np.array([[0.0, 0.0], [0.02, 0.0], [0.5, 0.0]])
    assert place_of(points, np.ones(3)).tolist() == pytest.approx([0.01, 0.0])


def test_an_exact_worker_counts_for_more_than_a_shaky_one() -> None:
    rng = np.random.default_rng(1)
    crowd: Ways = {n: ((0.0, 2.0 * n), (0.3, 0.0)) for n in range(12)}
    exact, other, shaky = (cut(n, FRAMES, crowd) for n in range(3))

    def shaken(part: Batch, noise: float) -> Batch:
        for track in part.tracks:
            track.xy[:] += rng.normal(0, noise, track.xy.shape)
        return part

    found = fuse([shaken(exact, 0.02), shaken(other, 0.02), shaken(shaky, 0.1)], RULES)
    means = [each.mean_distance for each in found.disagreements]
    assert means[2] > 3 * means[0]
    off = [np.hypot(*(t.xy - t.xy.round(1)).T).mean() for t in found.batch.tracks]
    assert np.mean(off) < 0.025


def test_a_single_replica_stays_exactly_as_it_is() -> None:
    only = cut(0, FRAMES, TWO)
    assert fuse([only], RULES).batch is only


@settings(max_examples=40, deadline=None)
@given(st.permutations(range(3)), st.permutations([1, 2, 3, 4]), st.integers(0, 1000))
def test_neither_the_order_of_replicas_nor_their_numbering_matters(
    order: list[int], numbers: list[int], seed: int
) -> None:
    rng = np.random.default_rng(seed)
    crowd: Ways = {n: ((0.0, 1.5 * n), (0.3, 0.05 * n)) for n in range(1, 5)}
    offs = [tuple(rng.normal(0, 0.05, 2)) for _ in range(3)]
    plain = [cut(n, FRAMES, crowd, off=offs[n]) for n in range(3)]
    names = dict(zip(crowd, numbers, strict=True))
    renamed = [cut(n, FRAMES, crowd, off=offs[n], names=names if n == 1 else None) for n in order]
    ones, others = fuse(plain, RULES).batch.tracks, fuse(renamed, RULES).batch.tracks
    for one, other in zip(ones, others, strict=True):
        assert np.allclose(one.xy, other.xy)
        assert {(n, names[p] if n == 1 else p) for n, p in one.sources} == other.sources
