"""Looking for a board in one picture, to a fraction of a pixel."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from gtm_hit.calibration.boards import FEWEST_CORNERS, Board, BoardKind, object_points
from gtm_hit.calibration.markers import detect, without_markers
from gtm_hit.calibration.reasons import (
    BLURRED_WORDS,
    edge_width,
    too_small,
    why_briefly,
    why_circles,
    why_markers,
    why_squares,
    why_unusable,
)
from gtm_hit.calibration.spotting import (
    chessboard_corners,
    circle_centres,
    grid_spacing,
    largest_chessboard,
    shrunk,
)
from gtm_hit.calibration.views import BoardView, Floats, Grey, NotFound, Picture

LOOKED_AT = 1280  # pixels, the longer side; corners are refined in the full picture
SHARE = 2.5  # of the spacing: a window larger than this reaches the neighbouring corners
CHARUCO_SHARE = 0.3  # the same where markers were painted over
LARGEST_WINDOW = 24  # pixels, half a side; more only costs time
SOFT = 0.43  # of the spacing: where an edge of squares is wider, corners run into each other
OFF_GRID = 0.35  # of the spacing, median distance from a plane grid: the points were put together wrongly
REFINE = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 100, 1e-4)


def find_board(picture: Picture, board: Board, explain: bool = True) -> BoardView | NotFound:
    """The board's points in the picture, or why none were found: a guess at once where not `explain`."""
    grey = 255 - picture.grey if board.inverted else picture.grey
    picture = replace(picture, grey=np.ascontiguousarray(grey))
    if reason := why_unusable(picture):
        return NotFound(picture.name, reason)
    if board.kind is BoardKind.CHARUCO:
        return _charuco(picture, board, explain)
    look = _circles if board.has_circles else _chessboard
    found = look(picture, board, explain)
    if isinstance(found, NotFound):
        return found
    points = object_points(board)
    return _checked(BoardView(picture.name, found, points, np.arange(len(points))), picture.grey, board)


def _chessboard(picture: Picture, board: Board, explain: bool) -> Floats | NotFound:
    small, scale = shrunk(picture.grey, LOOKED_AT)
    corners = chessboard_corners(small, board.size)
    if corners is None:
        corners = largest_chessboard(small) if explain else None
        if corners is None or board.size not in {corners.shape[1::-1], corners.shape[:2]}:
            return why_squares(picture.name, small, scale, board, corners)
        if corners.shape[1::-1] != board.size:
            corners = corners.transpose(1, 0, 2)
    pixels = (corners.reshape(-1, 2) + 0.5) / scale - 0.5
    spacing = grid_spacing(pixels, board.size)
    return _refined(picture.grey, pixels, spacing / SHARE)


def _circles(picture: Picture, board: Board, explain: bool) -> Floats | NotFound:
    found = circle_centres(picture.grey, board.size, board.kind is BoardKind.ACIRCLES)
    if found is not None:
        return found
    return why_circles(picture, board) if explain else why_briefly(picture, board)


def _charuco(picture: Picture, board: Board, explain: bool) -> BoardView | NotFound:
    seen = detect(picture.grey, board)
    if len(seen.ids) < FEWEST_CORNERS:
        if not explain:
            return why_briefly(picture, board)
        return why_markers(picture, board, len(seen.ids), len(seen.markers))
    points = object_points(board)[seen.ids]
    if min(np.ptp(points[:, :2], axis=0)) < board.spacing / 2:
        return NotFound(picture.name, "Only one line of the board's corners is seen; a plane is needed.")
    clean = without_markers(picture.grey, seen.markers, board)
    pixels = _refined(clean, seen.corners, _spacing_of(seen.corners, points, board) * CHARUCO_SHARE)
    return _checked(BoardView(picture.name, pixels, points, seen.ids), picture.grey, board)


def _refined(grey: Grey, pixels: Floats, window: float) -> Floats:
    half = int(np.clip(window, 2, LARGEST_WINDOW))
    corners = np.ascontiguousarray(pixels, dtype=np.float32).reshape(-1, 1, 2)
    cv2.cornerSubPix(grey, corners, (half, half), (-1, -1), REFINE)
    return corners.reshape(-1, 2).astype(np.float64)


def _checked(view: BoardView, grey: Grey, board: Board) -> BoardView | NotFound:
    """Refuses what no picture of a plane board can be: points too close, or not on a grid."""
    spacing = _spacing_of(view.pixels, view.points, board)
    if reason := too_small(spacing):
        return NotFound(view.name, reason)
    if not board.has_circles and edge_width(grey, view.pixels, spacing) > SOFT * spacing:
        return NotFound(view.name, BLURRED_WORDS)
    homography, _ = cv2.findHomography(view.points[:, :2], view.pixels)
    if homography is None:
        return NotFound(view.name, "The points found lie on one line; a plane is needed.")
    planar = cv2.perspectiveTransform(view.points[None, :, :2], homography)[0]
    if np.median(np.linalg.norm(planar - view.pixels, axis=1)) > OFF_GRID * spacing:
        return NotFound(view.name, "What was found does not lie on a grid; the board may be partly hidden.")
    return view


def _spacing_of(pixels: Floats, points: Floats, board: Board) -> float:
    """Pixels between the two neighbouring points that are closest in the picture."""
    apart = np.linalg.norm(points[:, None, :2] - points[None, :, :2], axis=2)
    neighbours = (apart > 0) & (apart < board.spacing * 1.01)
    if not neighbours.any():
        return 0.0
    seen = np.linalg.norm(pixels[:, None] - pixels[None], axis=2)
    return float(seen[neighbours].min())
