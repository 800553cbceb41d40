"""Rendered boards are exact: measured without the detectors that they are there to measure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gtm_hit.calibration.artwork import extent
from gtm_hit.calibration.boards import Board, BoardKind, object_points
from gtm_hit.demo.boards import Placement, board_picture, draw_board, placements
from tests.calibration.board_scene import CHESS, KINDS, LENS, straight, true_pixels

DOTS = Board(BoardKind.CIRCLES, 4, 3, 0.06)


PLAIN = replace(LENS, distortion=np.zeros(5))


def test_a_dot_lies_where_the_camera_model_puts_it() -> None:
    """By the centre of gravity of the ink: straight on, a circle's image is a circle."""
    placement = Placement(np.array([0.0, 0.0, 0.4]), np.array([-0.05, -0.08, 0.55]))
    picture = board_picture(PLAIN, DOTS, placement, noise=0, blur=0).astype(float)
    points = object_points(DOTS) @ placement.rotation.T + placement.tvec
    for x, y, z in points:
        pixel = np.array([560 * x / z + 312, 562 * y / z + 205])
        left, top = np.round(pixel).astype(int) - 28
        part = 225 - picture[top : top + 57, left : left + 57]
        v, u = np.mgrid[top : top + 57, left : left + 57]
        centre = np.array([(part * u).sum(), (part * v).sum()]) / part.sum()
        assert np.abs(centre - pixel).max() < 0.005


def test_an_edge_is_as_bright_as_the_share_that_is_covered() -> None:
    """Straight on and without a lens the area of ink is known: squares of 20 × 20 px."""
    plain = replace(PLAIN, matrix=np.array([[500.0, 0, 320], [0, 500.0, 200], [0, 0, 1]]))
    board = Board(BoardKind.CHESSBOARD, 3, 3, 0.04)
    picture = np.zeros((400, 640), np.float32)
    draw_board(picture, plain, board, Placement(np.zeros(3), np.array([0.0123, 0.0077, 1.0])))
    area = extent(board)
    pixels = (area.right - area.left) * (area.bottom - area.top) * 500**2
    ink = 8 * 20 * 20
    assert picture.sum() == pytest.approx(225 * pixels - 190 * ink, rel=1e-4)


def test_every_placement_shows_the_whole_board() -> None:
    for placement in placements(LENS, CHESS, 20, seed=2):
        pixels = true_pixels(object_points(CHESS), placement)
        assert (pixels > 0).all() and (pixels < (LENS.width, LENS.height)).all()


def test_the_same_seed_gives_the_same_picture() -> None:
    one, other = (board_picture(LENS, CHESS, straight(), seed=3) for _ in range(2))
    assert np.array_equal(one, other)
    assert not np.array_equal(one, board_picture(LENS, CHESS, straight(), seed=4))


def test_a_board_behind_the_camera_is_not_seen() -> None:
    picture = np.full((400, 640), 99, np.float32)
    draw_board(picture, LENS, CHESS, Placement(np.zeros(3), np.array([0.0, 0.0, -0.5])))
    assert (picture == 99).all()


def test_an_inverted_board_is_white_on_black() -> None:
    board = KINDS["circles"]
    bright, dark = (
        board_picture(LENS, replace(board, inverted=inverted), straight(), noise=0, blur=0)
        for inverted in (False, True)
    )
    middle = np.s_[170:230, 240:360]
    assert (bright[middle].astype(int) + dark[middle] == 260).all()
    assert set(np.unique(bright[middle])) >= {35, 225}
