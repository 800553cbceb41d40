"""One video file, decoded by OpenCV."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from threading import Event

import cv2
import numpy as np

from gtm_hit.formats.files import check_source
from gtm_hit.formats.problems import FormatError
from gtm_hit.ops.datasets.videos.nearest import Taken, nearest_pictures
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.files.images import Pixels

CHECKED_PICTURES = 60  # two seconds tell a steady clock from one that is not
FASTEST = 1000.0  # pictures per second; more is a header that does not know


class VideoError(OperationError, ValueError):
    """A video that cannot be used; says why."""


class Stopped(OperationError):
    """Whoever reads the video was asked to stop."""


@dataclass(frozen=True)
class Facts:
    """`interval`: usual seconds between two pictures; `duration`: seconds, as the header tells unless the
    pictures do not keep to its rate."""

    width: int
    height: int
    interval: float
    duration: float


def probe(path: Path) -> Facts:
    """Size and duration. Raises VideoError for what OpenCV cannot decode or tell the length of."""
    try:
        check_source(path)
    except FormatError as error:
        raise VideoError(error.problems[0].reason) from error
    capture = opened(path)
    rate, count = capture.get(cv2.CAP_PROP_FPS), capture.get(cv2.CAP_PROP_FRAME_COUNT)
    if not (math.isfinite(rate) and 0 < rate <= FASTEST):
        raise VideoError("does not tell how many pictures a second has")
    if not (math.isfinite(count) and count >= 1):
        raise VideoError("does not tell how long it is; a container like MP4 or MKV does")
    reader = VideoReader(capture, 1 / rate)
    if reader.grab() is None:
        raise VideoError("holds no picture that can be decoded")
    height, width = reader.pixels().shape[:2]
    return Facts(width, height, *_clock(reader, count))


def pictures(path: Path, interval: float, times: Iterable[float], stop: Event) -> Iterator[Taken]:
    """The pictures nearest to ascending `times`, in seconds of the video, until it ends.

    Raises Stopped soon after `stop` was set, VideoError for a picture that cannot be decoded.
    """

    def read_again(index: int) -> Pixels:
        again = VideoReader(opened(path), interval, stop)
        for _ in range(index + 1):
            again.grab()
        return again.pixels()

    return nearest_pictures(VideoReader(opened(path), interval, stop), times, read_again)


def opened(path: Path) -> cv2.VideoCapture:
    capture = cv2.VideoCapture(str(path.absolute()), cv2.CAP_FFMPEG)
    if not capture.isOpened():
        raise VideoError("no video that can be decoded")
    # A calibration speaks of pixels as stored, not as a player would turn them.
    capture.set(cv2.CAP_PROP_ORIENTATION_AUTO, 0)
    return capture


class VideoReader:
    """`nearest.Reader` of a file."""

    def __init__(self, capture: cv2.VideoCapture, interval: float, stop: Event | None = None) -> None:
        self.capture = capture
        self.interval = interval
        self.stop = stop or Event()
        self.time = -math.inf

    def grab(self) -> float | None:
        if self.stop.is_set():
            raise Stopped
        if not self.capture.grab():
            return None
        told = self.capture.get(cv2.CAP_PROP_POS_MSEC) / 1000
        # Some streams carry no times and tell 0 for ever, some repeat one.
        self.time = told if told > self.time else self.time + self.interval
        return self.time

    def pixels(self) -> Pixels:
        ok, pixels = self.capture.retrieve()
        if not ok:
            raise VideoError(f"the picture at {self.time:.3f} s cannot be decoded")
        return np.asarray(pixels, dtype=np.uint8)


def _clock(reader: VideoReader, count: float) -> tuple[float, float]:
    """Interval and duration, seconds; `reader` stands at its first picture."""
    interval, start = reader.interval, reader.time
    steady = True
    number = 1
    while (number < CHECKED_PICTURES or not steady) and (time := reader.grab()) is not None:
        # Containers round times to milliseconds.
        steady &= abs(time - start - number * interval) <= interval / 2 + 0.001
        number += 1
    if steady:
        return interval, start + max(count, number) * interval
    # Where the rate is no rate, the number of pictures says nothing about the length: that was all of them.
    interval = (reader.time - start) / (number - 1)
    return interval, reader.time + interval
