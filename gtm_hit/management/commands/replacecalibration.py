"""Compare a dataset's boxes under another calibration, and put that in place on request."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import Camera
from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.models import Dataset
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.calibration.cameras import UNITS
from gtm_hit.ops.calibration.reading import read_replacement
from gtm_hit.ops.calibration.replacing import ReplacementError, preview, replace_calibration

HEADER = (
    f"{'camera':10}{'boxes':>10}{'moved':>10}{'median':>8}{'95 %':>8}{'most':>8}{'appear':>10}{'vanish':>10}"
)


class Command(BaseCommand):
    help = (
        "Tell by how many pixels boxes move under another calibration. Annotations keep their positions. "
        "Nothing is changed without --confirm; what was in place before keeps its number, see --list."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug", help="the dataset's name in addresses")
        parser.add_argument(
            "calibration", type=Path, nargs="?", help="a cameras.json or a folder of calibrations"
        )
        parser.add_argument(
            "--number",
            type=int,
            metavar="N",
            help="instead of a file: a calibration the dataset had before",
        )
        parser.add_argument("--list", action="store_true", help="only list the calibrations there were")
        parser.add_argument(
            "--tvec-unit", choices=sorted(UNITS), default="m", help="unit of tvec in the extrinsic files (m)"
        )
        parser.add_argument("--confirm", action="store_true", help="put the new calibration in place")

    def handle(self, *args: object, **options: Any) -> None:
        dataset = dataset_named(options["slug"])
        if options["list"]:
            self.tell_versions(dataset)
            return
        cameras, source = self.wanted(dataset, options)
        progress = ProgressLine(self.stdout)
        seen = preview(dataset, cameras, progress)
        progress.finish()
        self.tell(seen)
        if not options["confirm"]:
            self.stdout.write("Nothing was changed; --confirm puts the new calibration in place.")
            return
        try:
            placed = replace_calibration(dataset, cameras, seen, source)
        except ReplacementError as error:
            raise CommandError(str(error)) from error
        self.stdout.write(f"The new calibration is in place as number {placed.number}.")
        self.stdout.write(f"manage.py drift {dataset.slug} --remember keeps marks by which drift is seen.")

    def tell_versions(self, dataset: Dataset) -> None:
        for each in versions.versions(dataset):
            mark = "*" if each.pk == dataset.calibration_id else " "
            who = f"  by {each.created_by}" if each.created_by else ""
            made = f"{each.created_at:%Y-%m-%d %H:%M}"
            self.stdout.write(f"{mark}{each.number:4}  {made}  {each.digest[:12]}  {each.source}{who}")

    def wanted(self, dataset: Dataset, options: dict[str, Any]) -> tuple[Sequence[Camera], str]:
        """The cameras to compare with, and where they come from."""
        path, number = options["calibration"], options["number"]
        if (path is None) == (number is None):
            raise CommandError("Give either a calibration or --number.")
        try:
            if number is not None:
                found = versions.version(dataset, number)
                return versions.cameras_in(found), found.source
            return read_replacement(dataset, path.absolute(), options["tvec_unit"]), path.name
        except versions.UnknownVersion as error:
            raise CommandError(str(error)) from error
        except FormatError as error:
            for problem in error.problems:
                self.stderr.write(str(problem))
            count = len(error.problems)
            raise CommandError(f"{count} problem{'s' * (count > 1)}; nothing was changed") from error

    def tell(self, seen: dict[str, Any]) -> None:
        self.stdout.write(f"{seen['annotations']} annotations; distances in pixels")
        self.stdout.write(HEADER)
        for each in seen["cameras"]:
            self.stdout.write(
                f"{each['name']:10}{each['compared']:10}{each['moved']:10}{each['median']:8.0f}"
                f"{each['p95']:8.0f}{each['max']:8.0f}{each['appeared']:10}{each['vanished']:10}"
            )
