"""One wording for datasets and layers that are not there, whichever command is asked."""

from __future__ import annotations

from pathlib import Path

import pytest
from django.core.management import CommandError, call_command

from tests.ops.square_layer import make_square
from tests.work_scene import make_layer

pytestmark = pytest.mark.django_db

OF_DATASETS = [
    ("agreement",),
    ("comparelayers", "truth", "found"),
    ("exportlayer", "truth", "folder"),
    ("exportpom", "file.pom"),
    ("importannotations", "people.csv", "--format", "csv"),
    ("makebatches",),
    ("makelink",),
    ("makerelease", "truth", "--licence", "licence"),
    ("progress",),
    ("releases",),
    ("replacecalibration", "cameras.json"),
    ("statistics", "truth"),
]
OF_LAYERS = [
    ("comparelayers", "square", "truth", "nobody"),
    ("exportlayer", "square", "nobody", "folder"),
    ("makerelease", "square", "nobody", "--licence", "licence"),
    ("statistics", "square", "nobody"),
]


@pytest.fixture(autouse=True)
def square(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    make_layer(make_square(), "truth")


@pytest.mark.parametrize("words", OF_DATASETS, ids=lambda words: words[0])
def test_a_dataset_that_is_not_there_is_told_with_those_that_are(words: tuple[str, ...]) -> None:
    with pytest.raises(CommandError, match=r"^no dataset nowhere; there are: square$"):
        call_command(words[0], "nowhere", *words[1:])


@pytest.mark.parametrize("words", OF_LAYERS, ids=lambda words: words[0])
def test_a_layer_that_is_not_there_is_told_with_those_that_are(words: tuple[str, ...]) -> None:
    with pytest.raises(CommandError, match=r"^no layer nobody in dataset square; there are: truth$"):
        call_command(*words)


def test_jobs_of_a_dataset_that_is_not_there_are_not_none(db: None) -> None:
    with pytest.raises(CommandError, match=r"^no dataset nowhere; there are: square$"):
        call_command("jobs", "--dataset", "nowhere")
