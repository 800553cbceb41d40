"""Photographs of real boards, where they are there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks.calibration_lens import BOARDS
from benchmarks.calibration_photographs import folder_search, real
from gtm_hit.calibration.boards import Board, BoardKind
from gtm_hit.calibration.intrinsics import solve_lens
from gtm_hit.calibration.verdict import Word, judge


@pytest.fixture
def photographs(shared_data: Path) -> Path:
    if not (shared_data / "calibration" / "chessboard_opencv_left").is_dir():
        pytest.skip("reference data not present: calibration")
    return shared_data / "calibration"


def test_every_bar_of_the_photographs_is_met(photographs: Path) -> None:
    rows = list(real(photographs))
    assert len(rows) >= 10
    assert [row for row in rows if row.met is False] == []


def test_circles_with_half_a_pixel_are_not_to_be_used_with_any_model(photographs: Path) -> None:
    found = folder_search(photographs / "acircles_photos", "*.png", Board(BoardKind.ACIRCLES, 4, 11, 0.03))
    assert found is not None
    solution = solve_lens(found[0].views, found[1])
    assert solution.rms < 0.5
    verdict = judge(solution)
    assert verdict.word is Word.DO_NOT_USE
    assert "outside the picture" in verdict.reasons[0].text


def test_the_size_that_fits_photographs_is_named(photographs: Path) -> None:
    board = replace(BOARDS[0], columns=10, rows=7)
    found = folder_search(photographs / "chessboard_opencv_left", "left0[12].jpg", board)
    assert found is not None and found[0].other == (9, 6)
