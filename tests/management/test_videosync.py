"""From videos to offsets to a dataset, each step a process of its own."""

from __future__ import annotations

import json
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from django.core.management import CommandError, call_command

from tests.calibration.sync.test_sound import make_sound
from tests.dataset_folder import NAMES
from tests.ops.site import Site
from tests.sync_scene import make_folder
from tests.video_files import make_videos

SCENE = ("--grid", "80x60", "--step", "0.1", "--origin", "-4,-3")
BEGAN = (1.5, 0.0, 0.5)  # seconds at which the videos were switched on


def test_offsets_go_from_the_guess_through_a_file_into_the_import(tmp_path: Path) -> None:
    folder = tmp_path / "incoming" / "plaza"
    make_videos(folder, 90)
    for name, began in zip(NAMES, BEGAN, strict=True):
        make_sound(folder / f"{name}.wav", began)
    site, file = Site(tmp_path), folder / "offsets.txt"
    site.python("manage.py", "migrate", "--verbosity", "0")
    videos = [str(folder / f"{name}.mp4") for name in NAMES]
    site.python("manage.py", "calibrate", "sync", *videos, "--output", str(file))
    lines = file.read_text().splitlines()
    assert lines[0].startswith("# By sound")
    guessed = [float(line.partition("@")[2]) for line in lines[1:]]
    assert guessed == pytest.approx([0.0, 1.5, 1.0], abs=0.005)
    told = site.python("manage.py", "videosync", "incoming/plaza", "--guess", "--output", str(file), "--json")
    assert json.loads(told)["lines"] == file.read_text().splitlines()
    words = ["importvideos", "square", str(folder / "calibrations"), "--offsets", str(file), *SCENE]
    # The three share 1.5 s less half a picture: frames 0, 5 and 10.
    assert "3 frames with 9 images added." in site.python("manage.py", *words)


def run(*words: object) -> str:
    out = StringIO()
    call_command("videosync", *map(str, words), stdout=out, stderr=StringIO())
    return out.getvalue()


@pytest.fixture
def folder(db: None, settings: Any, tmp_path: Path) -> Path:
    settings.DATA_DIR = tmp_path
    settings.INCOMING_ROOT, settings.UPLOADS_ROOT = tmp_path / "incoming", tmp_path / "uploads"
    return make_folder(settings.INCOMING_ROOT)


def test_an_offset_is_set_undone_and_done_again(folder: Path) -> None:
    assert "C2 = C2.mp4 @ -1.2500+35.00ppm" in run("incoming/plaza", "--set", "C2=-1.25+35ppm")
    assert "C2 = C2.mp4 @ 0.0000\n" in run("incoming/plaza", "--undo")
    assert "C2 = C2.mp4 @ -1.2500+35.00ppm" in run("incoming/plaza", "--redo")
    assert run().startswith("incoming/plaza, revision 5")


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("incoming/nowhere",), "there is no folder incoming/nowhere; there are: incoming/plaza"),
        (("incoming/plaza", "--set", "C9=1"), "There is no camera C9"),
        (("incoming/plaza", "--set", "C2=soon"), "does not read CAMERA=SECONDS"),
        (("incoming/plaza", "--guess"), "common motion"),
    ],
)
def test_what_cannot_be_done_is_said(folder: Path, words: tuple[str, ...], reason: str) -> None:
    with pytest.raises(CommandError, match=reason):
        run(*words)
    if words[0] == "incoming/plaza":
        assert "C2 = C2.mp4 @ 0.0000" in run("incoming/plaza")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("C1 = a.mp4 @ soon\nC2 = b.mp4 @ 1\nC3", r"line 1: .*line 3: .*CAMERA=FILE@SECONDS"),
        ("# nothing\n\n", "no video is named"),
        ("C1 = a.mp4 @ 1+99999ppm\n", "no clock's"),
    ],
)
def test_a_wrong_file_of_offsets_is_told_line_by_line(
    db: None, tmp_path: Path, text: str, reason: str
) -> None:
    file = tmp_path / "offsets.txt"
    file.write_text(text)
    with pytest.raises(CommandError, match=reason):
        call_command("importvideos", "square", str(tmp_path), "--offsets", str(file))
    with pytest.raises(CommandError, match="name the videos, or give --offsets"):
        call_command("importvideos", "square", str(tmp_path))
