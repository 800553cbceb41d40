from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.models import Annotation, Dataset, Layer
from gtm_hit.ops.proposals import looking, runs
from tests.ops.proposals.conftest import NUMBERS, dataset  # noqa: F401
from tests.ops.proposals.watcher import Watcher, walk


def printed(*arguments: Any) -> str:
    stream = io.StringIO()
    call_command(*map(str, arguments), stdout=stream, stderr=io.StringIO())
    return stream.getvalue()


@pytest.fixture(autouse=True)
def watcher(dataset: Dataset, monkeypatch: pytest.MonkeyPatch) -> Watcher:  # noqa: F811
    made = Watcher(dataset, walk(NUMBERS), alarms=["C2"])
    monkeypatch.setattr(looking, "looker", lambda *_order: made)
    return made


def test_propose_makes_a_layer_that_comparelayers_judges() -> None:
    out = printed("propose", "square", "--layer", "found")
    assert "8 people in 1 tracks" in out
    assert "C2 disagrees" in out
    assert json.loads(printed("comparelayers", "square", "found", "found", "--json"))["moda"] == 1


def test_only_with_use_annotators_see_what_was_made_for_a_layer(dataset: Dataset) -> None:  # noqa: F811
    printed("propose", "square", "--layer", "found")
    assert runs.in_use(dataset) is None
    told = json.loads(printed("propose", "square", "--json"))
    assert (told["frames"], told["known"]) == (0, 8)
    assert runs.in_use(dataset) is not None


def test_a_file_is_taken_in(dataset: Dataset, tmp_path: Path) -> None:  # noqa: F811
    file = tmp_path / "found.csv"
    file.write_text("frame,person,x,y\n0,1,1.0,0\n5,1,1.2,0\n")
    printed("propose", "square", "--from-file", file, "--format", "csv", "--layer", "theirs")
    assert Annotation.objects.filter(layer__name="theirs").count() == 2


@pytest.mark.parametrize(
    "wrong",
    [
        ["--layer", "no spaces"],
        ["--threshold", "2"],
        ["--from-file", "/nowhere.csv", "--format", "csv"],
    ],
)
def test_what_cannot_be_done_says_so_and_makes_nothing(watcher: Watcher, wrong: list[str]) -> None:
    with pytest.raises(CommandError):
        printed("propose", "square", *wrong)
    assert watcher.looked == []
    assert not Layer.objects.exists()


def test_missing_lists_places_and_decides_about_them() -> None:
    printed("propose", "square", "--layer", "found", "--use")
    taken = Annotation.objects.get(layer__name="found", frame__number=15)
    position = taken.position
    taken.delete()
    assert f"00000015  {position:8d}" in printed("missing", "square", "found")
    told = json.loads(printed("missing", "square", "found", "--json"))
    assert [place["frame"] for place in told["places"]] == [15]
    printed("missing", "square", "found", "--place", 15, position, "--person", 1)
    assert "0 places in 8 frames" in printed("missing", "square", "found")
    with pytest.raises(CommandError, match="already"):
        printed("missing", "square", "found", "--place", 15, position, "--person", 1)
