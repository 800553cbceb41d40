"""What is printed of a board: black shapes on white, metres from its first point, y downwards.

`shapes` is for paper, `ink` for rendering; both say the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.boards import Board, BoardKind, charuco, dictionary_of, object_points

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

DOT = 0.3  # radius of a circle, share of the least distance of two
MARGIN = 1.0  # white around the outermost squares or circles, in spacings


@dataclass(frozen=True)
class Square:
    """Black (or white, on top of black)."""

    x: float
    y: float
    side: float
    black: bool = True


@dataclass(frozen=True)
class Dot:
    x: float
    y: float
    radius: float


@dataclass(frozen=True)
class Extent:
    """The printed part with its margin."""

    left: float
    top: float
    right: float
    bottom: float


def extent(board: Board, margin: float = MARGIN) -> Extent:
    """What has to be flat and in view, with a margin in spacings."""
    around = margin * board.spacing
    if board.has_circles:
        points, radius = object_points(board), dot_radius(board)
        (left, top), (right, bottom) = points[:, :2].min(0) - radius, points[:, :2].max(0) + radius
        return Extent(left - around / 2, top - around / 2, right + around / 2, bottom + around / 2)
    first = 0 if board.kind is BoardKind.CHARUCO else -1
    side = board.spacing
    columns, rows = board.size
    return Extent(
        first * side - around,
        first * side - around,
        (first + columns + 1) * side + around,
        (first + rows + 1) * side + around,
    )


def dot_radius(board: Board) -> float:
    nearest = board.spacing * (np.sqrt(0.5) if board.kind is BoardKind.ACIRCLES else 1.0)
    return float(DOT * nearest)


def shapes(board: Board) -> list[Square | Dot]:
    """Everything black, and what is white on top of it, in the order of painting."""
    if board.has_circles:
        return [Dot(float(x), float(y), dot_radius(board)) for x, y, _ in object_points(board)]
    side = board.spacing
    if board.kind is BoardKind.CHESSBOARD:
        return [
            Square(column * side, row * side, side)
            for row in range(-1, board.rows)
            for column in range(-1, board.columns)
            if (row + column) % 2 == 0
        ]
    whites = _marker_squares(board)
    painted: list[Square | Dot] = [
        Square(column * side, row * side, side)
        for row in range(board.rows)
        for column in range(board.columns)
        if (row, column) not in whites
    ]
    for (row, column), bits in whites.items():
        painted += _marker(column * side, row * side, board, bits)
    return painted


def ink(board: Board, x: Floats, y: Floats) -> Bools:
    """Whether it is black at points of the board's plane, metres; the margin and beyond are not."""
    if board.has_circles:
        return _dots(board, x, y)
    column, row = np.floor(x / board.spacing), np.floor(y / board.spacing)
    if board.kind is BoardKind.CHESSBOARD:
        inside = (column >= -1) & (column < board.columns) & (row >= -1) & (row < board.rows)
        return inside & ((column + row) % 2 == 0)
    inside = (column >= 0) & (column < board.columns) & (row >= 0) & (row < board.rows)
    at = (np.where(inside, row, 0).astype(int), np.where(inside, column, 0).astype(int))
    return inside & _charuco_ink(board, x - column * board.spacing, y - row * board.spacing, at)


def _dots(board: Board, x: Floats, y: Floats) -> Bools:
    side, radius = board.spacing, dot_radius(board)
    half = side / 2 if board.kind is BoardKind.ACIRCLES else side
    row = np.clip(np.round(y / half), 0, board.rows - 1)
    shift = (row % 2) * side / 2 if board.kind is BoardKind.ACIRCLES else 0.0
    column = np.clip(np.round((x - shift) / side), 0, board.columns - 1)
    # Dots of a row do not reach those of the next one: the nearest row and column are the only candidates.
    near: Bools = np.hypot(x - shift - column * side, y - row * half) <= radius
    return near


def _charuco_ink(board: Board, x: Floats, y: Floats, at: tuple[NDArray, NDArray]) -> Bools:
    bits, has_marker = _bit_table(board)
    cells = bits.shape[2]
    rim = board.spacing * (1 - board.marker) / 2
    cell = board.spacing * board.marker / cells
    i, j = np.floor((y - rim) / cell).astype(int), np.floor((x - rim) / cell).astype(int)
    within = (i >= 0) & (i < cells) & (j >= 0) & (j < cells)
    black = bits[(*at, np.where(within, i, 0), np.where(within, j, 0))]
    result: Bools = np.where(has_marker[at], within & black, True)
    return result


@lru_cache(maxsize=8)
def _bit_table(board: Board) -> tuple[Bools, Bools]:
    """Which cells of which square's marker are black, (rows, columns, cells, cells); which have one."""
    markers = _marker_squares(board)
    cells = next(iter(markers.values())).shape[0]
    bits = np.zeros((board.rows, board.columns, cells, cells), dtype=np.bool_)
    there = np.zeros((board.rows, board.columns), dtype=np.bool_)
    for square, black in markers.items():
        bits[square], there[square] = black, True
    return bits, there


def _marker_squares(board: Board) -> dict[tuple[int, int], Bools]:
    """(row, column) of the squares with markers, and which of a marker's cells are black."""
    made, dictionary = charuco(board), dictionary_of(board.dictionary)
    cells = dictionary.markerSize + 2
    markers = {}
    for number, corners in zip(np.ravel(made.getIds()), made.getObjPoints(), strict=True):
        centre = np.asarray(corners).reshape(-1, 3).mean(axis=0)
        column, row = (int(np.floor(value / board.spacing)) for value in centre[:2])
        image = cv2.aruco.generateImageMarker(dictionary, int(number), cells)
        markers[row, column] = np.asarray(image) == 0
    return markers


def _marker(left: float, top: float, board: Board, bits: Bools) -> list[Square | Dot]:
    """A black square with white cells."""
    side = board.spacing * board.marker
    left, top = left + (board.spacing - side) / 2, top + (board.spacing - side) / 2
    cell = side / bits.shape[0]
    whites = [Square(left + j * cell, top + i * cell, cell, black=False) for i, j in np.argwhere(~bits)]
    return [Square(left, top, side), *whites]
