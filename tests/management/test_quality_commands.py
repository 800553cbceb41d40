"""What statistics, comparelayers and agreement print."""

from __future__ import annotations

import json
from io import StringIO
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from django.core.management import CommandError, call_command
from PIL import Image as Picture

from gtm_hit.models import Layer
from gtm_hit.ops.quality.comparing import as_numbers, compare
from gtm_hit.ops.quality.statistics.figures import FIGURES
from gtm_hit.ops.work import assignments, batches
from tests.ops.quality.scene import two_layers
from tests.work_scene import finish, make_dataset, make_worker, row, save


@pytest.fixture(autouse=True)
def tables(tmp_path: Path, settings: Any) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def layers(db: None) -> tuple[Layer, Layer]:
    return two_layers()


def run(*arguments: str, **options: Any) -> str:
    output = StringIO()
    call_command(*arguments, stdout=output, **options)
    return output.getvalue().strip()


def test_statistics_print_counts_and_coverage(layers: tuple[Layer, Layer]) -> None:
    lines = run("statistics", "square", "truth").splitlines()
    assert "annotations        320" in lines
    assert any(line.startswith("coverage 0, 1 …") for line in lines)


def test_statistics_as_json_are_one_object(layers: tuple[Layer, Layer]) -> None:
    numbers = json.loads(run("statistics", "square", "truth", "--json", "--every", "4"))
    assert (numbers["frames"], numbers["people"], numbers["annotations"]) == (40, 8, 320)
    assert numbers["coverage"]["positions"] == 100 * 100
    assert sum(numbers["visible_in_exactly"]) == 320


def test_figures_are_written_as_files(layers: tuple[Layer, Layer], tmp_path: Path) -> None:
    run("statistics", "square", "truth", "--figures", str(tmp_path / "figures"))
    files = sorted((tmp_path / "figures").iterdir())
    expected = [f"{name}.{kind}" for name in FIGURES for kind in ("svg", "png")]
    assert [file.name for file in files] == sorted([*expected, "numbers.csv"])
    for name in FIGURES:
        drawn = ElementTree.parse(tmp_path / "figures" / f"{name}.svg").getroot()
        with Picture.open(tmp_path / "figures" / f"{name}.png") as picture:
            assert picture.size == (3 * float(drawn.get("width")), 3 * float(drawn.get("height")))
            assert picture.convert("L").getextrema() == (0, 255)


def test_comparelayers_prints_the_scores_of_the_page(layers: tuple[Layer, Layer]) -> None:
    numbers = json.loads(run("comparelayers", "square", "truth", "found", "--json"))
    frames = numbers.pop("worst_frames")
    assert numbers == json.loads(json.dumps(as_numbers(compare(*layers))))
    assert len(frames) == 40
    assert f"{'moda':<20} {numbers['moda']:.4f}" in run("comparelayers", "square", "truth", "found")


def test_agreement_prints_pseudonyms_only(db: None) -> None:
    dataset = make_dataset(frames=2)
    batches.make_batches(dataset, copies=2)
    names = set()
    for who in ("ada-lovelace", "ben-franklin"):
        mine = assignments.claim(make_worker(who), dataset)
        save(mine.layer, dataset.frames.all()[0], [row(1, 1000)], author=mine.worker)
        names.add(finish(mine).worker.pseudonym)
    said = run("agreement", "square")
    assert said.startswith("batch 1: 100.0 % matched, median 0.000 m")
    assert "lovelace" not in said
    assert set(json.loads(run("agreement", "square", "--json"))["workers"]) == names


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("statistics", "square", "nobody"), "there are: found, truth"),
        (("statistics", "square", "truth", "--every", "0"), "--every must be 1 or more"),
        (("comparelayers", "square", "truth", "nobody"), "no layer nobody"),
        (("comparelayers", "square", "truth", "found", "--radius", "0"), "radius"),
        (("agreement", "nowhere"), "no dataset nowhere"),
        (("agreement", "square", "--radius", "-1"), "--radius must be"),
    ],
)
def test_what_cannot_be_measured_is_refused_in_words(
    layers: tuple[Layer, Layer], arguments: tuple[str, ...], said: str
) -> None:
    with pytest.raises(CommandError, match=said):
        run(*arguments)
