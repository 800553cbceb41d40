"""What was read from annotation files, before anything is decided."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gtm_hit.formats.problems import Problem

Ids = NDArray[np.int64]
Floats = NDArray[np.float64]

NOBODY = -1  # a person nobody named, a position there is none of


@dataclass(frozen=True, eq=False)
class Sources:
    """Where rows stood: the file by its index, the place in it as a number, and how that reads."""

    paths: list[Path]
    files: Ids  # (N,)
    places: Ids  # (N,)
    place_words: str  # "line {}"

    def problem(self, row: int, reason: str) -> Problem:
        place = self.place_words.format(self.places[row])
        return Problem(str(self.paths[self.files[row]]), place, reason)

    def take(self, rows: NDArray) -> Sources:
        return replace(self, files=self.files[rows], places=self.places[rows])


@dataclass(frozen=True, eq=False)
class People:
    """One row per person and frame."""

    frames: Ids  # (N,) frame numbers
    persons: Ids  # (N,)
    positions: Ids  # (N,) NOBODY off the grid
    heights: Floats  # (N,) metres, NaN for the dataset's cylinder
    radii: Floats  # (N,) likewise
    sources: Sources
    empty: list[int] = field(default_factory=list)  # frames said to have nobody

    def __len__(self) -> int:
        return len(self.frames)

    def take(self, rows: NDArray) -> People:
        return replace(self, **_taken(self, rows))


@dataclass(frozen=True, eq=False)
class Boxes:
    """One row per box in a view."""

    frames: Ids  # (N,) frame numbers
    cameras: Ids  # (N,) indices; NOBODY for a camera the dataset does not have
    persons: Ids  # (N,) NOBODY where the file names none
    positions: Ids  # (N,) what the file says beside the box, NOBODY where it says nothing
    boxes: Floats  # (N, 4) pixels
    sources: Sources
    empty: list[int] = field(default_factory=list)  # frames whose images show nobody

    def __len__(self) -> int:
        return len(self.frames)

    def take(self, rows: NDArray) -> Boxes:
        return replace(self, **_taken(self, rows))


def people(frames: Ids, persons: Ids | None, positions: Ids, sources: Sources) -> People:
    """Of the usual size; where nobody has an identity, everybody gets one of their own."""
    unknown = np.full(len(frames), np.nan)
    if persons is None:
        persons = np.arange(len(frames))
    return People(frames, persons, positions, unknown, unknown, sources)


def _taken(table: People | Boxes, rows: NDArray) -> dict[str, Any]:
    """Every column of the table at these rows; the same arrays where these are all rows."""
    if rows.dtype == bool and rows.all():
        return {}
    columns = {each.name: getattr(table, each.name) for each in fields(table)}
    return {name: column[rows] for name, column in columns.items() if isinstance(column, np.ndarray)} | {
        "sources": table.sources.take(rows)
    }
