"""How a board is told on the command line."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError
from typing import Any

from gtm_hit.calibration.boards import DEFAULT_DICTIONARY, DEFAULT_MARKER, Board, BoardKind


def add_board_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("--board", choices=[kind.value for kind in BoardKind], default="chessboard")
    parser.add_argument(
        "--size",
        type=_size,
        required=True,
        metavar="9x6",
        help="columns x rows: inner corners of a chessboard, circles, squares of a ChArUco board",
    )
    parser.add_argument(
        "--spacing", type=float, required=True, metavar="METRES", help="side of a square, or between circles"
    )
    _add_print_arguments(parser)


def _add_print_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--marker", type=float, default=DEFAULT_MARKER, metavar="SHARE", help="ChArUco: of a square's side"
    )
    parser.add_argument("--dictionary", default=DEFAULT_DICTIONARY, help="ChArUco (default %(default)s)")
    parser.add_argument("--inverted", action="store_true", help="white was printed on black")
    parser.add_argument(
        "--legacy", action="store_true", help="ChArUco laid out as by OpenCV before version 4.6"
    )


def _size(text: str) -> tuple[int, int]:
    columns, _, rows = text.lower().replace("×", "x").partition("x")
    try:
        return int(columns), int(rows)
    except ValueError as error:
        raise ArgumentTypeError(f"{text!r} is no size; write columns x rows, as 9x6") from error


def told_board(options: dict[str, Any]) -> Board:
    """Raises BoardError."""
    columns, rows = options["size"]
    return Board(
        BoardKind(options["board"]),
        columns,
        rows,
        options["spacing"],
        options["marker"],
        options["dictionary"].upper(),
        options["inverted"],
        options["legacy"],
    )
