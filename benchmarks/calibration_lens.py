"""Lenses from boards: `python -m benchmarks.calibration_lens [--data FOLDER]`.

Rendered boards need nothing: pictures are made through a lens that is known. FOLDER holds photographs
(`calibration_photographs`). Times are of one core (OpenCV's threads are switched off).
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import cv2
import numpy as np

from benchmarks.calibration_photographs import one_sided_circles, real, sheared_view
from benchmarks.calibration_rows import Row, real_data, table
from gtm_hit.calibration.boards import Board, BoardKind
from gtm_hit.calibration.detection import find_board
from gtm_hit.calibration.intrinsics import solve_lens
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.searching import search
from gtm_hit.calibration.views import BoardView, Picture
from gtm_hit.demo.boards import board_picture, placements

SMALL, FULL = (960, 540), (1920, 1080)
VIEWS, SEARCHED, SOLVED = 30, 200, 20
BOARDS = (
    Board(BoardKind.CHESSBOARD, 9, 6, 0.03),
    Board(BoardKind.CIRCLES, 9, 6, 0.03),
    Board(BoardKind.ACIRCLES, 4, 11, 0.04),
    Board(BoardKind.CHARUCO, 8, 6, 0.03),
    Board(BoardKind.CHARUCO, 6, 8, 0.03, inverted=True, legacy=True),
)


def rows(data: Path | None) -> list[Row]:
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        found = [row for board in BOARDS for row in rendered(board)]
        found += sheared_view(pictures(BOARDS[0], SMALL, VIEWS), BOARDS[0])
        found += one_sided_circles()
        return [*found, *times(), *real(real_data(data))]
    finally:
        cv2.setNumThreads(threads)


def true_lens(size: tuple[int, int]) -> Lens:
    scale = size[0] / 960
    matrix = np.array([[800.0 * scale, 0, 470 * scale], [0, 803.0 * scale, 276 * scale], [0, 0, 1]])
    return Lens(*size, matrix, np.array([-0.25, 0.1, 0.0008, -0.0005, -0.02]))


def pictures(board: Board, size: tuple[int, int], count: int, noise: float = 1.0) -> list[Picture]:
    lens = true_lens(size)
    return [
        Picture(f"{number:03d}", board_picture(lens, board, placement, noise=noise, seed=number))
        for number, placement in enumerate(placements(lens, board, count, seed=3))
    ]


def rendered(board: Board) -> list[Row]:
    """A board of every kind before a known lens."""
    found = search(pictures(board, SMALL, VIEWS), board)
    solution, true = solve_lens(found.views, SMALL), true_lens(SMALL).matrix
    focal = 100 * abs(solution.lens.matrix[0, 0] / true[0, 0] - 1)
    centre = float(np.abs(solution.lens.matrix[:2, 2] - true[:2, 2]).max())
    name = f"rendered {board.kind}{', inverted, legacy' if board.legacy else ''}"
    return [
        Row(f"{name}: found", f"{len(found.views)} of {VIEWS}", "all", len(found.views) == VIEWS),
        Row(f"{name}: fx off", f"{focal:.3f} %", "≤ 0.1 %", focal <= 0.1),
        Row(f"{name}: centre off", f"{centre:.2f} px", "≤ 0.5 px", centre <= 0.5),
        Row(f"{name}: RMS", f"{solution.rms:.3f} px", "≤ 0.06 px", solution.rms <= 0.06),
    ]


def times() -> list[Row]:
    board = BOARDS[0]
    some = pictures(board, FULL, SOLVED, noise=2.0)
    # As in a real video half of the pictures show no whole board.
    cut = [np.ascontiguousarray(np.roll(each.grey, FULL[0] // 3, axis=1)) for each in some]
    every = [
        Picture(f"{number:03d}", some[number % SOLVED].grey if number % 2 else cut[number % SOLVED])
        for number in range(SEARCHED)
    ]
    start = time.perf_counter()
    search(every, board)
    searched = time.perf_counter() - start
    views = [view for each in some if isinstance(view := find_board(each, board), BoardView)]
    start = time.perf_counter()
    solve_lens(views, FULL)
    solved = time.perf_counter() - start
    start = time.perf_counter()
    solve_lens(views[1:], FULL)
    again = time.perf_counter() - start
    return [
        Row(f"{SEARCHED} full-HD pictures searched", f"{searched:.1f} s", "≤ 60 s", searched <= 60),
        Row(f"{len(views)} full-HD views solved", f"{solved:.2f} s", "≤ 2 s", solved <= 2),
        Row("a view switched off, solved again", f"{again:.2f} s", "< 1 s", again < 1),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="a folder with real pictures")
    print(table(rows(parser.parse_args().data)))


if __name__ == "__main__":
    main()
