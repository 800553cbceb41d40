"""An assignment beside a reference: who is matched, moved, swapped, missed or extra, worst first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gtm_hit.models import Assignment, Layer
from gtm_hit.ops.quality.comparing import Comparison, Kind, Scope, compare, mark_part, marks

RADIUS = 1.0  # metres: whoever is half a metre off is moved, and not somebody else
MOVED = 0.15  # metres from which on a person is called moved
MOVED_KIND = "moved"
WORTH = {Kind.MISSED.value: 2.0, Kind.EXTRA.value: 2.0, Kind.SWAPPED.value: 3.0}


@dataclass(frozen=True)
class FrameMarks:
    """One frame of the batch; `compared`: the reference has it, too."""

    number: int
    compared: bool
    marks: list[dict[str, Any]]  # as the comparison sends them, with one more kind

    def count(self, kind: str) -> int:
        return sum(mark["kind"] == kind for mark in self.marks)

    @property
    def differences(self) -> int:
        return sum(mark["kind"] != Kind.MATCHED for mark in self.marks)


@dataclass(frozen=True)
class Differences:
    frames: list[FrameMarks]  # in time
    worst_first: list[tuple[int, int]]  # frame number, place among the frame's marks

    def as_numbers(self) -> dict[str, Any]:
        kinds = [*(kind.value for kind in Kind), MOVED_KIND]
        return {
            "frames": [
                {
                    "frame": frame.number,
                    "compared": frame.compared,
                    "differences": frame.differences,
                    **{kind: frame.count(kind) for kind in kinds},
                    "marks": frame.marks,
                }
                for frame in self.frames
            ],
            "worst_first": self.worst_first,
        }


def differences(assignment: Assignment, reference: Layer | None) -> Differences:
    """Without a reference, and in frames it does not have, everybody is as the worker put them."""
    own = compare(assignment.layer, assignment.layer, RADIUS)
    other = compare(reference, assignment.layer, RADIUS, Scope.BOTH) if reference else None
    shared = set(other.numbers.tolist()) if other else set()
    frames = []
    for number in own.numbers.tolist():
        comparison = other if other is not None and number in shared else own
        found = frame_marks(comparison, number)
        if number not in shared:
            found = [{**mark, "distance": None} for mark in found]
        frames.append(FrameMarks(number, number in shared, found))
    return Differences(frames, worst_first(frames))


def frame_marks(comparison: Comparison, number: int) -> list[dict[str, Any]]:
    found = [moved_told(mark_part(comparison, mark)) for mark in marks(comparison, number)]
    return sorted(found, key=lambda mark: -worth(mark))


def moved_told(mark: dict[str, Any]) -> dict[str, Any]:
    far = mark["kind"] == Kind.MATCHED and mark["distance"] >= MOVED
    return {**mark, "kind": MOVED_KIND if far else mark["kind"]}


def worth(mark: dict[str, Any]) -> float:
    """How bad a difference is; whoever is moved counts by the distance, up to as much as a missed one."""
    if mark["kind"] == MOVED_KIND:
        return 1.0 + float(mark["distance"]) / RADIUS
    return WORTH.get(mark["kind"], 0.0)


def worst_first(frames: list[FrameMarks]) -> list[tuple[int, int]]:
    found = [
        (-worth(mark), frame.number, place)
        for frame in frames
        for place, mark in enumerate(frame.marks)
        if worth(mark) > 0
    ]
    return [(number, place) for _worth, number, place in sorted(found)]
