"""Finding boards to a fraction of a pixel, and saying why there is none."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from gtm_hit.calibration.boards import Board
from gtm_hit.calibration.detection import find_board
from gtm_hit.calibration.searching import EXPLAINED, search
from gtm_hit.calibration.views import BoardView, NotFound, Picture
from gtm_hit.demo.boards import board_picture
from tests.calibration.board_scene import CHESS, KINDS, LENS, drawn, picture_of, straight, true_pixels, views


def refused(picture: Picture, board: Board = CHESS) -> NotFound:
    found = find_board(picture, board)
    assert isinstance(found, NotFound)
    assert found.name == picture.name
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_the_points_of_a_board_are_found_where_they_are(kind: str) -> None:
    for view, (placement, _) in zip(views(kind, 12), drawn(kind, 12), strict=True):
        true = true_pixels(view.points, placement)
        # A symmetric board may be read from its other end.
        off = min(np.abs(view.pixels - each).max() for each in (true, true[::-1]))
        assert off < (0.5 if "circles" in kind else 0.25)


def test_corners_are_as_exact_in_a_picture_that_is_looked_at_smaller() -> None:
    matrix = LENS.matrix * 3
    matrix[2, 2] = 1
    large = replace(LENS, width=1920, height=1200, matrix=matrix)
    placement = straight()
    view = find_board(Picture("large", board_picture(large, CHESS, placement)), CHESS)
    assert isinstance(view, BoardView)
    true = cv2.projectPoints(view.points, placement.rvec, placement.tvec, matrix, LENS.distortion)[0]
    true = true.reshape(-1, 2)
    assert min(np.abs(view.pixels - each).max() for each in (true, true[::-1])) < 0.15


def test_a_transposed_chessboard_is_found_all_the_same() -> None:
    found = find_board(picture_of(CHESS, straight()), replace(CHESS, columns=5, rows=8))
    assert isinstance(found, BoardView)
    assert len(found.pixels) == 40


def test_the_size_that_fits_a_chessboard_is_named() -> None:
    found = refused(picture_of(CHESS, straight()), replace(CHESS, columns=9, rows=6))
    assert found.other == (8, 5)
    assert "8×5 inner corners, not 9×6" in found.reason


@pytest.mark.parametrize(("columns", "rows"), [(9, 4), (4, 8), (5, 9)])
def test_the_size_that_fits_circles_is_named(columns: int, rows: int) -> None:
    board = KINDS["acircles"]
    picture = Picture("a", drawn("acircles", 12)[0][1])
    assert refused(picture, replace(board, columns=columns, rows=rows)).other == (4, 9)


def test_a_board_beyond_the_edge_is_said_to_be_cut_off_there() -> None:
    found = refused(picture_of(CHESS, straight(across=0.25, tilt=0.1)))
    assert "cut off" in found.reason and "right edge" in found.reason


def test_a_cut_circle_is_counted() -> None:
    grey = drawn("circles", 12)[0][1].copy()
    board = KINDS["circles"]
    view = find_board(Picture("a", grey), board)
    assert isinstance(view, BoardView)
    x, y = view.pixels[-1].astype(int)
    cv2.circle(grey, (int(x), int(y)), 18, 225, -1)
    assert "34 of 35 circles" in refused(Picture("a", grey), board).reason


def test_a_blurred_picture_is_called_blurred() -> None:
    picture = picture_of(CHESS, straight(depth=0.8))
    soft = replace(picture, grey=cv2.GaussianBlur(picture.grey, (0, 0), 5))
    assert "blurred" in refused(soft).reason


def test_a_picture_without_contrast_says_so() -> None:
    assert "contrast" in refused(Picture("a", np.full((400, 640), 90, np.uint8))).reason


def test_a_board_far_away_is_called_too_small() -> None:
    assert "small" in refused(picture_of(CHESS, straight(depth=3.5))).reason


def test_a_picture_is_told_the_same_whatever_was_looked_at_before() -> None:
    picture = picture_of(CHESS, straight(depth=3.5))
    assert len({refused(picture).reason for _ in range(30)}) == 1


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"inverted": True}, "not inverted"),
        ({"dictionary": "DICT_6X6_50"}, "DICT_4X4_50"),
        ({"columns": 5, "rows": 7}, "7×5 squares"),
    ],
)
def test_a_charuco_board_printed_otherwise_is_recognised(changes: dict, said: str) -> None:
    board = KINDS["charuco"]
    assert said in refused(Picture("a", drawn("charuco", 12)[0][1]), replace(board, **changes)).reason


def test_the_legacy_layout_is_recognised() -> None:
    board = KINDS["inverted legacy charuco"]
    picture = Picture("a", drawn("inverted legacy charuco", 12)[0][1])
    assert "legacy layout" in refused(picture, replace(board, legacy=False)).reason


def test_a_charuco_board_may_be_partly_outside() -> None:
    board = KINDS["charuco"]
    found = find_board(picture_of(board, straight(across=0.2, tilt=0.1)), board)
    assert isinstance(found, BoardView)
    assert 6 <= len(found.ids) < board.point_count


def test_another_kind_of_board_is_recognised() -> None:
    assert "chessboard" in refused(picture_of(CHESS, straight()), KINDS["acircles"]).reason
    circles = replace(KINDS["circles"], kind="chessboard")
    assert "kind circles" in refused(Picture("a", drawn("circles", 12)[0][1]), circles).reason


def test_a_search_counts_what_would_fit_and_stops_explaining_after_some() -> None:
    picture = picture_of(CHESS, straight())
    many = [replace(picture, name=f"{number}") for number in range(EXPLAINED + 2)]
    seen: list[int] = []
    found = search(many, replace(CHESS, columns=9, rows=6), seen.append)
    assert found.other == (8, 5)
    assert [each.other for each in found.missing][-2:] == [None, None]
    assert seen[-1] == len(many)
    assert len(found.by_reason()[0][1]) == EXPLAINED


def test_a_board_of_which_only_a_part_was_asked_for_is_told() -> None:
    pictures = [Picture(f"{number}", grey) for number, (_, grey) in enumerate(drawn("chessboard", 12)[:4])]
    assert search(pictures, CHESS).larger is None
    asked = search(pictures, replace(CHESS, columns=7))
    assert asked.larger == (8, 5) or asked.other == (8, 5)


def test_markers_too_small_for_opencvs_own_search_are_found() -> None:
    """Squares of 18 px, markers of 13 px, in a large picture."""
    large = replace(LENS, width=1920, height=1000)
    placement = replace(straight(), tvec=np.array([0.3, 0.2, 1.25]))
    grey = board_picture(large, KINDS["charuco"], placement)
    found = find_board(Picture("far", grey), KINDS["charuco"])
    assert isinstance(found, BoardView), found
    assert len(found.ids) >= 12
    true = cv2.projectPoints(found.points, placement.rvec, placement.tvec, LENS.matrix, LENS.distortion)[0]
    assert np.abs(true.reshape(-1, 2) - found.pixels).max() < 0.3
