"""What an import of videos is told."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

from gtm_hit.ops.datasets.options import ImportOptions
from gtm_hit.ops.errors import OperationError

MOST_DRIFT = 10_000.0  # parts per million; no clock is a hundredth wrong
_SOURCE = re.compile(r"\s*(?P<camera>[^=\s]+)\s*=\s*(?P<path>.+?)\s*(?:@\s*(?P<offset>[^@/]*?)\s*)?")

_TIME = re.compile(r"(?P<offset>.*?)\s*(?:(?P<drift>[+-]\s*[0-9.]+)\s*ppm)?")


class SourceError(OperationError, ValueError):
    """A text that names no video."""


@dataclass(frozen=True)
class VideoSource:
    """`offset`: seconds in this video at which the time all videos share is 0.

    `drift`: parts per million by which its clock is fast; after t shared seconds it is at
    offset + t · (1 + drift / 1,000,000).
    """

    camera: str
    path: Path
    offset: float = 0.0
    drift: float = 0.0

    @property
    def pace(self) -> float:
        """Seconds of this video in a second of the shared time."""
        return 1 + self.drift / 1e6

    def time(self, shared: float) -> float:
        """The second in this video at a shared time."""
        return shared * self.pace + self.offset


@dataclass(frozen=True)
class VideoOptions:
    """`dataset` as for a folder; its frame rate and step say which instants become frames.

    `start` and `until` are seconds of the time all videos share; frame n lies at n / frame rate there.
    """

    dataset: ImportOptions
    sources: tuple[VideoSource, ...]
    start: float = 0.0
    until: float = math.inf


def parse_source(text: str) -> VideoSource:
    """`C1=video.mp4@0.12`: camera, file, and offset in seconds, 0 when it is left out.

    `C1=video.mp4@0.12+35ppm` is one whose clock is fast by 35 millionths.
    """
    match = _SOURCE.fullmatch(text)
    if match is None:
        raise SourceError(f"{text!r} does not read CAMERA=FILE@SECONDS")
    time = _TIME.fullmatch(match["offset"] or "")
    assert time is not None  # it takes whatever comes
    offset = _number(text, time["offset"], "number of seconds")
    drift = _number(text, (time["drift"] or "").replace(" ", ""), "number of millionths")
    if not math.isfinite(offset):
        raise SourceError(f"{text!r}: the offset must be finite")
    if abs(drift) > MOST_DRIFT:
        raise SourceError(f"{text!r}: a drift of {drift:.0f} ppm is no clock's")
    return VideoSource(match["camera"], Path(match["path"]), offset, drift)


def parse_sources(text: str, folder: Path) -> list[VideoSource]:
    """One video a line, files seen from `folder`; empty lines and those that begin with # are none.

    Raises SourceError with every line that names none.
    """
    found, reasons = [], []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            source = parse_source(line)
        except SourceError as error:
            reasons.append(f"line {number}: {error}")
        else:
            found.append(replace(source, path=folder / source.path))
    if reasons or not found:
        raise SourceError("; ".join(reasons) or "no video is named")
    return found


def _number(text: str, written: str, kind: str) -> float:
    try:
        return float(written or 0)
    except ValueError:
        raise SourceError(f"{text!r}: {written!r} is no {kind}") from None
