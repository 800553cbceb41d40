from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from gtm_hit.metrics import hota
from gtm_hit.metrics.annotations import Annotations
from tests.metrics.scenes import crossing_people
from tests.metrics.strategies import layers


def figures(score: hota.HotaScore) -> tuple[float, float, float, float]:
    return score.hota, score.detection, score.association, score.localisation


def test_one_person_found_half_the_time_scores_a_half() -> None:
    # DetA = 2/4; AssA: both matches share a pair seen 2 times of 4: 2/4.
    truth = Annotations([0, 1, 2, 3], np.zeros((4, 2)), [1, 1, 1, 1])
    found = Annotations([0, 1], np.zeros((2, 2)), [9, 9])
    assert figures(hota.evaluate(truth, found)) == pytest.approx((0.5, 0.5, 0.5, 1.0))


def test_a_new_identity_half_way_costs_association_alone() -> None:
    truth = Annotations([0, 1, 2, 3], np.zeros((4, 2)), [1, 1, 1, 1])
    found = Annotations([0, 1, 2, 3], np.zeros((4, 2)), [8, 8, 9, 9])
    assert figures(hota.evaluate(truth, found)) == pytest.approx((math.sqrt(0.5), 1.0, 0.5, 1.0))


@given(layers())
def test_a_layer_agrees_perfectly_with_itself_under_other_names(layer: Annotations) -> None:
    # Two people in one place are the same to HOTA; with them a perfect score needs more than renaming.
    places = np.column_stack((layer.frames, layer.xy))
    assume(len(layer) and len(np.unique(places, axis=0)) == len(layer))
    renamed = Annotations(layer.frames, layer.xy, layer.identities() * 7 + 3)
    assert figures(hota.evaluate(layer, renamed)) == pytest.approx((1.0, 1.0, 1.0, 1.0))


@given(layers(), layers(), st.sampled_from([0.1, 0.5]))
def test_scores_stay_within_their_bounds(a: Annotations, b: Annotations, radius: float) -> None:
    for value in figures(hota.evaluate(a, b, radius)):
        assert math.isnan(value) or 0.0 <= value <= 1.0 + 1e-12


def test_finding_nobody_scores_zero_and_nothing_at_all_is_not_defined() -> None:
    somebody, nobody = crossing_people()[0], Annotations([], [], [])
    assert hota.evaluate(somebody, nobody).hota == 0.0
    assert hota.evaluate(nobody, somebody).hota == 0.0
    assert math.isnan(hota.evaluate(nobody, nobody).hota)
