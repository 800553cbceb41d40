"""`manage.py calibrate lens`: pictures of a board in, a lens and a verdict out."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError
from collections.abc import Callable
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError

from gtm_hit.calibration.boards import DEFAULT_DICTIONARY, DEFAULT_MARKER, Board, BoardKind, describe
from gtm_hit.calibration.choosing import choose
from gtm_hit.calibration.intrinsics import LensSolution, solve_lens
from gtm_hit.calibration.lens_models import Coefficients, LensModel
from gtm_hit.calibration.lens_report import lens_report, missing_report
from gtm_hit.calibration.searching import Searched, search
from gtm_hit.calibration.sources import SAMPLED, Source, open_source
from gtm_hit.calibration.verdict import Verdict, judge, worst_view
from gtm_hit.calibration.views import BoardView
from gtm_hit.geometry.errors import GeometryError

HELP = "Find a camera's lens from pictures of a board, and say whether it can be trusted."
MOST_VIEWS = 40
BAR = 30  # characters of the longest bar
SHOWN = 4  # names of pictures
EVERY = 20  # pictures between two words of progress

Say = Callable[[str], object]


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("source", type=Path, help="a folder or zip of pictures, or a video, of one camera")
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
    _add_solving_arguments(parser)


def _add_print_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--marker", type=float, default=DEFAULT_MARKER, metavar="SHARE", help="ChArUco: of a square's side"
    )
    parser.add_argument("--dictionary", default=DEFAULT_DICTIONARY, help="ChArUco (default %(default)s)")
    parser.add_argument("--inverted", action="store_true", help="white was printed on black")
    parser.add_argument(
        "--legacy", action="store_true", help="ChArUco laid out as by OpenCV before version 4.6"
    )


def _add_solving_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--model",
        choices=[each.value for each in Coefficients],
        default=Coefficients.FIVE.value,
        help="coefficients of the lens: five (k1 k2 p1 p2 k3, the default), four (without k3), "
        "two (k1 k2), one (k1), none, or rational (eight)",
    )
    parser.add_argument("--fixed-centre", action="store_true", help="principal point in the picture's middle")
    parser.add_argument("--fixed-aspect", action="store_true", help="fx = fy")
    parser.add_argument(
        "--without", nargs="+", default=[], metavar="NAME", help="leave out these pictures' views"
    )
    parser.add_argument(
        "--views",
        type=int,
        default=MOST_VIEWS,
        metavar="N",
        help="solve at most this many, chosen by tilt and coverage (default %(default)s)",
    )
    parser.add_argument(
        "--frames", type=int, default=SAMPLED, metavar="N", help="of a video (default %(default)s)"
    )


def run(options: dict[str, Any], say: Say) -> dict[str, Any]:
    try:
        board = _board(options)
        source = open_source(options["source"], options["frames"])
        _introduce(board, source, say)
        found = search(source.read(), board, _progress(source.count, say))
        _tell_missing(found, say)
        views = _chosen(found, source, options, say)
        model = LensModel(options["model"], options["fixed_centre"], options["fixed_aspect"])
        solution = solve_lens(views, source.size, model)
    except GeometryError as error:
        raise CommandError(str(error)) from error
    verdict = judge(solution)
    _tell(solution, verdict, say)
    counted = {"found": len(found.views), "pictures": len(found.views) + len(found.missing)}
    missing = {"missing": missing_report(found.missing), "notes": list(source.notes)}
    return {"board": board.as_json(), **counted, **lens_report(solution, verdict), **missing}


def _size(text: str) -> tuple[int, int]:
    columns, _, rows = text.lower().replace("×", "x").partition("x")
    try:
        return int(columns), int(rows)
    except ValueError as error:
        raise ArgumentTypeError(f"{text!r} is no size; write columns x rows, as 9x6") from error


def _board(options: dict[str, Any]) -> Board:
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


def _introduce(board: Board, source: Source, say: Say) -> None:
    width, height = source.size
    say(f"{describe(board)}; {source.count} pictures of {width}×{height}")
    for note in source.notes:
        say(f"Note: {note}")


def _progress(count: int, say: Say) -> Callable[[int], object]:
    def told(number: int) -> None:
        if number % EVERY == 0 and number < count:
            say(f"  {number} of {count} looked at")

    return told


def _tell_missing(found: Searched, say: Say) -> None:
    say(f"\nFound in {len(found.views)} of {len(found.views) + len(found.missing)}.")
    for reason, names in found.by_reason():
        shown = ", ".join(names[:SHOWN])
        more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
        say(f"  {shown}{more}: {reason}")


def _chosen(found: Searched, source: Source, options: dict[str, Any], say: Say) -> list[BoardView]:
    if found.other and not found.views:
        columns, rows = found.other
        raise CommandError(f"The board is not the one in the pictures: --size {columns}x{rows} would fit.")
    if found.other:
        say(f"More pictures would fit --size {found.other[0]}x{found.other[1]}.")
    known = {view.name for view in found.views} | {each.name for each in found.missing}
    if strangers := [name for name in options["without"] if name not in known]:
        raise CommandError(f"There is no picture named {', '.join(strangers)} to leave out.")
    views = [view for view in found.views if view.name not in options["without"]]
    if len(views) <= options["views"]:
        return views
    names = set(choose(views, source.size, max(3, options["views"])))
    say(f"The {len(names)} most useful of them are solved.")
    return [view for view in views if view.name in names]


def _tell(solution: LensSolution, verdict: Verdict, say: Say) -> None:
    say("")
    sigma = solution.sigma
    for name, value in solution.parameters.items():
        digits = 2 if name in {"fx", "fy", "cx", "cy"} else 5
        spread = f"± {sigma[name]:.{digits}f}" if name in sigma else "fixed"
        say(f"  {name}  {value:12.{digits}f}  {spread}")
    held = "" if solution.holdout_rms is None else f"; views it did not know {solution.holdout_rms:.3f} px"
    say(f"\nRMS {solution.rms:.3f} px{held}")
    worst = worst_view(solution)
    for view in solution.views:
        bar = "█" * max(1, round(BAR * view.rms / worst.rms)) if worst.rms else ""
        say(f"  {view.name:<24} {view.rms:7.3f}  {bar}")
    say(f"\n{verdict.word.value.upper()}")
    for reason in verdict.reasons:
        say(f"  - {reason.text}")
    say(f"Next: {verdict.next_step}")
