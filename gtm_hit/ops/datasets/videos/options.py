"""What an import of videos is told."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

from gtm_hit.ops.datasets.options import ImportOptions
from gtm_hit.ops.errors import OperationError

_SOURCE = re.compile(r"\s*(?P<camera>[^=\s]+)\s*=\s*(?P<path>.+?)\s*(?:@\s*(?P<offset>[^@/]*?)\s*)?")


class SourceError(OperationError, ValueError):
    """A text that names no video."""


@dataclass(frozen=True)
class VideoSource:
    """`offset`: seconds in this video at which the time all videos share is 0."""

    camera: str
    path: Path
    offset: float = 0.0


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
    """`C1=video.mp4@0.12`: camera, file, and offset in seconds, 0 when it is left out."""
    match = _SOURCE.fullmatch(text)
    if match is None:
        raise SourceError(f"{text!r} does not read CAMERA=FILE@SECONDS")
    try:
        offset = float(match["offset"] or 0)
    except ValueError:
        raise SourceError(f"{text!r}: {match['offset']!r} is no number of seconds") from None
    if not math.isfinite(offset):
        raise SourceError(f"{text!r}: the offset must be finite")
    return VideoSource(match["camera"], Path(match["path"]), offset)
