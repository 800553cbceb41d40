"""Pictures of videos for the browser: no browser decodes every video, and none seeks to a frame for certain.

They are decoded by what decodes an import's pictures. What follows a picture is wanted next, so some are
decoded together and kept on the disk for a day.
"""

from __future__ import annotations

import hashlib
import shutil
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from threading import Event
from typing import Any

import cv2
import numpy as np
from django.conf import settings

from gtm_hit.formats.files import write_bytes
from gtm_hit.ops.datasets.videos.nearest import Taken, nearest_pictures
from gtm_hit.ops.datasets.videos.video import VideoError, VideoReader, opened
from gtm_hit.ops.files.images import Pixels

WIDTHS = (480, 960, 1920)
QUALITY = 85
TOGETHER = 8
BACK = 1.0  # seconds before the wanted one that reading begins: containers seek roughly
KEPT = timedelta(days=1)
_TIME = struct.Struct("<d")


@dataclass(frozen=True)
class Picture:
    time: float  # its own, seconds of the video
    jpeg: bytes


def picture(video: Path, facts: dict[str, Any], at: int, width: int) -> Picture:
    """The one nearest to `at` milliseconds, the last one where the video ends before. Raises VideoError."""
    interval, start = facts["interval"], facts["start"]
    at = max(min(at, round(1000 * (start + facts["duration"] - interval))), round(1000 * start))
    folder = _folder(video, facts["version"])
    if (kept := _kept(folder, at, width)) is not None:
        return kept
    number = round((at / 1000 - start) / interval)
    following = [round(1000 * (start + (number + more) * interval)) for more in range(1, TOGETHER)]
    wanted = [at, *(each for each in following if each > at)]
    for each, taken in zip(wanted, _taken(video, interval, [each / 1000 for each in wanted]), strict=False):
        _keep(folder, each, width, taken)
    if (kept := _kept(folder, at, width)) is None:
        raise VideoError(f"no picture at {at / 1000:.3f} s can be decoded")
    return kept


@dataclass(frozen=True)
class Strip:
    """Pictures one below the other, and the time of each."""

    times: tuple[float, ...]
    jpeg: bytes


def strip(video: Path, facts: dict[str, Any], at: int, step: int, count: int, width: int) -> Strip:
    """`count` pictures, `step` milliseconds apart, fewer where the video ends. Raises VideoError.

    Read forwards once: playing asks for a second or two at a time.
    """
    wanted = [(at + step * index) / 1000 for index in range(count)]
    taken = list(_taken(video, facts["interval"], wanted))
    if not taken:
        raise VideoError(f"no picture at {at / 1000:.3f} s can be decoded")
    stacked = np.vstack([_smaller(each.pixels, width) for each in taken])
    return Strip(tuple(each.time for each in taken), _jpeg(stacked))


def remove_old(now: datetime) -> None:
    oldest = (now - KEPT).timestamp()
    for folder in _root().glob("*"):
        if folder.stat().st_mtime < oldest:
            shutil.rmtree(folder, ignore_errors=True)


def _root() -> Path:
    return settings.DATA_DIR / "video-pictures"


def _folder(video: Path, version: str) -> Path:
    return _root() / hashlib.sha256(f"{video}\0{version}".encode()).hexdigest()[:32]


def _kept(folder: Path, at: int, width: int) -> Picture | None:
    try:
        content = (folder / f"{at}-{width}").read_bytes()
    except FileNotFoundError:
        return None
    return Picture(_TIME.unpack_from(content)[0], content[_TIME.size :])


def _keep(folder: Path, at: int, width: int, taken: Taken) -> None:
    content = _TIME.pack(taken.time) + _jpeg(_smaller(taken.pixels, width))
    write_bytes(folder / f"{at}-{width}", content)


def _smaller(pixels: Any, width: int) -> Any:
    height, full = pixels.shape[:2]
    if full <= width:
        return pixels
    return cv2.resize(pixels, (width, round(height * width / full)), interpolation=cv2.INTER_AREA)


def _jpeg(pixels: Any) -> bytes:
    written, data = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    if not written:
        raise VideoError("the picture cannot be encoded")
    return data.tobytes()


def _taken(video: Path, interval: float, times: list[float]) -> Iterator[Taken]:
    start = max(times[0] - BACK, 0.0)
    reader = _Ahead(_reader(video, interval, start))
    if start > 0 and not start - BACK <= reader.first <= times[0]:
        # It went elsewhere, or its pictures carry no times: then they are counted from the beginning.
        start, reader = 0.0, _Ahead(_reader(video, interval, 0.0))

    def read_again(index: int) -> Pixels:
        again = _reader(video, interval, start)
        for _ in range(index + 1):
            again.grab()
        return again.pixels()

    yield from nearest_pictures(reader, times, read_again)


def _reader(video: Path, interval: float, start: float) -> VideoReader:
    capture = opened(video)
    if start > 0:
        capture.set(cv2.CAP_PROP_POS_MSEC, 1000 * start)
    return VideoReader(capture, interval, Event())


class _Ahead:
    """A reader whose first time is known before it is asked for."""

    def __init__(self, reader: VideoReader) -> None:
        self.reader = reader
        self.told = reader.grab()
        self.fresh = True

    @property
    def first(self) -> float:
        return float("inf") if self.told is None else self.told

    @property
    def interval(self) -> float:
        return self.reader.interval

    def grab(self) -> float | None:
        if self.fresh:
            self.fresh = False
            return self.told
        return self.reader.grab()

    def pixels(self) -> Pixels:
        return self.reader.pixels()
