"""What a board is, and what no board can be."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gtm_hit.calibration.boards import Board, BoardError, BoardKind, charuco, describe, object_points


def board(**changes: Any) -> Board:
    return Board(**{"kind": "chessboard", "columns": 9, "rows": 6, "spacing": 0.03} | changes)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"kind": "triangles"}, "acircles"),
        ({"columns": 2}, "columns"),
        ({"rows": 0}, "rows"),
        ({"columns": 1000}, "columns"),
        ({"columns": 9.5}, "9.5"),
        ({"kind": "circles", "columns": 2, "rows": 2}, "too few"),
        ({"spacing": 0}, "above 0"),
        ({"spacing": float("nan")}, "above 0"),
        ({"kind": "charuco", "dictionary": "DICT_9X9"}, "no dictionary"),
        ({"kind": "charuco", "marker": 1.2}, "marker"),
        ({"kind": "charuco", "columns": 30, "rows": 30}, "450 markers"),
    ],
)
def test_a_board_that_cannot_be_is_refused_with_a_sentence(changes: dict[str, Any], word: str) -> None:
    with pytest.raises(BoardError, match=word):
        board(**changes)


@pytest.mark.parametrize(("spacing", "said"), [(30, "millimetres, say 0.03"), (3, "centimetres, say 0.03")])
def test_a_spacing_in_another_unit_is_told_with_the_number_meant(spacing: float, said: str) -> None:
    with pytest.raises(BoardError, match=said):
        board(spacing=spacing)


def test_the_points_of_a_chessboard_are_its_inner_corners() -> None:
    points = object_points(board())
    assert points.shape == (54, 3)
    assert points[10].tolist() == pytest.approx([0.03, 0.03, 0])


def test_every_other_row_of_asymmetric_circles_is_half_a_spacing_to_the_right() -> None:
    points = object_points(board(kind="acircles", columns=4, rows=11, spacing=0.04))
    assert points[4].tolist() == pytest.approx([0.02, 0.02, 0])
    assert points[8].tolist() == pytest.approx([0, 0.04, 0])


@pytest.mark.parametrize("legacy", [False, True])
def test_the_points_of_a_charuco_board_are_those_of_opencv(legacy: bool) -> None:
    made = board(kind="charuco", columns=5, rows=8, legacy=legacy)
    assert np.allclose(object_points(made), charuco(made).getChessboardCorners(), atol=1e-7)


def test_a_board_can_be_kept_as_json_and_made_again() -> None:
    made = board(kind="charuco", dictionary="DICT_5X5_100", inverted=True, legacy=True)
    assert Board(**made.as_json()) == made
    assert Board(**board(kind=BoardKind.CIRCLES).as_json()) == board(kind="circles")


def test_a_board_is_described_as_somebody_would_say_it() -> None:
    assert describe(board()) == "Chessboard, 9×6 inner corners, squares of 30 mm"
    told = describe(board(kind="charuco", inverted=True))
    assert "markers of 22.5 mm" in told and told.endswith("inverted")
