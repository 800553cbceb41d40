"""`manage.py calibrate board`: a board to print."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError

from gtm_hit.calibration.boards import BoardError, describe
from gtm_hit.calibration.pdf import board_pdf
from gtm_hit.calibration.printing import board_svg, page
from gtm_hit.formats.files import reason_of, write_bytes
from gtm_hit.management.calibrating.board_arguments import add_board_arguments, told_board

HELP = "Write a board to print, in its true size."


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("output", type=Path, help="a file that ends with .pdf or .svg")
    add_board_arguments(parser)


def run(options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
    output: Path = options["output"]
    try:
        board = told_board(options)
    except BoardError as error:
        raise CommandError(str(error)) from error
    if output.suffix.lower() not in {".pdf", ".svg"}:
        raise CommandError(f"{output.name} must end with .pdf or .svg.")
    is_pdf = output.suffix.lower() == ".pdf"
    data = board_pdf(board) if is_pdf else board_svg(board).encode()
    try:
        write_bytes(output, data)
    except OSError as error:
        raise CommandError(f"{output} cannot be written: {reason_of(error)}") from error
    sheet = page(board)
    say(f"{describe(board)}; sheet {sheet.name}, {sheet.width:.0f} × {sheet.height:.0f} mm")
    say("Print it at 100 % and measure the ruler: 100 mm.")
    return {"board": board.as_json(), "sheet": sheet.name, "millimetres": [sheet.width, sheet.height]}
