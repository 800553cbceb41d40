"""The part of `manage.py calibrationdesk` that adjusts all cameras together."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError

from gtm_hit.calibration.adjustment.adjusting import Step
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.formats.calibration.pos_file import Numbering
from gtm_hit.formats.files import read_source, write_bytes
from gtm_hit.models import Desk, DeskAdjustment
from gtm_hit.ops.desk import (
    adjust_choices,
    adjust_decisions,
    adjust_files,
    adjust_job,
    adjust_results,
    adjust_solving,
)
from gtm_hit.ops.desk.adjust_choices import Choices

MOST_BYTES = 200_000_000
SAID_EVERY = 20  # steps
FEET = {"0": Numbering.FROM_ZERO, "1": Numbering.FROM_ONE}


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--click-file",
        type=Path,
        metavar="FILE",
        help="adjust with its clicks: a ba_problem.txt (in centimetres, or --unit), or a zip or folder of "
        "CAMERA/FRAME.pos",
    )
    parser.add_argument("--feet", choices=sorted(FEET), help="the number .pos files give feet")
    three: Any = {"nargs": 3, "action": "append", "default": [], "metavar": ("SOURCE", "POINT", "CAMERA")}
    parser.add_argument("--drop", help="do not adjust with this click; SOURCE is ground or kept", **three)
    parser.add_argument("--keep", help="this click is right, however far off", **three)
    parser.add_argument("--adjust", action="store_true", help="adjust all cameras and points at once")
    parser.add_argument(
        "--variant",
        choices=[each.value for each in Variant],
        default=Choices.variant,
        help="with --adjust: what of the lenses may move (%(default)s: held near those of the lens step)",
    )
    parser.add_argument(
        "--huber",
        dest="turn",
        type=float,
        default=Choices.turn,
        metavar="PX",
        help="a miss beyond it counts less (1)",
    )
    parser.add_argument("--ground-weight", type=float, help="of a click on a measured point")
    parser.add_argument(
        "--ground-sigma", type=float, default=0.0, metavar="METRES", help="measured points may be off by it"
    )
    parser.add_argument(
        "--hold", action="append", default=[], metavar="CAMERA:WHAT", help="pose, lens, or fx,k3 stay"
    )
    parser.add_argument(
        "--use-result", action="store_true", help="let the cameras stand by the newest result"
    )
    parser.add_argument("--leave-result", action="store_true", help="by their own lenses and clicks again")
    parser.add_argument("--ba-problem", type=Path, metavar="FILE", help="write clicks and cameras so")
    parser.add_argument("--pos", type=Path, metavar="FILE", help="write feet and heads as .pos in a zip")


def work(desk: Desk, options: dict[str, Any], say: Callable[[str], object]) -> None:
    """Raises DeskError, FormatError."""
    if options["click_file"]:
        _take(desk, options["click_file"], options["unit"] or "cm", FEET.get(options["feet"]))
    for decision in ("drop", "keep"):
        for source, point, camera in options[decision]:
            adjust_decisions.decide(desk, source, point, camera, decision)
    choices = _choices(options)
    if options["adjust"]:
        found = _adjusted(desk, choices, say)
        for line in _lines(found):
            say(line)
    if options["use_result"]:
        adjust_results.use(desk)
    if options["leave_result"]:
        adjust_results.go_back(desk)


def write(desk: Desk, options: dict[str, Any]) -> None:
    """Raises DeskError."""
    if options["ba_problem"]:
        text = adjust_files.problem_text(desk, _choices(options), options["unit"] or "cm")
        write_bytes(options["ba_problem"], text.encode())
    if options["pos"]:
        write_bytes(options["pos"], adjust_files.pos_zip(desk))


def _choices(options: dict[str, Any]) -> Choices:
    return Choices(
        options["variant"],
        options["turn"],
        options["ground_weight"],
        options["ground_sigma"],
        adjust_choices.holding(options["hold"]),
    )


def _take(desk: Desk, path: Path, unit: str, numbering: Numbering | None) -> None:
    if not path.is_dir():
        adjust_files.put_any(desk, read_source(path.absolute(), MOST_BYTES), path.name, unit, numbering)
        return
    files = {
        (each.parent.name, each.stem): read_source(each.absolute(), MOST_BYTES)
        for each in sorted(path.rglob("*.pos"))
    }
    adjust_files.put_pos(desk, files, path.name, numbering)


def _adjusted(desk: Desk, choices: Choices, say: Callable[[str], object]) -> DeskAdjustment:
    def progress(step: Step) -> None:
        if step.number % SAID_EVERY == 0:
            say(adjust_job.in_words(step))

    try:
        return adjust_solving.solve(desk, choices, progress=progress)
    except KeyboardInterrupt as error:
        raise CommandError("Stopped; the same command goes on from there.") from error


def _lines(found: DeskAdjustment) -> list[str]:
    told: dict[str, Any] = found.report or {}
    lines = [f"result {found.number}: cost {told['cost']:,.1f} after {told['steps']} steps"]
    for camera in told["cameras"]:
        before, after = (_misses(camera[when]) for when in ("before", "after"))
        moved = f"moved {100 * camera['moved']:.1f} cm"
        folds = "" if camera["folding"]["monotone"] else ", the lens folds inside the picture"
        lines.append(f"  {camera['name']:8} {before}  →  {after}, {moved}{folds}")
    hold_out = told["hold_out"]
    if hold_out["points"]:
        lines.append(f"  left out of one view: {hold_out['median_px']:.2f} px median")
    if told["feet"]:
        lines.append(f"  feet: {100 * told['feet']['median']:.1f} cm off the ground")
    return [*lines, *(f"  {notice}" for notice in told["notices"])]


def _misses(misses: dict[str, Any]) -> str:
    if misses["median"] is None:
        return "none"
    return f"{misses['median']:.2f} / {misses['p95']:.1f} / {misses['rms']:.1f} px"
