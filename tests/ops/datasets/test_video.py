"""Pictures out of files as cameras and recorders write them."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import numpy as np
import pytest

from gtm_hit.ops.datasets.videos.options import SourceError, VideoSource, parse_source
from gtm_hit.ops.datasets.videos.video import Stopped, VideoError, pictures, probe
from tests.video_files import make_uneven_video, make_video, number_in


def taken(path: Path, times: list[float]) -> list[int]:
    return [number_in(each.pixels) for each in pictures(path, probe(path).interval, times, Event())]


@pytest.mark.parametrize("name", ["a.mp4", "a.avi", "a.mkv"])
@pytest.mark.parametrize("rate", [25.0, 30000 / 1001, 12.5, 50.0])
def test_the_picture_of_an_instant_is_the_one_painted_then(tmp_path: Path, name: str, rate: float) -> None:
    path = make_video(tmp_path / name, 100, rate)
    times = [0.0, 0.1, 0.5, 1.0, 1.5]
    # A container's milliseconds may push a picture that lies exactly between two either way.
    expected = [{round(time * rate - 0.05), round(time * rate + 0.05)} for time in times]
    assert all(number in each for number, each in zip(taken(path, times), expected, strict=True))


@pytest.mark.parametrize("name", ["a.mkv", "a.mp4"])
def test_uneven_pictures_are_chosen_by_their_own_times(tmp_path: Path, name: str) -> None:
    milliseconds = [0, 40, 80, 300, 310, 700, 1000, 1020]
    path = make_uneven_video(tmp_path / name, milliseconds)
    times = [index / 20 for index in range(21)]
    assert taken(path, times) == [
        int(np.abs(np.array(milliseconds) - 1000 * time).argmin()) for time in times
    ]


def test_the_length_of_an_uneven_video_is_its_last_time(tmp_path: Path) -> None:
    facts = probe(make_uneven_video(tmp_path / "a.mp4", [0, 40, 80, 300, 310, 700, 1000]))
    assert facts.duration == pytest.approx(1.0 + 1 / 6)


def test_size_and_length_are_those_of_the_file(tmp_path: Path) -> None:
    facts = probe(make_video(tmp_path / "a.mp4", 75, 25.0, size=(160, 120)))
    assert (facts.width, facts.height) == (160, 120)
    assert (facts.interval, facts.duration) == pytest.approx((0.04, 3.0))


def test_a_time_in_the_video_is_told_with_each_picture(tmp_path: Path) -> None:
    path = make_video(tmp_path / "a.mp4", 30, 30.0)
    (found,) = pictures(path, 1 / 30, [0.35], Event())
    assert (found.index, found.time) == (10, pytest.approx(1 / 3, abs=0.001))


def test_a_reader_that_is_told_to_stop_stops(tmp_path: Path) -> None:
    path = make_video(tmp_path / "a.mp4", 30)
    stop = Event()
    stream = pictures(path, 1 / 30, [0.0, 0.5], stop)
    next(stream)
    stop.set()
    with pytest.raises(Stopped):
        next(stream)


def test_files_that_are_no_videos_are_refused(tmp_path: Path) -> None:
    (tmp_path / "text.mp4").write_text("not a video")
    (tmp_path / "empty.mp4").touch()
    for name, reason in [("text.mp4", "no video"), ("empty.mp4", "no video"), ("none.mp4", "no such file")]:
        with pytest.raises(VideoError, match=reason):
            probe(tmp_path / name)


def test_a_cut_off_file_is_refused_or_ends_early(tmp_path: Path) -> None:
    path = make_video(tmp_path / "a.mkv", 90)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    found = taken(path, [index / 10 for index in range(30)])
    assert 5 < len(found) < 30
    assert found[:5] == [0, 3, 6, 9, 12]


@pytest.mark.parametrize(
    ("text", "source"),
    [
        ("C1=a.mp4@0.12", VideoSource("C1", Path("a.mp4"), 0.12)),
        ("C1=a.mp4", VideoSource("C1", Path("a.mp4"), 0.0)),
        (" C2 = some where/a b.mp4 @ -1.5 ", VideoSource("C2", Path("some where/a b.mp4"), -1.5)),
        ("C3=/x@home/a.mp4@2", VideoSource("C3", Path("/x@home/a.mp4"), 2.0)),
        ("C3=/x@home/a.mp4", VideoSource("C3", Path("/x@home/a.mp4"), 0.0)),
    ],
)
def test_a_source_is_read(text: str, source: VideoSource) -> None:
    assert parse_source(text) == source


@pytest.mark.parametrize("text", ["", "C1", "=a.mp4", "C1=", "C1=a.mp4@x", "C1=a.mp4@nan", "C1=a.mp4@inf"])
def test_a_text_that_names_no_video_is_refused(text: str) -> None:
    with pytest.raises(SourceError):
        parse_source(text)
