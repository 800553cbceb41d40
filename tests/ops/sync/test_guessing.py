"""Offsets guessed from files: videos drawn of the demo scene, sounds beside them."""

from __future__ import annotations

import json
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.ops.datasets.videos.options import parse_source
from gtm_hit.ops.sync.guessing import SyncRefused, Video, guess
from tests.calibration.sync.test_sound import make_sound
from tests.filmed_videos import STARTS, make_filmed
from tests.video_files import make_video


@pytest.fixture(scope="module")
def filmed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("filmed")
    return make_filmed(folder, folder)


def videos_in(folder: Path) -> list[Video]:
    return [Video(path.stem, path) for path in sorted(folder.glob("*.mp4"))]


def test_motion_on_the_shared_ground_tells_offsets_within_50_ms(filmed: Path) -> None:
    out = StringIO()
    videos = [str(video.path) for video in videos_in(filmed)]
    options = ["--calibration", str(filmed / "cameras.json"), "--json"]
    call_command("calibrate", "sync", *videos, *options, stdout=out)
    found = json.loads(out.getvalue())
    assert found["basis"] == "ground"
    sources = [parse_source(text) for text in found["importvideos"].split(" ")]
    assert [source.path for source in sources] == [video.path for video in videos_in(filmed)]
    # What happens at the shared time 0 is in a video that begins at `start` at the second `zero - start`.
    zeros = np.array([source.offset for source in sources]) + STARTS
    assert np.abs(zeros - np.median(zeros)).max() < 0.05


def test_without_a_calibration_the_whole_pictures_say_too_little(filmed: Path) -> None:
    with pytest.raises(SyncRefused, match=r"no common motion.*no calibration was given"):
        guess(videos_in(filmed))


def test_sound_beside_the_videos_is_asked_first(tmp_path: Path) -> None:
    videos = [Video(name, make_video(tmp_path / f"{name}.mp4", 30)) for name in ("C1", "C2")]
    make_sound(tmp_path / "C1.wav", 0.0)
    make_sound(tmp_path / "C2.WAV", 3.125)
    found = guess(videos)
    assert found.basis == "sound"
    assert [place.offset for place in found.places] == [pytest.approx(3.125, abs=0.005), 0.0]


def test_one_video_a_camera_named_twice_and_what_is_no_video_are_refused(tmp_path: Path) -> None:
    video = make_video(tmp_path / "C1.mp4", 30)
    (tmp_path / "C2.mp4").write_bytes(b"no video")
    with pytest.raises(CommandError, match="Two videos at least"):
        call_command("calibrate", "sync", str(video))
    with pytest.raises(CommandError, match="the same camera"):
        call_command("calibrate", "sync", str(video), str(video))
    with pytest.raises(CommandError, match=r"C2\.mp4: no video that can be decoded"):
        call_command("calibrate", "sync", str(video), str(tmp_path / "C2.mp4"))
