from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from gtm_hit.metrics import detection
from gtm_hit.metrics.annotations import Annotations
from tests.metrics.scenes import crossing_people
from tests.metrics.strategies import layers


def worked() -> tuple[Annotations, Annotations]:
    """Frame 0: one exact, one 0.3 m off, one missed. Frame 5: one 0.1 m off, an extra. Frame 10: an extra."""
    truth = Annotations([0, 0, 0, 5], [[0, 0], [2, 0], [4, 0], [1, 1]])
    found = Annotations([0, 0, 5, 5, 10], [[0, 0], [2, 0.3], [1.1, 1], [8, 8], [0, 0]])
    return truth, found


def test_the_hand_worked_case_gives_the_hand_worked_scores() -> None:
    score = detection.evaluate(*worked())
    assert (score.frames, score.truth, score.found) == (3, 4, 5)
    assert (score.matched, score.missed, score.extra) == (3, 1, 2)
    assert score.moda == pytest.approx(1 - 3 / 4)
    assert score.modp == pytest.approx((1.0 + 0.4 + 0.8) / 3)
    assert score.precision == pytest.approx(3 / 5)
    assert score.recall == pytest.approx(3 / 4)


def test_each_frame_has_its_own_scores() -> None:
    frames = detection.evaluate_frames(*worked())
    assert frames.numbers.tolist() == [0, 5, 10]
    assert frames.moda.tolist() == pytest.approx([2 / 3, 0.0, math.nan], nan_ok=True)
    assert frames.modp.tolist() == pytest.approx([0.7, 0.8, math.nan], nan_ok=True)
    assert frames.precision.tolist() == pytest.approx([1.0, 0.5, 0.0])
    assert frames.recall.tolist() == pytest.approx([2 / 3, 1.0, math.nan], nan_ok=True)


def test_the_worst_frames_come_first() -> None:
    truth = Annotations([0, 1, 1, 2, 3], [[0, 0], [0, 0], [3, 0], [0, 0], [0, 0]])
    found = Annotations([0, 2, 3], [[0.1, 0], [0, 0], [0.2, 0]])
    frames = detection.evaluate_frames(truth, found)
    assert frames.numbers[frames.worst_first].tolist() == [1, 3, 0, 2]


def test_more_mistakes_than_people_make_moda_negative() -> None:
    truth = Annotations([0], [[0, 0]])
    found = Annotations([0, 0, 0], [[5, 0], [6, 0], [7, 0]])
    assert detection.evaluate(truth, found).moda == -3.0


def test_frames_without_any_detection_count_as_missed() -> None:
    truth = Annotations([0, 5], [[0, 0], [0, 0]])
    found = Annotations([0], [[0, 0]])
    assert detection.evaluate(truth, found).recall == 0.5


def test_scores_of_nothing_are_not_defined() -> None:
    nobody = Annotations([], [])
    score = detection.evaluate(nobody, nobody)
    assert all(math.isnan(value) for value in (score.moda, score.modp, score.precision, score.recall))


def test_finding_nobody_scores_zero_and_has_no_precision() -> None:
    score = detection.evaluate(worked()[0], Annotations([], []))
    assert (score.moda, score.recall) == (0.0, 0.0)
    assert math.isnan(score.precision) and math.isnan(score.modp)


@given(layers())
def test_a_layer_agrees_perfectly_with_itself(layer: Annotations) -> None:
    assume(len(layer))
    score = detection.evaluate(layer, layer)
    assert (score.moda, score.modp, score.precision, score.recall) == (1.0, 1.0, 1.0, 1.0)


@given(layers(), layers())
def test_changing_sides_exchanges_precision_and_recall_and_keeps_modp(a, b) -> None:
    one, other = detection.evaluate(a, b), detection.evaluate(b, a)
    assert one.precision == pytest.approx(other.recall, nan_ok=True)
    assert one.recall == pytest.approx(other.precision, nan_ok=True)
    assert one.modp == pytest.approx(other.modp, nan_ok=True)


@given(layers(), layers())
def test_scores_stay_within_their_bounds(a: Annotations, b: Annotations) -> None:
    score = detection.evaluate(a, b)
    for value in (score.modp, score.precision, score.recall):
        assert math.isnan(value) or 0.0 <= value <= 1.0
    assert math.isnan(score.moda) or score.moda <= 1.0


@given(layers(), layers(), st.randoms(use_true_random=False))
def test_the_order_of_annotations_does_not_matter(a, b, random) -> None:
    rows = list(range(len(b)))
    random.shuffle(rows)
    one = detection.evaluate(a, b)
    other = detection.evaluate(a, b.take(np.array(rows, dtype=int)))
    assert (one.matched, one.extra) == (other.matched, other.extra)
    assert one.distance_sum == pytest.approx(other.distance_sum, abs=1e-9)


@given(layers(), layers())
def test_moving_everybody_alike_changes_nothing(a: Annotations, b: Annotations) -> None:
    moved = [Annotations(side.frames, side.xy + np.array([-3.0, -9.0])) for side in (a, b)]
    one, other = detection.evaluate(a, b), detection.evaluate(*moved)
    assert one.matched == other.matched
    assert one.distance_sum == pytest.approx(other.distance_sum, abs=1e-9)


@given(layers(), layers())
def test_a_larger_radius_never_loses_a_match(a: Annotations, b: Annotations) -> None:
    matched = [score.matched for score in detection.curve(a, b, (0.05, 0.1, 0.2, 0.5, 1.0))]
    assert matched == sorted(matched)


def evaluation_tool(truth: Annotations, found: Annotations, cells: float, step: float) -> tuple[float, ...]:
    """MODA, MODP, precision and recall the way the published evaluation works: distances in cells, a far pair
    priced at a million, the Hungarian method over everything, far pairs dropped afterwards."""
    from scipy.optimize import linear_sum_assignment

    matched, similarity = 0, 0.0
    for number in np.union1d(truth.frames, found.frames):
        ours = truth.xy[truth.frames == number] / step
        theirs = found.xy[found.frames == number] / step
        distance = np.array([[np.linalg.norm(a - b) for b in theirs] for a in ours]).reshape(len(ours), -1)
        price = np.where(distance < cells, distance, 1e6)
        kept = [
            distance[pair] for pair in zip(*linear_sum_assignment(price), strict=True) if price[pair] < 1e6
        ]
        matched += len(kept)
        similarity += sum(1 - value / cells for value in kept)
    mistakes = len(truth) + len(found) - 2 * matched
    return (
        1 - mistakes / len(truth),
        similarity / matched,
        matched / len(found),
        matched / len(truth),
    )


@pytest.mark.parametrize("wobble", [0.05, 0.25, 0.45])
def test_scores_are_those_of_the_published_evaluation(wobble: float) -> None:
    truth, found = crossing_people(people=20, frames=30, wobble=wobble)
    score = detection.evaluate(truth, found)
    ours = (score.moda, score.modp, score.precision, score.recall)
    assert ours == pytest.approx(evaluation_tool(truth, found, 20, 0.025), abs=1e-12)
