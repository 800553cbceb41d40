"""What a draft says: every video's clock, and events that were seen in several."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Collection
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from gtm_hit.ops.datasets.videos.options import MOST_DRIFT
from gtm_hit.ops.sync.guessing import SyncRefused

MOST_SECONDS = 1_000_000.0
MOST_EVENTS = 200
_SEPARATORS = re.compile(r"[\s=]+")
_NAME = re.compile(r"[^=\s]+")


@dataclass(frozen=True)
class Clock:
    """`offset`: the second in the video at which the shared time is 0; `drift`: millionths it gains."""

    file: str
    camera: str
    offset: float = 0.0
    drift: float = 0.0
    used: bool = True


@dataclass(frozen=True)
class Event:
    """`marks`: by file the second in the video at which it happens."""

    name: str
    marks: dict[str, float]


@dataclass(frozen=True)
class State:
    """`reference`: file of the video that the others are laid beside; empty: the first one used."""

    clocks: tuple[Clock, ...]
    events: tuple[Event, ...] = ()
    reference: str = ""

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


def camera_name(file: str) -> str:
    """A camera's name out of its file's, without what separates the parts of a line."""
    return _SEPARATORS.sub("-", Path(file).stem)


def state_of(content: dict[str, Any]) -> State:
    """Of what `as_json` made."""
    return State(
        tuple(Clock(**each) for each in content["clocks"]),
        tuple(Event(**each) for each in content["events"]),
        content.get("reference", ""),
    )


def check(state: State, files: Collection[str]) -> None:
    """Raises SyncRefused with the first thing that cannot be."""
    if Counter(clock.file for clock in state.clocks) != Counter(files):
        raise SyncRefused("These are not the videos of this folder.")
    if state.reference and state.reference not in files:
        raise SyncRefused(f"{state.reference} is no video of this folder.")
    _check_clocks(state.clocks)
    _check_events(state.events, files)


def _check_clocks(clocks: tuple[Clock, ...]) -> None:
    for clock in clocks:
        if not _NAME.fullmatch(clock.camera):
            raise SyncRefused(
                f"{clock.file}: a camera's name has neither spaces nor = in it, and is not empty."
            )
        if not abs(clock.offset) <= MOST_SECONDS:
            raise SyncRefused(f"{clock.file}: no video has an offset of {clock.offset} s.")
        if not abs(clock.drift) <= MOST_DRIFT:
            raise SyncRefused(
                f"{clock.file}: a drift of {clock.drift:.0f} ppm is no clock's; the anchors do not fit."
            )
    used = [clock.camera for clock in clocks if clock.used]
    if twice := [name for name, times in Counter(used).items() if times > 1]:
        raise SyncRefused(f"Two videos have the name {twice[0]}.")


def _check_events(events: tuple[Event, ...], files: Collection[str]) -> None:
    if len(events) > MOST_EVENTS:
        raise SyncRefused(f"There are more than {MOST_EVENTS} events.")
    for event in events:
        if not set(event.marks) <= set(files):
            raise SyncRefused(f"Event {event.name} is marked in a video that is not here.")
        if not all(math.isfinite(at) and abs(at) <= MOST_SECONDS for at in event.marks.values()):
            raise SyncRefused(f"Event {event.name} has a mark at no time.")


def source_lines(state: State) -> list[str]:
    """As the import of videos reads them: `CAMERA = FILE @ SECONDS`."""
    return [_line(clock) for clock in state.clocks if clock.used]


def _line(clock: Clock) -> str:
    drift = f"{clock.drift:+.2f}ppm" if clock.drift else ""
    return f"{clock.camera} = {clock.file} @ {clock.offset:.4f}{drift}"
