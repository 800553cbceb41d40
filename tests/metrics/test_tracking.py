from __future__ import annotations

import math
from collections import Counter
from itertools import permutations

import motmetrics
import numpy as np
import pytest
from hypothesis import assume, given, settings

from gtm_hit.metrics import tracking
from gtm_hit.metrics.annotations import Annotations, MetricsError, by_frame
from gtm_hit.metrics.matching import distances_between
from tests.metrics.scenes import crossing_people
from tests.metrics.strategies import layers


def near_together(truth: Annotations, found: Annotations, radius: float) -> Counter[tuple[int, int]]:
    """In how many frames each pair of persons is near."""
    together: Counter[tuple[int, int]] = Counter()
    for i, frame in enumerate(truth.frames):
        for j in np.flatnonzero(found.frames == frame):
            if np.hypot(*(truth.xy[i] - found.xy[j])) < radius - 1e-9:
                together[int(truth.persons[i]), int(found.persons[j])] += 1
    return together


def idf1_by_trying_all(truth: Annotations, found: Annotations, radius: float) -> float:
    """IDF1 from its definition: the one-to-one renaming with the most annotations right."""
    together = near_together(truth, found, radius)
    one, other = sorted(set(truth.persons.tolist())), sorted(set(found.persons.tolist()))
    padded = other + [None] * len(one)
    right = max(
        sum(together[pair] for pair in zip(one, chosen, strict=True))
        for chosen in permutations(padded, len(one))
    )
    return 2 * right / (len(truth) + len(found))


@settings(max_examples=40)
@given(layers(people=3), layers(people=3))
def test_idf1_is_that_of_the_best_renaming(truth: Annotations, found: Annotations) -> None:
    assume(len(truth) and len(found))
    score = tracking.evaluate(truth, found, 0.3).score
    assert score.idf1 == pytest.approx(idf1_by_trying_all(truth, found, 0.3))


@pytest.mark.parametrize("swap_every", [3, 7, 100])
@pytest.mark.parametrize("wobble", [0.05, 0.3])
def test_idf1_is_that_of_motmetrics(wobble: float, swap_every: int) -> None:
    truth, found = crossing_people(people=9, frames=60, wobble=wobble, swap_every=swap_every)
    events = motmetrics.MOTAccumulator()
    for number, rows, others in by_frame(truth, found):
        distances = distances_between(truth.xy[rows], found.xy[others])
        distances[distances >= 0.5] = np.nan
        events.update(truth.persons[rows], found.persons[others], distances, frameid=number)
    theirs = motmetrics.metrics.create().compute(events, metrics=["idf1", "idp", "idr"]).iloc[0].tolist()
    score = tracking.evaluate(truth, found).score
    assert [score.idf1, score.id_precision, score.id_recall] == pytest.approx(theirs)


def nearest(
    ours: dict[int, np.ndarray], theirs: dict[int, np.ndarray], radius: float
) -> list[tuple[int, int]]:
    """Most pairs, then the least sum of distances, by trying all."""
    padded = [*theirs, *[None] * len(ours)]
    best: tuple[int, float, list[tuple[int, int]]] = (0, 0.0, [])
    for chosen in set(permutations(padded, len(ours))):
        distance = {
            (one, other): float(np.hypot(*(ours[one] - theirs[other])))
            for one, other in zip(ours, chosen, strict=True)
            if other is not None
        }
        pairs = [pair for pair in distance if distance[pair] < radius - 1e-9]
        best = max(best, (len(pairs), -sum(distance[pair] for pair in pairs), pairs))
    return best[2]


def clear_by_hand(truth: Annotations, found: Annotations, radius: float) -> tuple[float, int]:
    """MOTA and switches in plain loops: a person's last match is kept while near, the rest assigned."""
    last: dict[int, int] = {}
    matched = switches = 0
    for frame in np.union1d(truth.frames, found.frames):
        ours, theirs = (
            {int(side.persons[row]): side.xy[row] for row in np.flatnonzero(side.frames == frame)}
            for side in (truth, found)
        )
        for person in list(ours):
            other = last.get(person)
            if other in theirs and np.hypot(*(ours[person] - theirs[other])) < radius - 1e-9:
                del ours[person], theirs[other]
                matched += 1
        for person, other in nearest(ours, theirs, radius):
            matched += 1
            switches += last.get(person, other) != other
            last[person] = other
    return 1 - (len(truth) + len(found) - 2 * matched + switches) / len(truth), switches


@pytest.mark.parametrize("swap_every", [3, 7, 100])
@pytest.mark.parametrize("wobble", [0.05, 0.3])
def test_mota_and_switches_are_those_counted_by_hand(wobble: float, swap_every: int) -> None:
    truth, found = crossing_people(people=4, frames=25, wobble=wobble, swap_every=swap_every)
    score = tracking.evaluate(truth, found).score
    assert (score.mota, score.switches) == pytest.approx(clear_by_hand(truth, found, 0.5))


def two_people_exchanging_names() -> tuple[Annotations, Annotations]:
    places = [[0.0, 0.0], [5.0, 0.0]] * 4
    frames = [0, 0, 5, 5, 10, 10, 15, 15]
    return (
        Annotations(frames, places, [1, 2] * 4),
        Annotations(frames, np.array(places) + np.array([0.1, 0.0]), [31, 32, 31, 32, 32, 31, 32, 31]),
    )


def test_every_person_going_on_under_another_name_is_reported_with_frame_and_names() -> None:
    result = tracking.evaluate(*two_people_exchanging_names())
    assert result.switches == [tracking.Switch(10, 1, 31), tracking.Switch(10, 2, 32)]


def test_the_hand_worked_case_gives_the_hand_worked_scores() -> None:
    score = tracking.evaluate(*two_people_exchanging_names()).score
    assert score.mota == pytest.approx(1 - 2 / 8)
    assert score.idf1 == pytest.approx(0.5)
    assert score.motp == pytest.approx(0.8)
    assert score.mean_distance == pytest.approx(0.1)
    assert (score.truth_persons, score.found_persons, score.switches) == (2, 2, 2)


@given(layers())
def test_a_layer_agrees_perfectly_with_itself(layer: Annotations) -> None:
    assume(len(layer))
    score = tracking.evaluate(layer, layer).score
    assert (score.mota, score.motp, score.idf1, score.switches) == (1.0, 1.0, 1.0, 0)


def test_names_too_large_for_a_float_stay_apart() -> None:
    large = 2**60
    layer = Annotations([0, 0], [[0, 0], [3, 0]], [large, large + 1])
    score = tracking.evaluate(layer, layer).score
    assert (score.idf1, score.truth_persons) == (1.0, 2)


def test_scores_of_nothing_are_not_defined() -> None:
    nobody = Annotations([], [], [])
    score = tracking.evaluate(nobody, nobody).score
    assert all(math.isnan(value) for value in (score.mota, score.motp, score.idf1))


def test_finding_nobody_scores_zero() -> None:
    score = tracking.evaluate(crossing_people()[0], Annotations([], [], [])).score
    assert (score.mota, score.idf1, score.switches) == (0.0, 0.0, 0)


def test_layers_without_identities_cannot_be_tracked() -> None:
    truth, found = crossing_people()
    with pytest.raises(MetricsError, match="carry no identities"):
        tracking.evaluate(truth, Annotations(found.frames, found.xy))
