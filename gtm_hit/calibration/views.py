"""A picture, and what was found of a board in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Grey = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Picture:
    """Pixels as they are stored in the file, whatever it says about turning them."""

    name: str
    grey: Grey  # (height, width)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        return self.grey.shape[1], self.grey.shape[0]


@dataclass(frozen=True, eq=False)
class BoardView:
    """One sight of a board: N of its points."""

    name: str
    pixels: Floats  # (N, 2)
    points: Floats  # (N, 3) metres on the board
    ids: NDArray[np.int64]  # (N,) which points of the board, see `object_points`


@dataclass(frozen=True)
class NotFound:
    """Why a picture shows no board that can be used."""

    name: str
    reason: str  # a sentence
    other: tuple[int, int] | None = None  # columns × rows that would fit instead
