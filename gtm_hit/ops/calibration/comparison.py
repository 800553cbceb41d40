"""How far boxes move between two calibrations; counted a block of annotations at a time.

Boxes are computed for the positions people stand on: a comparison writes no rectangle table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid

MOST_WORST = 20

Boxes = NDArray[np.int16]
Visible = NDArray[np.bool_]


@dataclass(frozen=True)
class Person:
    """An annotation as it is compared; `size` is its cylinder."""

    layer: str
    frame: int
    person: int
    position: int
    size: Cylinder


@dataclass(frozen=True)
class Calibration:
    """Cameras, and what rectangles need beside them."""

    cameras: Sequence[Camera]
    grid: Grid
    rule: FootRule

    def boxes(self, people: Sequence[Person]) -> tuple[Boxes, Visible]:
        """(N, cameras, 4) pixels and (N, cameras)."""
        boxes = np.zeros((len(people), len(self.cameras), 4), dtype=np.int16)
        visible = np.zeros(boxes.shape[:2], dtype=np.bool_)
        for size in {person.size for person in people}:
            rows = np.array([row for row, person in enumerate(people) if person.size == size])
            # Many frames have people on the same positions.
            positions, back = np.unique([people[row].position for row in rows], return_inverse=True)
            for index, camera in enumerate(self.cameras):
                found, seen = rectangles(camera, self.grid, size, self.rule, positions)
                boxes[rows, index], visible[rows, index] = found[back], seen[back]
        return boxes, visible


@dataclass(frozen=True)
class Moved:
    """One box that moved; `shift` is the largest distance one of its edges went, pixels."""

    shift: int
    person: Person
    camera: int
    before: list[int]
    after: list[int]


@dataclass
class Comparison:
    """Add blocks of people, then ask."""

    before: Calibration
    after: Calibration
    people: int = 0
    worst: list[Moved] = field(default_factory=list)

    def __post_init__(self) -> None:
        cameras = len(self.before.cameras)
        self._shifts: list[list[NDArray[np.int32]]] = [[] for _ in range(cameras)]
        self._appeared = np.zeros(cameras, dtype=int)
        self._vanished = np.zeros(cameras, dtype=int)

    def add(self, people: Sequence[Person]) -> None:
        if not people:
            return
        old, seen_before = self.before.boxes(people)
        new, seen_after = self.after.boxes(people)
        both = seen_before & seen_after
        shifts = np.abs(new.astype(np.int32) - old).max(axis=2)
        self.people += len(people)
        self._appeared += (seen_after & ~seen_before).sum(axis=0)
        self._vanished += (seen_before & ~seen_after).sum(axis=0)
        for index, each in enumerate(self._shifts):
            each.append(shifts[both[:, index], index])
        self._add_worst(people, np.where(both, shifts, 0), old, new)

    def cameras(self) -> list[dict[str, Any]]:
        """Per camera: boxes visible before and after, how many of them moved and how far, pixels."""
        return [self._camera(index, camera.name) for index, camera in enumerate(self.before.cameras)]

    def _camera(self, index: int, name: str) -> dict[str, Any]:
        shifts = np.concatenate([*self._shifts[index], np.zeros(0, np.int32)])
        middle, most, largest = np.percentile(shifts, [50, 95, 100]).tolist() if len(shifts) else (0, 0, 0)
        return {
            "name": name,
            "compared": len(shifts),
            "moved": int((shifts > 0).sum()),
            "median": middle,
            "p95": most,
            "max": largest,
            "appeared": int(self._appeared[index]),
            "vanished": int(self._vanished[index]),
        }

    def _add_worst(self, people: Sequence[Person], shifts: NDArray[np.int32], old: Boxes, new: Boxes) -> None:
        flat = shifts.ravel()
        for place in np.argsort(-flat, kind="stable")[:MOST_WORST]:
            row, camera = divmod(int(place), shifts.shape[1])
            if not flat[place]:
                break
            self.worst.append(
                Moved(
                    int(flat[place]),
                    people[row],
                    camera,
                    old[row, camera].tolist(),
                    new[row, camera].tolist(),
                )
            )
        self.worst = sorted(self.worst, key=lambda moved: -moved.shift)[:MOST_WORST]
