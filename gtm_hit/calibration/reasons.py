"""Why a picture shows no board: what somebody who holds the board can change."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import cv2
import numpy as np

from gtm_hit.calibration.boards import DICTIONARIES, WHAT, Board, BoardKind, dictionary_of
from gtm_hit.calibration.markers import detect
from gtm_hit.calibration.spotting import (
    chessboard_corners,
    circle_centres,
    circle_count,
    largest_chessboard,
    shrunk,
)
from gtm_hit.calibration.views import Floats, Grey, NotFound, Picture

LEAST_CONTRAST = 24  # grey levels between the darkest and the brightest hundredth
BLURRED = 0.62  # of `blur`, 0 … 1; sharp photographs have 0.2 to 0.45
BLURRED_WORDS = "The picture is blurred: hold the board still, or use more light."
SMALLEST = 64  # pixels a side
SMALLEST_SPACING = 6.0  # pixels between two points; below it they cannot be told to a fraction of a pixel
FEWEST_SEEN = 12  # corners that say something about a board


def why_unusable(picture: Picture) -> str | None:
    """What is wrong with the picture itself."""
    width, height = picture.size
    if min(width, height) < SMALLEST:
        return f"The picture is only {width}×{height} pixels."
    small, _ = shrunk(picture.grey, 640)
    dark, bright = np.percentile(small, (1, 99))
    if bright - dark < LEAST_CONTRAST:
        return (
            f"There is hardly any contrast: nearly all of it lies between {dark:.0f} and {bright:.0f} of 255."
        )
    return None


def blur(grey: Grey) -> float:
    """How much of the picture's small steps another blur leaves, 0 (sharp) … 1.

    After Crété-Roffet et al. 2007: what was blurred already hardly changes.
    """
    small, _ = shrunk(grey, 960)
    image = small.astype(np.float32)
    shares = []
    for axis, kernel in ((1, (9, 1)), (0, (1, 9))):
        before = np.abs(np.diff(image, axis=axis))
        after = np.abs(np.diff(cv2.blur(image, kernel), axis=axis))
        total = float(before.sum())
        shares.append(1.0 if total == 0 else 1 - float(np.maximum(before - after, 0).sum()) / total)
    return max(shares)


def expected(board: Board) -> str:
    name, counted, _ = WHAT[board.kind]
    name = name if board.kind is BoardKind.CHARUCO else name.lower()
    return f"{name} of {board.columns}×{board.rows} {counted}"


def _nothing(board: Board) -> str:
    return (
        f"No {expected(board)} is seen. All of it must be in the picture, flat, unhidden, "
        "with a free margin around it."
    )


def too_small(spacing: float) -> str | None:
    if spacing >= SMALLEST_SPACING:
        return None
    return f"The board is too small in the picture: its points are {spacing:.1f} px apart. Hold it closer."


def edge_width(grey: Grey, pixels: Floats, spacing: float) -> float:
    """Pixels an edge around the board's points takes from dark to bright, the median."""
    half = max(3, int(spacing / 2))
    widths = []
    for x, y in np.round(pixels).astype(int):
        part = grey[max(0, y - half) : y + half + 1, max(0, x - half) : x + half + 1].astype(np.float64)
        if min(part.shape) < 3:
            continue
        dark, bright = np.percentile(part, (5, 95))
        steepest = np.percentile(np.hypot(*np.gradient(part)), 98)
        widths.append((bright - dark) / max(steepest, 1e-9))
    return float(np.median(widths)) if widths else 0.0


def _spacing(corners: Floats) -> float:
    steps = [np.linalg.norm(np.diff(corners, axis=axis), axis=2).min() for axis in (0, 1)]
    return float(min(steps))


def _blurred(grey: Grey) -> str | None:
    return (
        "The picture is blurred: hold the board still, or use more light." if blur(grey) > BLURRED else None
    )


def sharpness(grey: Grey) -> float:
    """Grows with sharpness; only frames of one video can be compared by it."""
    return float(cv2.Laplacian(grey, cv2.CV_32F).var())


def why_briefly(picture: Picture, board: Board) -> NotFound:
    """What can be said without looking for anything else."""
    return NotFound(picture.name, _blurred(picture.grey) or _nothing(board))


def why_squares(name: str, grey: Grey, scale: float, board: Board, corners: Floats | None) -> NotFound:
    """Why no chessboard was found in a picture shrunk by `scale`, given the largest grid that is seen."""
    if corners is not None and (reason := too_small(_spacing(corners) / scale)):
        return NotFound(name, reason)
    if corners is None or corners.shape[0] * corners.shape[1] < FEWEST_SEEN:
        return NotFound(name, _blurred(grey) or _circles_instead(grey, board) or _nothing(board))
    rows, columns = corners.shape[:2]
    if (columns > rows) != (board.columns > board.rows):
        rows, columns, corners = columns, rows, corners.transpose(1, 0, 2)
    edges = cut_at(corners, grey.shape)
    if columns <= board.columns and rows <= board.rows and edges:
        return NotFound(
            name,
            f"The board is cut off: {columns}×{rows} of its {board.columns}×{board.rows} inner corners "
            f"are seen, and it goes on beyond the {' and the '.join(edges)} of the picture.",
        )
    if chessboard_corners(grey, (columns, rows)) is None:
        return NotFound(
            name,
            f"Only a part of {columns}×{rows} of the {board.columns}×{board.rows} inner corners is seen; "
            "something may hide the others, or light blots them out.",
        )
    return NotFound(name, _other(board, columns, rows), (columns, rows))


