from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from gtm_hit.metrics import agreement
from gtm_hit.metrics.annotations import Annotations, MetricsError
from tests.metrics.strategies import layers


def batch(shift: tuple[float, float] = (0.0, 0.0), persons: int = 0, people: int = 6) -> Annotations:
    """Ten frames of people a metre apart, moved by `shift`, numbered from `persons`."""
    frame, person = (values.ravel() for values in np.mgrid[0:10, 0:people])
    return Annotations(frame * 5, np.column_stack((person, frame * 0.1)) + np.array(shift), person + persons)


def test_two_workers_who_did_the_same_agree_in_everything() -> None:
    result = agreement.evaluate({"a": batch(), "b": batch(persons=100)})
    overall = result.overall
    assert (overall.matched_share, overall.identity_agreement) == (1.0, 1.0)
    assert (overall.median_distance, overall.p95_distance) == (0.0, 0.0)


def test_a_worker_who_places_everybody_to_the_east_shows_as_bias_in_x() -> None:
    result = agreement.evaluate({"a": batch(), "b": batch(), "east": batch((0.12, 0.0))})
    assert result.workers["east"].x == pytest.approx(0.12)
    assert result.workers["east"].y == pytest.approx(0.0)
    assert result.workers["east"].confirmed == 60


def test_one_careless_worker_does_not_bias_the_others() -> None:
    # Two of the three others outvote the careless one; a mean would move by a third of the shift.
    four = {"a": batch(), "b": batch(), "c": batch(), "north": batch((0.0, 0.2))}
    result = agreement.evaluate(four)
    assert result.workers["a"].y == pytest.approx(0.0)
    assert result.workers["north"].y == pytest.approx(0.2)


def test_distances_are_summed_up_by_median_and_95th_percentile() -> None:
    here = Annotations([0] * 21, [[float(i), 0.0] for i in range(21)], list(range(21)))
    there = Annotations([0] * 21, [[float(i), 0.01 * i] for i in range(21)], list(range(21)))
    overall = agreement.evaluate({"a": here, "b": there}).overall
    assert overall.median_distance == pytest.approx(0.10)
    assert overall.p95_distance == pytest.approx(0.19)


def test_people_only_one_worker_saw_lower_the_matched_share() -> None:
    overall = agreement.evaluate({"a": batch(people=6), "b": batch(people=4)}).overall
    assert (overall.matched, overall.annotations) == (40, 100)
    assert overall.matched_share == pytest.approx(0.8)


def test_exchanged_names_lower_the_identity_agreement_alone() -> None:
    other = batch()
    exchanged = other.identities().copy()
    late = other.frames >= 35
    exchanged[late & (other.persons == 0)] = 1
    exchanged[late & (other.persons == 1)] = 0
    result = agreement.evaluate({"a": batch(), "b": Annotations(other.frames, other.xy, exchanged)})
    assert result.overall.matched_share == 1.0
    assert result.overall.identity_agreement == pytest.approx(1 - 6 / 60)


def test_workers_without_anything_in_common_have_no_distance_and_no_bias() -> None:
    result = agreement.evaluate({"a": batch(), "b": batch((50.0, 0.0))})
    assert result.overall.matched_share == 0.0
    assert math.isnan(result.overall.median_distance) and math.isnan(result.overall.identity_agreement)
    assert result.workers["a"].confirmed == 0 and math.isnan(result.workers["a"].x)


def test_one_worker_alone_agrees_with_nobody() -> None:
    with pytest.raises(MetricsError, match="two workers or more, not 1"):
        agreement.evaluate({"a": batch()})


@given(layers(), layers())
def test_two_workers_bias_is_opposite(a: Annotations, b: Annotations) -> None:
    result = agreement.evaluate({"a": a, "b": b})
    one, other = result.workers["a"], result.workers["b"]
    assert one.confirmed == other.confirmed == result.overall.matched
    assert one.x == pytest.approx(-other.x, nan_ok=True)
    assert one.y == pytest.approx(-other.y, nan_ok=True)


@given(layers(), layers(), layers())
def test_the_order_of_workers_does_not_matter(a: Annotations, b: Annotations, c: Annotations) -> None:
    one = agreement.evaluate({"a": a, "b": b, "c": c}).overall
    other = agreement.evaluate({"c": c, "b": b, "a": a}).overall
    assert (one.matched, one.annotations) == (other.matched, other.annotations)
    assert 0 <= one.same_identity <= one.matched
