"""What a release changed since the one before, person by person."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

from gtm_hit.ops.releases.provenance import Line, read_lines

CHANGES = "changes.json"
People = dict[int, Line]


def write_changes(stream: BinaryIO, since: int | None, before: Path | None, now: Path) -> dict[str, int]:
    """Write `changes.json` and return its counts; `before` and `now` are the provenance of two releases.

    Frames are written as they are compared: memory does not grow with the releases.
    """
    counts: Counter[str] = Counter(frames=0, added=0, removed=0, moved=0)
    stream.write(b'{"since": ' + json.dumps(since).encode() + b',\n"frames": [')
    for frame, old, new in _side_by_side(before, now) if before else ():
        change = _change(frame, old, new)
        kinds = {kind: len(change[kind]) for kind in ("added", "removed", "moved")}
        if any(kinds.values()):
            stream.write((",\n" if counts["frames"] else "\n").encode() + json.dumps(change).encode())
            counts.update(kinds, frames=1)
    stream.write(b'],\n"counts": ' + json.dumps(counts).encode() + b"}\n")
    return dict(counts)


def _change(frame: int, old: People, new: People) -> dict[str, Any]:
    both = sorted(old.keys() & new.keys())
    return {
        "frame": frame,
        "added": [_told(new[person]) for person in sorted(new.keys() - old.keys())],
        "removed": [_told(old[person]) for person in sorted(old.keys() - new.keys())],
        "moved": [
            {
                "person": person,
                "from": [old[person].x, old[person].y],
                "to": [new[person].x, new[person].y],
                "metres": round(math.dist(_xy(old[person]), _xy(new[person])), 6),
            }
            for person in both
            if _xy(old[person]) != _xy(new[person])
        ],
    }


def _told(line: Line) -> dict[str, Any]:
    return {"person": line.person, "x": line.x, "y": line.y}


def _xy(line: Line) -> tuple[float, float]:
    return line.x, line.y


def _side_by_side(before: Path, now: Path) -> Iterator[tuple[int, People, People]]:
    """All frames either release has people in, in order."""
    old, new = read_lines(before), read_lines(now)
    end: tuple[float, People] = (math.inf, {})
    left, right = next(old, end), next(new, end)
    while (frame := min(left[0], right[0])) != math.inf:
        here = left[1] if left[0] == frame else {}
        there = right[1] if right[0] == frame else {}
        yield int(frame), here, there
        if left[0] == frame:
            left = next(old, end)
        if right[0] == frame:
            right = next(new, end)
