"""Boards on paper are what they claim to be, to scale."""

from __future__ import annotations

import re
from dataclasses import replace

import cv2
import numpy as np
import pytest
import resvg_py

from gtm_hit.calibration.artwork import Dot, extent, ink, shapes
from gtm_hit.calibration.boards import Board, BoardKind
from gtm_hit.calibration.detection import find_board
from gtm_hit.calibration.pdf import board_pdf
from gtm_hit.calibration.printing import board_svg, page
from gtm_hit.calibration.views import BoardView, Picture
from tests.calibration.board_scene import KINDS

DPI = 60


@pytest.mark.parametrize("kind", KINDS)
def test_the_svg_shows_the_board_in_its_true_size(kind: str) -> None:
    board = KINDS[kind]
    png = bytes(resvg_py.svg_to_bytes(svg_string=board_svg(board), dpi=DPI))
    grey = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_GRAYSCALE)
    view = find_board(Picture("print", grey), board)
    assert isinstance(view, BoardView), view
    assert len(view.ids) == board.point_count
    per_metre = grey.shape[1] / page(board).width * 1000
    seen = np.linalg.norm(view.pixels[-1] - view.pixels[0])
    assert seen / per_metre == pytest.approx(np.linalg.norm(view.points[-1] - view.points[0]), rel=0.01)


@pytest.mark.parametrize("kind", KINDS)
def test_paper_and_rendering_show_the_same(kind: str) -> None:
    board = KINDS[kind]
    area, rng = extent(board), np.random.default_rng(0)
    x = rng.uniform(area.left, area.right, 4000)
    y = rng.uniform(area.top, area.bottom, 4000)
    painted = np.zeros(4000, dtype=bool)
    for shape in shapes(board):
        if isinstance(shape, Dot):
            painted[np.hypot(x - shape.x, y - shape.y) <= shape.radius] = True
        else:
            within = (x >= shape.x) & (x < shape.x + shape.side) & (y >= shape.y) & (y < shape.y + shape.side)
            painted[within] = shape.black
    assert (painted == ink(board, x, y)).mean() > 0.999
    assert 0.1 < painted.mean() < 0.9


@pytest.mark.parametrize("kind", KINDS)
def test_the_pdf_holds_the_same_shapes_in_points(kind: str) -> None:
    board = KINDS[kind]
    data, paper = board_pdf(board), page(board)
    width, height = re.search(rb"MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", data).groups()  # type: ignore[union-attr]
    assert float(width) / 72 * 25.4 == pytest.approx(paper.width, abs=0.01)
    assert float(height) / 72 * 25.4 == pytest.approx(paper.height, abs=0.01)
    drawn = len(re.findall(rb" re f\n| re f$", data)) + data.count(b" m ")
    assert drawn == sum(not hasattr(mark, "text") for mark in paper.marks)


def test_every_object_of_the_pdf_is_where_its_table_says() -> None:
    data = board_pdf(KINDS["chessboard"])
    start = int(re.search(rb"startxref\n(\d+)", data).group(1))  # type: ignore[union-attr]
    assert data[start : start + 4] == b"xref"
    places = [int(place) for place in re.findall(rb"(\d{10}) 00000 n", data[start:])]
    assert [data[place:].split(b" ", 1)[0] for place in places] == [b"1", b"2", b"3", b"4", b"5", b"6"]


def test_the_sheet_says_what_it_is_and_has_a_ruler_of_100_mm() -> None:
    svg = board_svg(KINDS["charuco"])
    assert "ChArUco board, 7×5 squares, squares of 40 mm" in svg and "100 mm" in svg
    assert 'width="100.0000"' in svg


def test_the_smallest_sheet_is_taken_and_a_large_board_gets_its_own() -> None:
    small = Board(BoardKind.CHESSBOARD, 8, 5, 0.02)
    assert page(small).name == "A4"
    assert page(replace(small, spacing=0.03)).name == "A3"
    large = page(replace(small, spacing=0.2))
    assert large.name == "larger than A0" and large.width > 1800


def test_the_same_board_gives_the_same_bytes() -> None:
    assert board_pdf(KINDS["circles"]) == board_pdf(replace(KINDS["circles"]))
