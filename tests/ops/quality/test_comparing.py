from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from gtm_hit.metrics import detection, tracking
from gtm_hit.models import Annotation, Layer, LayerFrame
from gtm_hit.ops.quality.comparing import Kind, Scope, as_numbers, compare, frame_lines, marks
from gtm_hit.ops.quality.layer_rows import QualityError, read_layers, state_of
from tests.metrics.scenes import crossing_people
from tests.ops.quality.scene import on_grid, put, two_layers
from tests.work_scene import make_dataset, make_layer, row, save


@pytest.fixture
def layers(db: None, tmp_path: Path, settings: Any) -> tuple[Layer, Layer]:
    settings.TABLES_ROOT = tmp_path
    return two_layers()


def test_scores_are_those_of_the_metrics_on_the_stored_positions(layers: tuple[Layer, Layer]) -> None:
    truth, found = (on_grid(layers[0].dataset, side) for side in crossing_people())
    numbers = as_numbers(compare(*layers))
    expected = detection.evaluate(truth, found)
    assert numbers["moda"] == pytest.approx(expected.moda)
    assert numbers["modp"] == pytest.approx(expected.modp)
    assert (numbers["missed"], numbers["extra"]) == (expected.missed, expected.extra)
    identity = tracking.evaluate(truth, found).score
    assert numbers["idf1"] == pytest.approx(identity.idf1)
    assert numbers["hota"] == pytest.approx(identity.hota.hota)
    assert numbers["switches"] == identity.switches > 0


def test_frames_come_worst_first_and_sum_up_to_the_whole(layers: tuple[Layer, Layer]) -> None:
    result = compare(*layers)
    lines = frame_lines(result)
    mistakes = [line["missed"] + line["extra"] + line["swapped"] for line in lines]
    assert mistakes == sorted(mistakes, reverse=True)
    assert sum(line["missed"] for line in lines) == result.overall.missed
    assert sum(line["swapped"] for line in lines) == result.tracking.switches


def test_marks_of_a_frame_are_its_line_of_the_table(layers: tuple[Layer, Layer]) -> None:
    result = compare(*layers)
    for line in frame_lines(result):
        kinds = Counter(mark.kind for mark in marks(result, line["frame"]))
        assert kinds[Kind.MISSED] == line["missed"]
        assert kinds[Kind.EXTRA] == line["extra"]
        assert kinds[Kind.MATCHED] + kinds[Kind.SWAPPED] == line["matched"]


def test_a_swapped_person_tells_who_it_was_before(db: None) -> None:
    dataset = make_dataset(frames=2)
    truth, found = make_layer(dataset, "truth"), make_layer(dataset, "found")
    for frame, person in zip(dataset.frames.all(), (7, 9), strict=True):
        save(truth, frame, [row(1, 1000)])
        save(found, frame, [row(person, 1001)])
    (mark,) = marks(compare(truth, found), 5)
    assert (mark.kind, mark.before) == (Kind.SWAPPED, 7)
    assert mark.distance == pytest.approx(0.025)


def test_a_worker_is_not_blamed_for_frames_of_others(db: None) -> None:
    dataset = make_dataset(frames=4)
    truth, found = make_layer(dataset, "truth"), make_layer(dataset, "found")
    for frame in dataset.frames.all():
        save(truth, frame, [row(1, 1000)])
    save(found, dataset.frames.all()[1], [row(1, 1000)])
    both, either = compare(truth, found), compare(truth, found, scope=Scope.EITHER)
    assert (both.overall.missed, both.only_truth, len(both.numbers)) == (0, 3, 1)
    assert (either.overall.missed, len(either.numbers)) == (3, 4)


def test_a_frame_where_the_found_layer_confirmed_nobody_counts(db: None) -> None:
    dataset = make_dataset(frames=1)
    truth, found = make_layer(dataset, "truth"), make_layer(dataset, "found")
    save(truth, dataset.frames.get(), [row(1, 1000)])
    save(found, dataset.frames.get(), [], nobody=True)
    assert compare(truth, found).overall.missed == 1


def test_a_part_says_how_much_comes_later(layers: tuple[Layer, Layer]) -> None:
    part = compare(*layers, start=50, most=10)
    assert part.numbers.tolist() == list(range(50, 100, 5))
    assert part.later == 20
    assert np.unique(part.truth.frames).tolist() == part.numbers.tolist()


def test_a_save_changes_the_result(layers: tuple[Layer, Layer]) -> None:
    before = compare(*layers)
    assert compare(*layers) is before
    frame = layers[1].dataset.frames.all()[0]
    save(layers[1], frame, [], revision=1, nobody=True)
    assert compare(*layers).overall.missed > before.overall.missed


def test_layers_without_a_common_frame_are_refused(db: None) -> None:
    dataset = make_dataset(frames=2)
    one, other = make_layer(dataset, "one"), make_layer(dataset, "other")
    save(one, dataset.frames.all()[0], [row()])
    save(other, dataset.frames.all()[1], [row()])
    with pytest.raises(QualityError, match="no frame in common"):
        compare(one, other)


def test_layers_of_different_datasets_are_refused(db: None) -> None:
    one, other = make_layer(make_dataset("one")), make_layer(make_dataset("other"))
    with pytest.raises(QualityError, match="different datasets"):
        compare(one, other)


@pytest.mark.parametrize("radius", [0.0, -1.0, float("nan"), float("inf"), 11.0])
def test_a_radius_that_is_none_is_refused(layers: tuple[Layer, Layer], radius: float) -> None:
    with pytest.raises(QualityError, match="radius"):
        compare(*layers, radius=radius)


def test_reading_costs_two_queries_however_many_layers(layers: tuple[Layer, Layer]) -> None:
    with CaptureQueriesContext(connection) as queries:
        rows = read_layers(layers)
    assert len(queries) == 2
    assert {pk: len(one) for pk, one in rows.items()} == {
        layer.pk: Annotation.objects.filter(layer=layer).count() for layer in layers
    }


def test_sizes_a_row_does_not_have_are_nan(db: None) -> None:
    layer = make_layer(make_dataset(frames=40))
    put(layer, crossing_people()[0], height=1.5)
    rows = read_layers([layer])[layer.pk]
    assert (rows.heights == 1.5).all()
    assert np.isnan(rows.radii).all()


def test_a_layer_never_saved_has_a_state(db: None) -> None:
    layer = make_layer(make_dataset(frames=1))
    assert (state_of(layer).frames, state_of(layer).revisions) == (0, 0)
    assert not LayerFrame.objects.exists()


def test_layers_with_a_crowd_that_would_fill_the_memory_are_refused(layers: tuple[Layer, Layer]) -> None:
    truth, found = layers
    frame = LayerFrame.objects.filter(layer=truth).order_by("frame__number")[0].frame
    Annotation.objects.bulk_create(
        Annotation(layer=truth, frame=frame, person=person, position=person % 100)
        for person in range(1000, 1501)
    )
    with pytest.raises(QualityError, match="at most 500 are compared"):
        compare(truth, found)
