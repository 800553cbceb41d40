"""The boards that are held into a camera's view: what was printed, and where its points are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.errors import GeometryError

Floats = NDArray[np.float64]

MOST = 60  # columns or rows: more is a typing error
LARGEST_SPACING = 2.0  # metres
FEWEST_CORNERS = 6  # of a ChArUco board in one picture
DEFAULT_DICTIONARY = "DICT_4X4_50"
DEFAULT_MARKER = 0.75


class BoardError(GeometryError):
    """A board nobody can print or look for; says why."""


class BoardKind(StrEnum):
    CHESSBOARD = "chessboard"  # columns × rows are inner corners
    CIRCLES = "circles"  # columns × rows are circles
    ACIRCLES = "acircles"  # every other row shifted by half a spacing; rows are half a spacing apart
    CHARUCO = "charuco"  # columns × rows are squares


DICTIONARIES = tuple(
    sorted({name.upper() for name in dir(cv2.aruco) if name.startswith("DICT_")}),
)


@dataclass(frozen=True)
class Board:
    """`spacing`: metres, the side of a square or the distance of two circles in a row."""

    kind: BoardKind
    columns: int
    rows: int
    spacing: float
    marker: float = DEFAULT_MARKER  # ChArUco: share of a square's side
    dictionary: str = DEFAULT_DICTIONARY  # ChArUco
    inverted: bool = False  # white printed on black
    legacy: bool = False  # ChArUco as OpenCV before 4.6 laid it out

    def __post_init__(self) -> None:
        if self.kind not in set(BoardKind):
            raise BoardError(f"{self.kind!r} is no board; there are {', '.join(BoardKind)}.")
        object.__setattr__(self, "kind", BoardKind(self.kind))
        self._check_size()
        self._check_spacing()
        if self.kind is BoardKind.CHARUCO:
            self._check_markers()

    def _check_size(self) -> None:
        fewest = 2 if self.kind in {BoardKind.CIRCLES, BoardKind.ACIRCLES} else 3
        for name, count in (("columns", self.columns), ("rows", self.rows)):
            if isinstance(count, bool) or not isinstance(count, int) or not fewest <= count <= MOST:
                raise BoardError(f"A {self.kind} board needs {fewest} to {MOST} {name}, not {count}.")
        if self.columns * self.rows < 6:
            raise BoardError(f"A board of {self.columns}×{self.rows} has too few points: 6 are the least.")

    def _check_spacing(self) -> None:
        if not (isinstance(self.spacing, int | float) and math.isfinite(self.spacing) and self.spacing > 0):
            raise BoardError(f"The spacing must be a length above 0 metres, not {self.spacing}.")
        if self.spacing > LARGEST_SPACING:
            unit = "millimetres" if self.spacing >= 10 else "centimetres"
            raise BoardError(
                f"A spacing of {self.spacing:g} m is larger than any board; it is given in metres. "
                f"If these are {unit}, say {self.spacing / (1000 if unit == 'millimetres' else 100):g}."
            )

    def _check_markers(self) -> None:
        if self.dictionary not in DICTIONARIES:
            raise BoardError(
                f"There is no dictionary {self.dictionary!r}; there are {', '.join(DICTIONARIES)}."
            )
        if not (isinstance(self.marker, int | float) and 0.2 <= self.marker < 1):
            raise BoardError(f"A marker takes 0.2 to below 1 of its square's side, not {self.marker}.")
        there = len(dictionary_of(self.dictionary).bytesList)
        wanted = self.columns * self.rows // 2
        if wanted > there:
            raise BoardError(
                f"A {self.columns}×{self.rows} board needs {wanted} markers; {self.dictionary} has {there}."
            )

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows of its points."""
        less = 1 if self.kind is BoardKind.CHARUCO else 0
        return self.columns - less, self.rows - less

    @property
    def has_circles(self) -> bool:
        return self.kind in {BoardKind.CIRCLES, BoardKind.ACIRCLES}

    @property
    def point_count(self) -> int:
        return math.prod(self.size)

    def as_json(self) -> dict[str, Any]:
        """Its numbers under the names of this class; `Board(**…)` makes it again."""
        plain = {"kind": self.kind.value, "columns": self.columns, "rows": self.rows, "spacing": self.spacing}
        plain |= {"inverted": self.inverted}
        if self.kind is BoardKind.CHARUCO:
            plain |= {"marker": self.marker, "dictionary": self.dictionary, "legacy": self.legacy}
        return plain


WHAT = {
    BoardKind.CHESSBOARD: ("Chessboard", "inner corners", "squares of"),
    BoardKind.CIRCLES: ("Circle grid", "circles", "spacing"),
    BoardKind.ACIRCLES: ("Asymmetric circle grid", "circles", "spacing"),
    BoardKind.CHARUCO: ("ChArUco board", "squares", "squares of"),
}


def describe(board: Board) -> str:
    """`Chessboard, 9×6 inner corners, squares of 30 mm`."""
    name, counted, spacing = WHAT[board.kind]
    words = [name, f"{board.columns}×{board.rows} {counted}", f"{spacing} {board.spacing * 1000:g} mm"]
    if board.kind is BoardKind.CHARUCO:
        words += [f"markers of {board.spacing * board.marker * 1000:g} mm", board.dictionary]
    words += ["inverted"] * board.inverted + ["legacy layout"] * board.legacy
    return ", ".join(words)


def object_points(board: Board) -> Floats:
    """Where its points are, (N, 3) metres, row after row; z is 0. A point's id is its place here."""
    columns, rows = board.size
    row, column = (values.ravel() for values in np.mgrid[0:rows, 0:columns].astype(np.float64))
    if board.kind is BoardKind.ACIRCLES:
        column, row = column + (row % 2) / 2, row / 2
    elif board.kind is BoardKind.CHARUCO:
        column, row = column + 1, row + 1  # from the outer corner of its first square
    return np.column_stack((column, row, np.zeros_like(row))) * board.spacing


@lru_cache(maxsize=32)
def charuco(board: Board) -> cv2.aruco.CharucoBoard:
    """OpenCV's own idea of a ChArUco board."""
    dictionary = dictionary_of(board.dictionary)
    side = board.spacing
    made = cv2.aruco.CharucoBoard((board.columns, board.rows), side, side * board.marker, dictionary)
    made.setLegacyPattern(board.legacy)
    return made


@lru_cache(maxsize=32)
def dictionary_of(name: str) -> cv2.aruco.Dictionary:
    known = {each.upper(): each for each in dir(cv2.aruco) if each.startswith("DICT_")}
    return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, known[name]))
