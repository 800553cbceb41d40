"""Which picture of a video is nearest to an instant, found while reading forwards once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol

from gtm_hit.ops.files.images import Pixels


class Reader(Protocol):
    """A video, read forwards. Times are seconds in the video and strictly increase."""

    @property
    def interval(self) -> float:
        """Usual seconds between two pictures."""
        ...

    def grab(self) -> float | None:
        """Go to the next picture without making pixels of it: its time, or None after the last."""
        ...

    def pixels(self) -> Pixels:
        """The picture grabbed last."""
        ...


@dataclass
class Taken:
    """The picture chosen for an instant; `time` is its own, in seconds of the video."""

    index: int
    time: float
    pixels: Pixels


@dataclass
class _Grabbed:
    index: int
    time: float
    pixels: Pixels | None = None


def nearest_pictures(
    reader: Reader, times: Iterable[float], read_again: Callable[[int], Pixels]
) -> Iterator[Taken]:
    """For each of the ascending `times` the picture nearest to it, the earlier of two as near.

    Ends with the first time that lies beyond the last picture. Holds at most two pictures. Only those close
    before an instant become pixels; one that turns out to be nearest after a gap longer than any before is
    fetched by `read_again`, which is given its index.
    """
    time = reader.grab()
    current = None if time is None else _Grabbed(0, time)
    previous: _Grabbed | None = None
    longest = reader.interval
    for wanted in times:
        while current is not None and current.time < wanted:
            # Twice the longest gap: whatever gap makes `read_again` necessary is then more than doubled by
            # the next one that does, so this happens a few times in a video and not at every gap.
            if current.pixels is None and wanted - current.time <= 2 * longest:
                current.pixels = reader.pixels()
            previous, time = current, reader.grab()
            current = None if time is None else _Grabbed(previous.index + 1, time)
            if current is not None:
                longest = max(longest, current.time - previous.time)
        if current is None and (previous is None or wanted - previous.time > reader.interval / 2 + 1e-6):
            return
        if current is None or (previous is not None and wanted - previous.time <= current.time - wanted):
            assert previous is not None
            chosen = previous
            if chosen.pixels is None:
                chosen.pixels = read_again(chosen.index)
        else:
            chosen = current
            if chosen.pixels is None:
                chosen.pixels = reader.pixels()
        yield Taken(chosen.index, chosen.time, chosen.pixels)
