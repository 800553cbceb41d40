"""Marks: small pieces of a camera's picture that stay where they are, and can be found again."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

Grey = NDArray[np.uint8]

SIDE = 33  # pixels of a mark's piece
HALF = SIDE // 2
MOST = 96
CELLS = (8, 6)  # of the picture, across and down, so that marks are spread over all of it
PER_CELL = 2
CONTRAST = 6.0  # grey values: what varies less cannot be told from noise
CORNER = 1.5e-4  # least eigenvalue of the gradients, grey values of 0 … 1: an edge alone slides along itself
RESTLESS = 6.0  # grey values; a piece whose pixels change by more between pictures is somebody passing


class DriftError(ValueError):
    """Pictures that cannot be compared; says why."""


@dataclass(frozen=True, eq=False)
class Mark:
    """`x`, `y`: the middle pixel of the piece."""

    x: int
    y: int
    piece: Grey  # (SIDE, SIDE)


@dataclass(frozen=True, eq=False)
class Marks:
    """Of one camera. `pictures`: how many they were chosen from; of one alone, people may be among them."""

    width: int
    height: int
    pictures: int
    marks: tuple[Mark, ...]

    def as_json(self) -> dict[str, Any]:
        kept = [{"x": mark.x, "y": mark.y, "piece": _packed(mark.piece)} for mark in self.marks]
        return {"width": self.width, "height": self.height, "pictures": self.pictures, "marks": kept}


def marks_of(content: dict[str, Any]) -> Marks:
    """Reads what `as_json` wrote."""
    kept = tuple(Mark(each["x"], each["y"], _unpacked(each["piece"])) for each in content["marks"])
    return Marks(content["width"], content["height"], content["pictures"], kept)


def choose(pictures: Sequence[Grey]) -> Marks:
    """Marks of a camera that stood still for these grey pictures. Raises DriftError.

    Who walks through is gone in the median of several pictures, and no piece that changed is taken.
    """
    if not pictures:
        raise DriftError("no picture to take marks from")
    height, width = pictures[0].shape[:2]
    for picture in pictures:
        check_size(picture, width, height)
    still, restless = _still(pictures)
    corners = cv2.cornerMinEigenVal(cv2.GaussianBlur(still, (0, 0), 1.0), 7, ksize=3)
    corners[_spread(still) < CONTRAST] = 0
    corners[restless > RESTLESS] = 0
    rim = HALF + 2
    inside = np.zeros(corners.shape, np.float32)
    inside[rim:-rim, rim:-rim] = corners[rim:-rim, rim:-rim]
    places = _best_of_cells(inside)
    marks = tuple(
        Mark(x, y, still[y - HALF : y + HALF + 1, x - HALF : x + HALF + 1].copy()) for x, y in places
    )
    return Marks(width, height, len(pictures), marks)


def check_size(picture: Grey, width: int, height: int) -> None:
    there = (picture.shape[1], picture.shape[0])
    if there != (width, height):
        raise DriftError(f"a picture has {there[0]}×{there[1]} pixels, the others {width}×{height}")


def _still(pictures: Sequence[Grey]) -> tuple[Grey, NDArray[np.float32]]:
    """The median picture, and around each pixel by how much its surroundings change."""
    if len(pictures) == 1:
        return pictures[0], np.zeros(pictures[0].shape, np.float32)
    stack = np.stack(pictures)
    median = np.median(stack, axis=0).astype(np.uint8)
    changes = np.zeros(median.shape, np.float32)
    for picture in pictures:  # the light may change for all: that is nobody passing
        light = float(np.median(picture.astype(np.int16) - median))
        changes = np.maximum(changes, np.abs(picture.astype(np.float32) - median - light))
    lone = cv2.medianBlur(np.minimum(changes, 255).astype(np.uint8), 5)  # without the grain of the sensor
    return median, np.asarray(cv2.blur(lone.astype(np.float32), (SIDE, SIDE)), np.float32)


def _spread(still: Grey) -> NDArray[np.float32]:
    values = still.astype(np.float32)
    mean = cv2.blur(values, (SIDE, SIDE))
    square = cv2.blur(values * values, (SIDE, SIDE))
    spread: NDArray[np.float32] = np.sqrt(np.maximum(square - mean * mean, 0))
    return spread


def _best_of_cells(corners: NDArray[np.float32]) -> list[tuple[int, int]]:
    height, width = corners.shape
    across, down = CELLS
    found = []
    for row in range(down):
        for column in range(across):
            top, bottom = height * row // down, height * (row + 1) // down
            left, right = width * column // across, width * (column + 1) // across
            found += [(left + x, top + y) for x, y in _peaks(corners[top:bottom, left:right].copy())]
    return found[:MOST]


def _peaks(cell: NDArray[np.float32]) -> list[tuple[int, int]]:
    found: list[tuple[int, int]] = []
    while len(found) < PER_CELL:
        _, best, _, (x, y) = cv2.minMaxLoc(cell)
        if best < CORNER:
            break
        found.append((x, y))
        cell[max(y - SIDE, 0) : y + SIDE, max(x - SIDE, 0) : x + SIDE] = 0
    return found


def _packed(piece: Grey) -> str:
    return base64.b64encode(cv2.imencode(".png", piece)[1].tobytes()).decode("ascii")


def _unpacked(text: str) -> Grey:
    data = np.frombuffer(base64.b64decode(text), np.uint8)
    piece: Grey = np.asarray(cv2.imdecode(data, cv2.IMREAD_GRAYSCALE), dtype=np.uint8)
    return piece
