"""What does not fit the dataset: nothing is imported until it is dealt with, or dropped by name."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TypeVar

import numpy as np

from gtm_hit.formats.problems import Problem, ProblemList
from gtm_hit.geometry.grid import Grid
from gtm_hit.ops.layers.tables import NOBODY, Boxes, Ids, People, Sources


class Kind(StrEnum):
    OUTSIDE = "outside"
    UNKNOWN_FRAMES = "unknown-frames"
    UNKNOWN_CAMERAS = "unknown-cameras"
    DUPLICATES = "duplicates"


@dataclass
class Findings:
    """Problems by kind; those of the kinds in `drop` are counted, they cost only the rows they are about.

    `standing` is what nobody agreed to drop.
    """

    drop: frozenset[Kind]
    standing: ProblemList = field(default_factory=lambda: ProblemList(""))
    counts: Counter[Kind] = field(default_factory=Counter)

    def add(self, kind: Kind, problem: Problem) -> None:
        """Raises FormatError when there is more wrong than is worth listing."""
        if kind in self.drop:
            self.counts[kind] += 1
        else:
            self.standing.extend([problem])

    @property
    def dropped(self) -> dict[Kind, int]:
        return dict(self.counts)


Table = TypeVar("Table", People, Boxes)


def of_known_frames(table: Table, numbers: Collection[int], findings: Findings) -> Table:
    known = np.isin(table.frames, np.fromiter(numbers, np.int64, len(numbers)))
    for row in np.flatnonzero(~known).tolist():
        reason = f"frame {abs(int(table.frames[row]))} is not in the dataset"
        findings.add(Kind.UNKNOWN_FRAMES, table.sources.problem(row, reason))
    return replace(table.take(known), empty=[number for number in table.empty if number in numbers])


def of_known_cameras(boxes: Boxes, findings: Findings) -> Boxes:
    known = boxes.cameras != NOBODY
    for row in np.flatnonzero(~known).tolist():
        reason = "the box is in a camera the dataset does not have"
        findings.add(Kind.UNKNOWN_CAMERAS, boxes.sources.problem(row, reason))
    return boxes.take(known)


def on_the_grid(people: People, grid: Grid, findings: Findings) -> People:
    inside = (people.positions >= 0) & (people.positions < grid.count)
    for row in np.flatnonzero(~inside).tolist():
        reason = f"person {people.persons[row]} in frame {people.frames[row]} stands outside the grid"
        findings.add(Kind.OUTSIDE, people.sources.problem(row, reason))
    return people.take(inside)


def each_person_once(people: People, findings: Findings) -> People:
    """Of people twice in a frame the first stays."""
    first = _first([people.frames, people.persons])
    for row, earlier in _repetitions(first):
        reason = f"person {people.persons[row]} is already in frame {people.frames[row]}"
        findings.add(Kind.DUPLICATES, people.sources.problem(row, reason + _at(people.sources, earlier)))
    return people.take(first == np.arange(len(people)))


def each_box_once(boxes: Boxes, findings: Findings) -> Boxes:
    """Of people twice in a view of a frame the first box stays; boxes of nobody cannot repeat each other."""
    rows = np.arange(len(boxes))
    persons = np.where(boxes.persons == NOBODY, -2 - rows, boxes.persons)
    first = _first([boxes.frames, boxes.cameras, persons])
    for row, earlier in _repetitions(first):
        reason = f"person {boxes.persons[row]} is already in this view of frame {boxes.frames[row]}"
        findings.add(Kind.DUPLICATES, boxes.sources.problem(row, reason + _at(boxes.sources, earlier)))
    return boxes.take(first == rows)


def _first(keys: list[Ids]) -> Ids:
    """The row, (N,), in which each row's keys stand first."""
    if not len(keys[0]):
        return np.zeros(0, dtype=np.int64)
    order = np.lexsort(keys)  # keeps the order of equal rows: the first of a group is the first of all
    begins = np.ones(len(order), dtype=bool)
    begins[1:] = np.any([key[order[1:]] != key[order[:-1]] for key in keys], axis=0)
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[begins][np.cumsum(begins) - 1]
    return first


def _repetitions(first: Ids) -> list[tuple[int, int]]:
    rows = np.flatnonzero(first != np.arange(len(first)))
    return list(zip(rows.tolist(), first[rows].tolist(), strict=True))


def _at(sources: Sources, row: int) -> str:
    return f", {sources.place_words.format(sources.places[row])} of {sources.paths[sources.files[row]].name}"
