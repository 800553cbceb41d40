from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.metrics.annotations import Annotations, MetricsError, by_frame


def test_no_annotations_at_all_are_fine() -> None:
    assert len(Annotations([], [], [])) == 0


def test_a_missing_place_is_refused() -> None:
    with pytest.raises(MetricsError, match=r"xy has shape \(1, 2\), not \(2, 2\)"):
        Annotations([0, 5], [[1.0, 2.0]])


def test_a_place_that_is_not_finite_is_refused_by_row() -> None:
    with pytest.raises(MetricsError, match="xy of row 1 is not finite"):
        Annotations([0, 5], [[1.0, 2.0], [np.nan, 2.0]])


def test_fractional_frame_numbers_are_refused() -> None:
    with pytest.raises(MetricsError, match="frames must be a list of whole numbers, not float64"):
        Annotations([0.5], [[1.0, 2.0]])


def test_a_person_in_two_places_of_one_frame_is_refused_by_name() -> None:
    with pytest.raises(MetricsError, match="person 7 is annotated more than once in frame 5"):
        Annotations([5, 0, 5], [[1, 2], [1, 2], [3, 4]], [7, 7, 7])


def test_asking_for_identities_that_are_not_there_is_an_error() -> None:
    with pytest.raises(MetricsError, match="carry no identities"):
        Annotations([0], [[1.0, 2.0]]).identities()


def test_frames_of_either_side_come_once_and_in_order() -> None:
    truth = Annotations([10, 0, 10], np.zeros((3, 2)))
    found = Annotations([5, 10], np.zeros((2, 2)))
    frames = [(number, rows.tolist(), others.tolist()) for number, rows, others in by_frame(truth, found)]
    assert frames == [(0, [1], []), (5, [], [0]), (10, [0, 2], [1])]