def _circles_instead(grey: Grey, board: Board) -> str | None:
    for kind in (BoardKind.CIRCLES, BoardKind.ACIRCLES):
        if circle_centres(grey, board.size, kind is BoardKind.ACIRCLES) is not None:
            return f"The board in this picture is of the kind {kind}, not {board.kind}."
    return None


def _other(board: Board, columns: int, rows: int) -> str:
    _, counted, _ = WHAT[board.kind]
    return (
        f"The board in this picture has {columns}×{rows} {counted}, not {board.columns}×{board.rows}. "
        f"If it is the right one, say {columns}x{rows}."
    )


def cut_at(corners: Floats, shape: tuple[int, ...]) -> list[str]:
    """The edges of the picture over which a seen grid (rows, columns, 2) goes on."""
    beyond = [2 * corners[0] - corners[1], 2 * corners[-1] - corners[-2]]
    beyond += [2 * corners[:, 0] - corners[:, 1], 2 * corners[:, -1] - corners[:, -2]]
    x, y = np.concatenate(beyond).T
    height, width = shape[:2]
    sides = {
        "left edge": x < 0,
        "right edge": x > width - 1,
        "upper edge": y < 0,
        "lower edge": y > height - 1,
    }
    return [side for side, out in sides.items() if out.any()]


def why_circles(picture: Picture, board: Board) -> NotFound:
    grey, name = picture.grey, picture.name
    if reason := _chessboard_instead(grey):
        return NotFound(name, reason)
    seen, wanted = circle_count(grey), board.columns * board.rows
    for columns, rows in _neighbours(board):
        # A smaller grid is found within one that lacks a circle, too.
        likely = columns * rows >= wanted or seen <= columns * rows
        if likely and circle_centres(grey, (columns, rows), board.kind is BoardKind.ACIRCLES) is not None:
            return NotFound(name, _other(board, columns, rows), (columns, rows))
    if reason := _blurred(grey):
        return NotFound(name, reason)
    if seen < wanted:
        return NotFound(
            name,
            f"Only {seen} of {wanted} circles are seen: one that is cut off, hidden or too small, and the "
            "grid cannot be told.",
        )
    other = BoardKind.CIRCLES if board.kind is BoardKind.ACIRCLES else BoardKind.ACIRCLES
    if circle_centres(grey, board.size, other is BoardKind.ACIRCLES) is not None:
        return NotFound(name, f"The board in this picture is of the kind {other}, not {board.kind}.")
    return NotFound(name, _nothing(board))


def _chessboard_instead(grey: Grey) -> str | None:
    small, _ = shrunk(grey, 960)
    corners = largest_chessboard(small)
    if corners is None or corners.shape[0] * corners.shape[1] < FEWEST_SEEN:
        return None
    rows, columns = sorted(corners.shape[:2])
    if chessboard_corners(small, (columns, rows)) is None:
        return None
    return f"Squares as of a chessboard with {columns}×{rows} inner corners are seen, and nothing else."


def _neighbours(board: Board) -> Iterator[tuple[int, int]]:
    """Sizes somebody may have meant: transposed, then one more or less."""
    columns, rows = board.columns, board.rows
    if columns != rows:
        yield rows, columns
    for more in ((1, 1), (1, 0), (0, 1), (-1, 0), (0, -1), (-1, -1)):
        if min(columns + more[0], rows + more[1]) >= 2:
            yield columns + more[0], rows + more[1]


def why_markers(picture: Picture, board: Board, corners: int, markers: int) -> NotFound:
    """Why too few corners of a ChArUco board were found: the wrong board, or too little of it."""
    grey, name = picture.grey, picture.name
    for other, words in _other_prints(board):
        more = _corner_count(grey, other)
        if more >= max(6, 2 * corners):
            fits = (other.columns, other.rows) if other.columns != board.columns else None
            return NotFound(name, f"With {words} {more} corners are seen, instead of {corners}.", fits)
    if _corner_count(255 - grey, board) >= max(6, 2 * corners):
        wrong = "not inverted" if board.inverted else "inverted"
        return NotFound(name, f"The board in this picture is {wrong}.")
    if markers == 0:
        if dictionary := _other_dictionary(grey, board):
            return NotFound(name, f"The markers in this picture are of {dictionary}, not {board.dictionary}.")
        reason = _blurred(grey) or _chessboard_instead(grey) or f"No marker of {board.dictionary} is seen."
        return NotFound(name, reason)
    return NotFound(
        name,
        f"Only {corners} corners and {markers} markers are seen; 6 corners are the least. "
        "Show more of the board, larger and sharper.",
    )


def _other_prints(board: Board) -> Iterator[tuple[Board, str]]:
    yield replace(board, legacy=not board.legacy), "the newer layout" if board.legacy else "the legacy layout"
    if board.columns != board.rows:
        turned = replace(board, columns=board.rows, rows=board.columns)
        yield turned, f"{turned.columns}×{turned.rows} squares"
        other = "the newer" if board.legacy else "the legacy"
        words = f"{turned.columns}×{turned.rows} squares and {other} layout"
        yield replace(turned, legacy=not board.legacy), words


def _corner_count(grey: Grey, board: Board) -> int:
    return len(detect(grey, board).ids)


def _other_dictionary(grey: Grey, board: Board) -> str | None:
    """The smallest dictionary that has most of the markers seen."""
    best, most = None, 2
    for name in sorted(DICTIONARIES, key=lambda name: (len(dictionary_of(name).bytesList), name)):
        if name == board.dictionary:
            continue
        ids = cv2.aruco.ArucoDetector(dictionary_of(name)).detectMarkers(grey)[1]
        seen = 0 if ids is None else len(np.unique(ids))
        if seen > most:
            best, most = name, seen
    return best
