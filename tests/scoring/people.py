"""A square of people who walk, as positions by person, by frame number."""

from __future__ import annotations

import numpy as np

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.scoring.faults import Positions

GRID = Grid(400, 400, 0.025, -5.0, -5.0)


def walking(people: int = 8, frames: int = 10, first: int = 0) -> dict[int, Positions]:
    """People 1.2 m apart who walk along X with 0.8 m/s, a frame each half second; numbers from 3 on."""
    starts = np.array([[-4.0 + 0.3 * (one % 3), -4.0 + 1.2 * one % 8] for one in range(people)])
    return {
        first + 5 * index: {
            3 + one: int(GRID.nearest([starts[one] + (0.4 * index, 0.0)])[0]) for one in range(people)
        }
        for index in range(frames)
    }


def as_annotations(frames: dict[int, Positions]) -> Annotations:
    rows = [(number, person, place) for number, people in frames.items() for person, place in people.items()]
    if not rows:
        return Annotations(np.zeros(0, np.int64), np.zeros((0, 2)), np.zeros(0, np.int64))
    numbers, persons, places = (np.array(column, np.int64) for column in zip(*rows, strict=True))
    return Annotations(numbers, GRID.metres(places), persons)


def moved(place: int, x: float, y: float = 0.0) -> int:
    """The position that many metres away."""
    return int(GRID.nearest(GRID.metres([place]) + np.array([x, y]))[0])
