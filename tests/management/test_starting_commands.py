"""Every command as a shell starts it: `call_command` goes another way in."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import REPOSITORY
from tests.dataset_folder import NAMES
from tests.ops.site import Site
from tests.video_files import make_videos

COMMANDS = sorted(path.stem for path in (REPOSITORY / "gtm_hit/management/commands").glob("[!_]*.py"))
SCENE = ("--grid", "80x60", "--step", "0.1", "--origin", "-4,-3")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(tmp_path: Path, command: str) -> None:
    assert Site(tmp_path).python("manage.py", command, "--help").startswith(f"usage: manage.py {command}")


def test_videos_are_imported_by_the_command(tmp_path: Path) -> None:
    make_videos(tmp_path, 60)
    site = Site(tmp_path)
    site.python("manage.py", "migrate", "--verbosity", "0")
    videos = [f"{name}={tmp_path / name}.mp4@0" for name in NAMES]
    told = site.python("manage.py", "importvideos", "square", str(tmp_path / "calibrations"), *videos, *SCENE)
    assert "4 frames with 12 images added." in told
    assert site.sql("SELECT origin_x, origin_y FROM gtm_hit_dataset") == [(-4.0, -3.0)]
