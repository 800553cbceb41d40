from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.metrics.annotations import Annotations, MetricsError
from gtm_hit.metrics.matching import match, match_places
from tests.metrics.strategies import places

RADII = st.sampled_from([0.05, 0.2, 0.5])


def every_matching(truth: np.ndarray, found: np.ndarray, radius: float) -> tuple[int, float]:
    """The best number of matches and the least sum of distances for it, by trying all."""
    if len(truth) > len(found):
        truth, found = found, truth
    best = (0, 0.0)
    for chosen in permutations(range(len(found)), len(truth)):
        distances = np.hypot(*(truth - found[list(chosen)]).T)
        near = distances[distances < radius - 1e-9]
        best = max(best, (len(near), -float(near.sum())))
    return best[0], -best[1]


@given(places(), places(), RADII)
def test_no_other_matching_has_more_pairs_or_a_smaller_sum(truth, found, radius) -> None:
    first, second, distances = match_places(truth, found, radius)
    count, total = every_matching(truth, found, radius)
    assert len(distances) == count
    assert distances.sum() == pytest.approx(total, abs=1e-9)
    assert len(set(first.tolist())) == len(set(second.tolist())) == count


@given(places(), places(), RADII)
def test_distances_are_those_of_the_pairs_and_below_the_radius(truth, found, radius) -> None:
    first, second, distances = match_places(truth, found, radius)
    assert np.allclose(distances, np.hypot(*(truth[first] - found[second]).T))
    assert (distances < radius).all()


def test_a_far_pair_never_takes_the_partner_of_a_near_one() -> None:
    # Only the first of each side are near, 0.45 m. The smallest sum over all pairs crosses over (4.0 + 0.6
    # instead of 0.45 + 5.05): dropping far pairs afterwards would leave nothing.
    truth = np.array([[0.0, 0.45], [0.0, -0.6]])
    found = np.array([[0.0, 0.0], [0.0, 4.45]])
    first, second, _ = match_places(truth, found, 0.5)
    assert (first.tolist(), second.tolist()) == ([0], [0])


def test_two_matches_are_better_than_one_exact_match() -> None:
    truth = np.array([[0.0, 0.0], [0.4, 0.0]])
    found = np.array([[0.4, 0.0], [0.8, 0.0]])
    _, _, distances = match_places(truth, found, 0.5)
    assert distances.tolist() == pytest.approx([0.4, 0.4])


@pytest.mark.parametrize("origin", [-9.0, -3.0, 0.0, 0.1, 1234.5])
@pytest.mark.parametrize("columns, rows", [(20, 0), (12, 16), (16, 12), (0, 20)])
def test_places_exactly_the_radius_apart_are_not_matched_wherever_the_origin_is(
    origin: float, columns: int, rows: int
) -> None:
    truth = origin + 0.025 * np.array([[100.0, 100.0]])
    found = origin + 0.025 * np.array([[100.0 + columns, 100.0 + rows]])
    assert len(match_places(truth, found, 0.5)[2]) == 0
    nearer = origin + 0.025 * np.array([[100.0 + columns - (columns > 0), 100.0 + rows - (columns == 0)]])
    assert len(match_places(truth, nearer, 0.5)[2]) == 1


def test_people_are_matched_only_within_their_frame() -> None:
    truth = Annotations([0, 5], [[1.0, 1.0], [2.0, 2.0]])
    found = Annotations([0, 5], [[2.0, 2.0], [2.1, 2.0]])
    matches = match(truth, found)
    assert (matches.truth.tolist(), matches.found.tolist()) == ([1], [1])


@pytest.mark.parametrize("radius", [0.0, -1.0, float("nan"), float("inf")])
def test_a_radius_that_is_no_length_is_refused(radius: float) -> None:
    nobody = Annotations([], [])
    with pytest.raises(MetricsError, match="radius must be a positive number of metres"):
        match(nobody, nobody, radius)
