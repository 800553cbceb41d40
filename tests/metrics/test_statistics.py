from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from gtm_hit.metrics import statistics
from gtm_hit.metrics.annotations import Annotations, MetricsError
from tests.metrics.strategies import layers

FRAMES = [0, 5, 10, 15, 20]


def walkers() -> Annotations:
    """Person 1 walks 1 m, 2 m, then (after a frame without annotation) 3 m; person 4 stands in two frames."""
    return Annotations(
        [15, 0, 5, 10, 0, 5, 20],
        [[6.0, 0.0], [0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [9.0, 9.0], [9.0, 9.0], [6.0, 4.0]],
        [1, 1, 1, 1, 4, 4, 1],
    ).take(np.array([6, 1, 2, 3, 4, 5]))


def test_frames_where_nobody_is_count_as_frames() -> None:
    assert statistics.people_per_frame(walkers(), FRAMES).tolist() == [2, 2, 1, 0, 1]


def test_tracks_know_their_annotations_their_span_and_their_path() -> None:
    tracks = statistics.tracks_of(walkers(), FRAMES)
    assert tracks.persons.tolist() == [1, 4]
    assert tracks.annotations.tolist() == [4, 2]
    assert tracks.span.tolist() == [5, 2]
    assert tracks.path.tolist() == [1.0 + 2.0 + 5.0, 0.0]


def test_speeds_are_taken_between_neighbouring_frames_only() -> None:
    speeds = statistics.speeds(walkers(), FRAMES, seconds_per_frame=0.5)
    assert sorted(speeds.tolist()) == [0.0, 2.0, 4.0]


def test_views_are_counted_per_view_and_per_annotation() -> None:
    visible = np.array([[1, 1, 0], [1, 0, 0], [0, 0, 0], [1, 1, 1]], dtype=bool)
    seen = statistics.visibility(visible)
    assert seen.per_view.tolist() == [3, 2, 1]
    assert seen.exactly.tolist() == [1, 1, 1, 1]
    assert seen.mean_views == 1.5


def test_a_distribution_is_described_by_its_percentiles() -> None:
    shape = statistics.distribution(np.arange(101))
    assert (shape.least, shape.p05, shape.median, shape.p95, shape.most) == (0, 5, 50, 95, 100)
    assert (shape.count, shape.mean) == (101, 50.0)


def test_nothing_has_no_distribution() -> None:
    shape = statistics.distribution([])
    assert shape.count == 0 and math.isnan(shape.mean) and math.isnan(shape.most)


def test_an_empty_layer_has_frames_and_no_tracks() -> None:
    nobody = Annotations([], [], [])
    assert statistics.people_per_frame(nobody, FRAMES).tolist() == [0] * 5
    assert len(statistics.tracks_of(nobody, FRAMES).persons) == 0
    assert len(statistics.speeds(nobody, FRAMES, 0.5)) == 0


def test_an_annotated_frame_that_is_not_among_the_frames_is_refused() -> None:
    with pytest.raises(MetricsError, match="frame 20 is annotated but not among the frames"):
        statistics.people_per_frame(walkers(), [0, 5, 10, 15])


@given(layers())
def test_every_annotation_is_in_one_frame_and_in_one_track(layer: Annotations) -> None:
    frames = [0, 5, 10, 15]
    tracks = statistics.tracks_of(layer, frames)
    assert statistics.people_per_frame(layer, frames).sum() == tracks.annotations.sum() == len(layer)
    assert (tracks.annotations <= tracks.span).all()


@given(layers())
def test_without_gaps_the_speeds_add_up_to_the_paths(layer: Annotations) -> None:
    present = np.unique(layer.frames)
    whole = [p for p in np.unique(layer.persons) if (layer.persons == p).sum() == len(present)]
    steady = layer.take(np.flatnonzero(np.isin(layer.persons, whole)))
    if len(steady):
        walked = statistics.speeds(steady, present, 2.0).sum() * 2.0
        assert walked == pytest.approx(statistics.tracks_of(steady, present).path.sum())
