"""A small camera whose lens is known, and boards before it."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import cv2
import numpy as np

from gtm_hit.calibration.boards import Board, BoardKind
from gtm_hit.calibration.detection import find_board
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.views import BoardView, Grey, Picture
from gtm_hit.demo.boards import Placement, board_picture, placements

LENS = Lens(
    640,
    400,
    np.array([[560.0, 0.0, 312.0], [0.0, 562.0, 205.0], [0.0, 0.0, 1.0]]),
    np.array([-0.25, 0.1, 0.0008, -0.0005, -0.02]),
)
SIZE = (LENS.width, LENS.height)
CHESS = Board(BoardKind.CHESSBOARD, 8, 5, 0.03)
KINDS = {
    "chessboard": CHESS,
    "circles": Board(BoardKind.CIRCLES, 7, 5, 0.03),
    "acircles": Board(BoardKind.ACIRCLES, 4, 9, 0.04),
    "charuco": Board(BoardKind.CHARUCO, 7, 5, 0.04),
    "inverted legacy charuco": Board(
        BoardKind.CHARUCO, 5, 6, 0.04, 0.75, "DICT_4X4_100", inverted=True, legacy=True
    ),
}


def straight(depth: float = 0.5, across: float = 0.0, tilt: float = 0.3) -> Placement:
    """The chessboard near the middle of the picture, `across` metres to the right."""
    return Placement(np.array([tilt, tilt / 2, 0.0]), np.array([across - 0.1, -0.06, depth]))


def picture_of(board: Board, placement: Placement, name: str = "a") -> Picture:
    return Picture(name, board_picture(LENS, board, placement))


@lru_cache
def drawn(kind: str, count: int) -> tuple[tuple[Placement, Grey], ...]:
    board = KINDS[kind]
    return tuple(
        (placement, board_picture(LENS, board, placement, seed=number))
        for number, placement in enumerate(placements(LENS, board, count, seed=1))
    )


@lru_cache
def views(kind: str = "chessboard", count: int = 12) -> tuple[BoardView, ...]:
    found = [
        find_board(Picture(f"{number:02d}", grey), KINDS[kind])
        for number, (_, grey) in enumerate(drawn(kind, count))
    ]
    assert all(isinstance(view, BoardView) for view in found), found
    return tuple(view for view in found if isinstance(view, BoardView))


def true_pixels(board_points: np.ndarray, placement: Placement) -> np.ndarray:
    return cv2.projectPoints(board_points, placement.rvec, placement.tvec, LENS.matrix, LENS.distortion)[
        0
    ].reshape(-1, 2)


def exact_view(name: str, placement: Placement, board: Board = CHESS, noise: float = 0.0) -> BoardView:
    """A view without a picture: true pixels, and errors of `noise` px if wanted."""
    from gtm_hit.calibration.boards import object_points

    points = object_points(board)
    pixels = true_pixels(points, placement)
    pixels = pixels + np.random.default_rng(sum(map(ord, name))).normal(0, noise, pixels.shape)
    return BoardView(name, pixels, points, np.arange(len(points)))


def write_pictures(folder: Path, count: int = 8) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for number, (_, grey) in enumerate(drawn("chessboard", 12)[:count]):
        cv2.imwrite(str(folder / f"{number:02d}.png"), grey)
    return folder
