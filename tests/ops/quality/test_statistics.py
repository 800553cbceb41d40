from __future__ import annotations

import csv
import io
import json
import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from gtm_hit.metrics.annotations import Annotations
from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.datasets.rows import add_cameras
from gtm_hit.ops.quality.statistics.figures import FIGURES, figure
from gtm_hit.ops.quality.statistics.measuring import ground_coverage, layer_statistics
from gtm_hit.ops.quality.statistics.numbers import as_numbers, csv_header, csv_lines
from tests.browser.street import cameras
from tests.metrics.scenes import crossing_people
from tests.ops.quality.scene import put, two_layers, walk
from tests.work_scene import add_frames, make_dataset, make_layer, row, save


@pytest.fixture(autouse=True)
def tables(tmp_path: Path, settings: Any) -> None:
    settings.TABLES_ROOT = tmp_path


def wildtrack() -> Dataset:
    """The published grid and calibration."""
    dataset = Dataset.objects.create(slug="wildtrack", name="WILDTRACK")
    add_cameras(dataset, cameras())
    return dataset


def test_the_published_calibration_gives_the_papers_coverage(db: None) -> None:
    ground = ground_coverage(wildtrack())
    assert ground.counts.tolist() == [0, 77, 2481, 2458, 1625, 1735, 2095, 329]
    assert ground.mean == pytest.approx(3.93, abs=0.005)


def test_counts_are_those_of_the_layer(db: None) -> None:
    truth, _ = two_layers()
    found = layer_statistics(truth)
    assert (found.summary.frames, found.summary.people, found.summary.annotations) == (40, 8, 320)
    assert found.visibility.exactly.sum() == 320
    assert found.people_per_frame.tolist() == [8] * 40


def test_speed_is_metres_per_second_between_neighbouring_frames(db: None) -> None:
    layer = make_layer(make_dataset(frames=10))
    walk(layer, 1, (-4.0, 0.0), (0.5, 0.0))
    assert layer_statistics(layer).speeds == pytest.approx([1.0] * 9)  # half a second between frames


def test_over_frames_that_are_missing_no_speed_is_known(db: None) -> None:
    dataset = make_dataset(frames=10)
    dataset.frames.filter(number__in=[20, 25]).delete()
    layer = make_layer(dataset)
    walk(layer, 1, (-4.0, 0.0), (0.5, 0.0))
    assert len(layer_statistics(layer).speeds) == 6


def test_visibility_takes_a_persons_own_height(db: None) -> None:
    layer = make_layer(make_dataset(frames=40))
    put(layer, crossing_people()[0], height=0.3, radius=2.0)  # wider than tall: not visible
    assert layer_statistics(layer).visibility.exactly[0] == 320


def test_a_person_without_own_height_is_as_tall_as_the_cylinder(db: None) -> None:
    dataset = make_dataset(frames=2)
    layer = make_layer(dataset)
    first, second = dataset.frames.all()
    save(layer, first, [row(1, 1000), row(2, 2000, height=1.6)])
    save(layer, second, [row(2, 2000, height=1.5)])
    found = layer_statistics(layer)
    assert found.heights.tolist() == pytest.approx([1.8, 1.55])
    assert found.own_heights == 1


def test_a_save_changes_the_numbers(db: None) -> None:
    layer = make_layer(make_dataset(frames=1))
    frame = layer.dataset.frames.get()
    save(layer, frame, [row(1)])
    assert layer_statistics(layer).summary.people == 1
    save(layer, frame, [row(1), row(2)], revision=1)
    assert layer_statistics(layer).summary.people == 2


def test_an_empty_layer_has_statistics_and_figures(db: None) -> None:
    layer = make_layer(make_dataset(frames=1))
    found, ground = layer_statistics(layer), ground_coverage(layer.dataset)
    assert found.summary.annotations == 0
    for name in FIGURES:
        ElementTree.fromstring(figure(name, found, ground))
    assert json.loads(json.dumps(as_numbers(found, ground), allow_nan=False))["speed"]["mean"] is None
    assert list(csv_lines(found, ground))


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_is_sound_xml(db: None, name: str) -> None:
    layer, _ = two_layers()
    drawn = figure(name, layer_statistics(layer), ground_coverage(layer.dataset))
    assert ElementTree.fromstring(drawn).tag == "{http://www.w3.org/2000/svg}svg"


def test_the_table_holds_every_number_once(db: None) -> None:
    layer, _ = two_layers()
    found, ground = layer_statistics(layer), ground_coverage(layer.dataset)
    stream = io.StringIO()
    csv.writer(stream).writerows([csv_header(), *csv_lines(found, ground)])
    rows = list(csv.DictReader(io.StringIO(stream.getvalue())))
    keys = [(line["quantity"], line["of"]) for line in rows]
    assert len(keys) == len(set(keys))
    value = {(line["quantity"], line["of"]): float(line["value"]) for line in rows if line["value"]}
    assert value["annotations", ""] == 320
    assert sum(value["visible in exactly", str(views)] for views in range(3)) == 320
    speeds = [number for (name, _), number in value.items() if name == "speeds from"]
    assert sum(speeds) == len(found.speeds)
    assert not any(math.isnan(number) for number in value.values())


def test_frames_without_annotations_count_as_frames(db: None) -> None:
    dataset = make_dataset(frames=1)
    add_frames(dataset, 2)
    layer = make_layer(dataset, kind=Layer.Kind.IMPORTED)
    put(layer, Annotations([0], [[0.0, 0.0]], [1]))  # type: ignore[arg-type]
    found = layer_statistics(layer)
    assert (found.summary.frames, found.people_per_frame.tolist()) == (3, [1, 0, 0])
