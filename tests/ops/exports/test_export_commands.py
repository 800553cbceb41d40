"""exportlayer and exportpom."""

from __future__ import annotations

from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.formats.manifest import verify
from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.exports import exporting
from tests.ops.exports.scene import run_job
from tests.work_scene import make_dataset

pytestmark = [pytest.mark.django_db, pytest.mark.usefixtures("exports")]


def command(name: str, *arguments: Any) -> str:
    out = StringIO()
    call_command(name, *arguments, stdout=out, stderr=StringIO())
    return out.getvalue()


def test_the_command_writes_the_same_files_as_a_job(layer: Layer, tmp_path: Path) -> None:
    out = command("exportlayer", "square", "own", tmp_path / "by-hand")
    assert "2 frames, 2 annotations" in out
    done = exporting.finished(run_job(layer))
    assert done is not None
    assert (tmp_path / "by-hand.zip").read_bytes() == done.archive.read_bytes()


def test_the_command_refuses_a_folder_with_other_things_in_it(layer: Layer, tmp_path: Path) -> None:
    folder = tmp_path / "thesis"
    folder.mkdir()
    (folder / "chapter.tex").write_text("years of work")
    with pytest.raises(CommandError, match="holds no export"):
        command("exportlayer", "square", "own", folder)
    assert [path.name for path in folder.iterdir()] == ["chapter.tex"]


def test_the_command_takes_an_empty_folder_and_an_earlier_export(layer: Layer, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    command("exportlayer", "square", "own", folder)
    command("exportlayer", "square", "own", folder)
    assert verify(folder) == []


def test_the_command_names_the_layers_there_are(layer: Layer, tmp_path: Path) -> None:
    with pytest.raises(CommandError, match="there are: own"):
        command("exportlayer", "square", "onw", tmp_path / "out")


def test_the_pom_file_has_a_line_per_camera_and_position(tmp_path: Path) -> None:
    dataset = make_dataset(frames=1)
    Dataset.objects.update(columns=20, rows=30)
    command("exportpom", dataset.slug, tmp_path / "rectangles.pom")
    lines = (tmp_path / "rectangles.pom").read_text().splitlines()
    assert sum(line.startswith("RECTANGLE ") for line in lines) == 2 * 20 * 30
    assert "NB_WIDTH 20" in lines and "NB_HEIGHT 30" in lines
    with pytest.raises(CommandError, match="there are: square"):
        command("exportpom", "circle", tmp_path / "circle.pom")
