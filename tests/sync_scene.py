"""A folder of videos whose pictures tell their numbers, with known clocks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gtm_hit.models import VideoSync
from gtm_hit.ops.files import sources
from gtm_hit.ops.sync import drafts
from tests.video_files import make_video

RATES = {"C1": 25.0, "C2": 30000 / 1001}


def make_folder(incoming: Path, name: str = "plaza") -> Path:
    folder = incoming / name
    for camera, rate in RATES.items():
        make_video(folder / f"{camera}.mp4", round(3 * rate), rate)
    return folder


def opened_draft(incoming: Path) -> VideoSync:
    make_folder(incoming)
    source = sources.source("incoming/plaza")
    assert source is not None
    return drafts.open_draft(source)


def changed(whole: dict[str, Any], name: str, /, **values: Any) -> dict[str, Any]:
    """What a save sends when one clock is another one."""
    clocks = [{**each, **values} if each["camera"] == name else each for each in whole["clocks"]]
    kept = {key: whole[key] for key in ("revision", "events", "reference")}
    return {**kept, "clocks": clocks}
