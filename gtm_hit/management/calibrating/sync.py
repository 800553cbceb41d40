"""`calibrate sync`: how far apart the clocks of videos are, as `importvideos` wants to be told."""

from __future__ import annotations

import os
import shlex
from argparse import ArgumentParser, ArgumentTypeError
from collections.abc import Callable
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError

from gtm_hit.formats.files import write_bytes
from gtm_hit.ops.sync.guessing import SECONDS, Guess, SyncRefused, Video, guess
from gtm_hit.ops.sync.state import camera_name

HELP = (
    "Guess the offsets of videos: by WAV files of the same names beside them, else by who walks where on the "
    "ground that calibrated cameras share, else by how much moves in the pictures."
)


def add_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "videos", nargs="+", type=_video, metavar="[CAMERA=]VIDEO", help="camera: else the file's name"
    )
    parser.add_argument("--calibration", type=Path, help="folder of calibrations, or a cameras.json")
    parser.add_argument(
        "--seconds", type=float, default=SECONDS, help=f"of every video to look at ({SECONDS:.0f})"
    )
    parser.add_argument(
        "--output", type=Path, metavar="FILE", help="write what was found, for `importvideos --offsets FILE`"
    )


def run(options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
    calibration = options["calibration"]
    if calibration is not None and not calibration.exists():
        raise CommandError(f"{calibration} is not there")
    if not options["seconds"] > 0:
        raise CommandError("--seconds must be more than 0")
    videos = options["videos"]
    try:
        found = guess(videos, calibration and calibration.absolute(), options["seconds"])
    except SyncRefused as error:
        raise CommandError(str(error)) from error
    if options["output"]:
        _write(options["output"], found, videos)
    _tell(found, videos, say)
    return {**found.as_json(), "importvideos": option_line(found, videos)}


def option_line(found: Guess, videos: list[Video]) -> str:
    """What follows the calibrations in a call of `importvideos`."""
    return " ".join(
        shlex.quote(f"{video.camera}={video.path}@{place.offset:.3f}")
        for video, place in zip(videos, found.places, strict=True)
        if place.offset is not None
    )


def _write(file: Path, found: Guess, videos: list[Video]) -> None:
    """One video a line; what was not found stands there with a word, to be set by hand."""
    folder, lines = file.absolute().parent, [f"# {found.told}"]
    for video, place in zip(videos, found.places, strict=True):
        path = Path(os.path.relpath(video.path.absolute(), folder))
        said = f"{video.camera} = {path} @ "
        lines.append(f"# not found: {said}" if place.offset is None else f"{said}{place.offset:.3f}")
    write_bytes(file, "".join(f"{line}\n" for line in lines).encode())


def _tell(found: Guess, videos: list[Video], say: Callable[[str], object]) -> None:
    say(found.told)
    for place in found.places:
        where = "not found" if place.offset is None else f"{place.offset:8.3f} s, {place.confidence}"
        say(f"  {place.camera}  {where}")
    say(f"For importvideos:\n{option_line(found, videos)}")


def _video(text: str) -> Video:
    name, equals, path = text.partition("=")
    if not equals:
        name, path = camera_name(text), text
    if not name or not path:
        raise ArgumentTypeError(f"{text!r} does not read CAMERA=VIDEO")
    return Video(name, Path(path))
