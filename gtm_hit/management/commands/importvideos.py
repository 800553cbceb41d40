"""Import the frames of videos; a second run continues a first one that was stopped."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError, CommandParser

from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import FormatError
from gtm_hit.management.commands import importdataset
from gtm_hit.management.progress import ProgressLine
from gtm_hit.management.scene_command import SceneCommand
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.datasets.options import PRESETS, ImportOptions
from gtm_hit.ops.datasets.videos.importing import VideoReport, import_videos
from gtm_hit.ops.datasets.videos.options import (
    SourceError,
    VideoOptions,
    VideoSource,
    parse_source,
    parse_sources,
)

MOST_BYTES = 1_000_000


class Command(SceneCommand):
    help = (
        "Take frames from one video per camera and import them. The offset of a video is the second in it at "
        "which the time all videos share is 0; frame n lies n / --rate seconds after that. Everything is "
        "checked first; run again, it continues where it was stopped."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug", help="the dataset's name in addresses, for example plaza")
        parser.add_argument("calibrations", type=Path, help="folder of calibrations, or a cameras.json")
        parser.add_argument(
            "videos", nargs="*", type=source, metavar="CAMERA=FILE@SECONDS", help="video and its offset"
        )
        parser.add_argument(
            "--offsets",
            type=Path,
            metavar="FILE",
            help="instead: such texts, one a line, as `calibrate sync` and `videosync` write them; files are "
            "seen from where FILE lies",
        )
        parser.add_argument("--name", default="", help="the dataset's name in words (default: SLUG)")
        parser.add_argument(
            "--preset", choices=sorted(PRESETS), help="grid, cylinder and numbering of a published dataset"
        )
        times = parser.add_argument_group("which frames")
        times.add_argument("--rate", type=float, metavar="N", help="frame numbers per second (10)")
        times.add_argument("--frame-step", type=int, metavar="N", help="take every N-th frame number (5)")
        times.add_argument("--from", type=float, default=0.0, dest="start", metavar="SECONDS")
        times.add_argument("--until", type=float, default=math.inf, metavar="SECONDS")
        scene = parser.add_argument_group("what the files do not say")
        importdataset.add_scene_values(scene)
        scene.add_argument(
            "--as-taken", action="store_true", help="leave the lens in the pictures (default: take it out)"
        )
        importdataset.add_alpha(scene)

    def handle(self, *args: object, **options: Any) -> None:
        progress = ProgressLine(self.stdout)
        try:
            report = import_videos(read_options(options), progress)
        except ImportFailed as error:
            progress.finish()
            for problem in error.problems:
                self.stderr.write(str(problem))
            count = len(error.problems)
            raise CommandError(f"{count} problem{'s' * (count > 1)}") from error
        progress.finish()
        self.tell(report)

    def tell(self, report: VideoReport) -> None:
        for note in report.notes:
            self.stdout.write(f"Note: {note}.")
        known = f", {report.frames_known} were there already" if report.frames_known else ""
        self.stdout.write(f"{report.frames_added} frames with {report.images_added} images added{known}.")


def source(text: str) -> VideoSource:
    try:
        return parse_source(text)
    except SourceError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def named_videos(options: dict[str, Any]) -> tuple[VideoSource, ...]:
    """From the command line or from a file."""
    file: Path | None = options["offsets"]
    if (file is None) == (not options["videos"]):
        raise CommandError("name the videos, or give --offsets FILE")
    if file is None:
        return tuple(options["videos"])
    try:
        return tuple(parse_sources(read_source(file, MOST_BYTES).decode(), file.absolute().parent))
    except (SourceError, FormatError, UnicodeDecodeError) as error:
        raise CommandError(f"{file}: {error}") from error


def read_options(options: dict[str, Any]) -> VideoOptions:
    values = importdataset.given_values({**options, "frame_rate": options["rate"]})
    calibrations = options["calibrations"].absolute()
    dataset = ImportOptions(
        slug=options["slug"],
        folder=calibrations.parent,
        name=options["name"],
        preset=options["preset"],
        values=values,
        tvec_unit=options["tvec_unit"],
        calibrations=calibrations,
        undistort=not options["as_taken"],
        alpha=options["alpha"],
    )
    return VideoOptions(dataset, named_videos(options), options["start"], options["until"])
