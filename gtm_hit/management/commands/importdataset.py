"""Import a dataset's folder; a second run adds what is new."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from django.core.management.base import CommandError, CommandParser

from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.management.progress import ProgressLine
from gtm_hit.management.scene_command import SceneCommand
from gtm_hit.ops.calibration.cameras import UNITS
from gtm_hit.ops.datasets.importing import ImportFailed, ImportReport, import_dataset
from gtm_hit.ops.datasets.options import PRESETS, ImportOptions, SceneValues
from gtm_hit.ops.files import sources

Number = TypeVar("Number", int, float)


class Command(SceneCommand):
    help = (
        "Import a folder, or a zip, in the layout of WILDTRACK or MultiviewX. Everything is checked first; "
        "on any error nothing is imported. A second run adds only frames and annotation files that are new."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug", help="the dataset's name in addresses, for example wildtrack")
        parser.add_argument("folder", type=Path, help="the dataset's folder, or a zip of it")
        parser.add_argument("--name", default="", help="the dataset's name in words (default: SLUG)")
        parser.add_argument(
            "--preset", choices=sorted(PRESETS), help="grid, cylinder and numbering of a published dataset"
        )
        add_places(parser.add_argument_group("where the files are"))
        add_scene(parser.add_argument_group("what the files do not say"))
        add_layer(parser.add_argument_group("annotations"))

    def handle(self, *args: object, **options: Any) -> None:
        progress = ProgressLine(self.stdout)
        unpacking = partial(progress, "unpacking, MB")
        try:
            with sources.extracted(options["folder"].absolute(), unpacking) as folder:
                report = import_dataset(read_options({**options, "folder": folder}), progress)
        except (ImportFailed, FormatError) as error:
            progress.finish()
            for problem in error.problems:
                self.stderr.write(str(problem))
            count = len(error.problems)
            raise CommandError(f"{count} problem{'s' * (count > 1)}; nothing was imported") from error
        progress.finish()
        self.tell(report)

    def tell(self, report: ImportReport) -> None:
        for note in report.notes:
            self.stdout.write(f"Note: {note}.")
        self.stdout.write(
            f"{report.dataset.slug}: {report.frames_added} frames with {report.images_added} images added, "
            f"{report.dataset.frames.count()} frames in all."
        )
        if report.layer is not None:
            self.stdout.write(
                f"Layer {report.layer.name}: {report.people_added} people "
                f"in {report.annotated_frames_added} frames added."
            )


def add_places(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--images", type=Path, help="folder with a folder or an image per camera (default: Image_subsets)"
    )
    group.add_argument("--calibrations", type=Path, help="folder, or a cameras.json (default: calibrations)")
    group.add_argument("--annotations", type=Path, help="default: annotations_positions")


def add_scene(group: argparse._ArgumentGroup) -> None:
    add_scene_values(group)
    group.add_argument("--frame-rate", type=float, metavar="N", help="frame numbers per second")
    group.add_argument("--frame-step", type=int, metavar="N", help="import every N-th frame number")
    group.add_argument(
        "--keep-all-frames", action="store_true", help="import the frame numbers between the steps too"
    )
    group.add_argument(
        "--undistort", action="store_true", help="take the lens out of the images, by intrinsic_original"
    )
    add_alpha(group)


def add_alpha(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--alpha",
        type=float,
        metavar="0…1",
        help="without lens, 0: no pixel stays black, 1: nothing seen is lost (the files' camera matrix)",
    )


def add_scene_values(group: argparse._ArgumentGroup) -> None:
    group.add_argument("--tvec-unit", choices=sorted(UNITS), help="unit of tvec in the extrinsic files")
    group.add_argument("--grid", type=pair(int, "x"), metavar="COLUMNSxROWS", help="positions along X and Y")
    group.add_argument("--step", type=float, metavar="METRES", help="between neighbouring positions")
    group.add_argument("--origin", type=pair(float, ","), metavar="X,Y", help="metres, of position 0")
    group.add_argument(
        "--cylinder", type=pair(float, ","), metavar="R,H", help="radius and height, metres (0.16,1.8)"
    )
    group.add_argument("--foot-rule", choices=[rule.value for rule in FootRule])


def add_layer(group: argparse._ArgumentGroup) -> None:
    group.add_argument("--annotation-offset", type=int, metavar="N", help="file number minus frame number")
    group.add_argument("--annotation-digits", type=int, metavar="N", help="digits in file names")
    group.add_argument("--layer", default="imported", help="layer the annotations go into (imported)")
    group.add_argument("--hidden-layer", action="store_true", help="never show this layer to workers")


def read_options(options: dict[str, Any]) -> ImportOptions:
    return ImportOptions(
        slug=options["slug"],
        folder=options["folder"].absolute(),
        name=options["name"],
        preset=options["preset"],
        values=given_values(options),
        tvec_unit=options["tvec_unit"],
        images=given_folder(options["images"]),
        calibrations=given_folder(options["calibrations"]),
        annotations=given_folder(options["annotations"]),
        undistort=options["undistort"],
        alpha=options["alpha"],
        layer=options["layer"],
        hidden_layer=options["hidden_layer"],
        keep_all_frames=options["keep_all_frames"],
    )


def given_values(options: dict[str, Any]) -> SceneValues:
    """Only what was said on the command line."""
    columns, rows = options["grid"] or (None, None)
    origin_x, origin_y = options["origin"] or (None, None)
    radius, height = options["cylinder"] or (None, None)
    values = {
        "columns": columns,
        "rows": rows,
        "step": options["step"],
        "origin_x": origin_x,
        "origin_y": origin_y,
        "cylinder_radius": radius,
        "cylinder_height": height,
        "foot_rule": options["foot_rule"],
        "frame_rate": options["frame_rate"],
        "frame_step": options["frame_step"],
        "annotation_offset": options.get("annotation_offset"),
        "annotation_digits": options.get("annotation_digits"),
    }
    return SceneValues(**{name: value for name, value in values.items() if value is not None})  # type: ignore[typeddict-item]


def given_folder(path: Path | None) -> Path | None:
    """As a shell completes it, seen from here; else seen from the dataset's folder."""
    return path.absolute() if path is not None and path.exists() else path


def pair(number: Callable[[str], Number], separator: str) -> Callable[[str], tuple[Number, Number]]:
    def parse(text: str) -> tuple[Number, Number]:
        try:
            first, second = text.lower().split(separator)
            return number(first), number(second)
        except ValueError:
            reason = f"{text!r} is not two numbers joined by {separator!r}"
            raise argparse.ArgumentTypeError(reason) from None

    return parse
