"""Compare a dataset's boxes under another calibration, and put that in place on request."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.formats.problems import FormatError
from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.ops.calibration.reading import read_replacement
from gtm_hit.ops.calibration.replacing import preview, replace_calibration
from gtm_hit.ops.importing.calibrations import UNITS

HEADER = (
    f"{'camera':10}{'boxes':>10}{'moved':>10}{'median':>8}{'95 %':>8}{'most':>8}{'appear':>10}{'vanish':>10}"
)


class Command(BaseCommand):
    help = (
        "Tell by how many pixels boxes move under another calibration. Annotations keep their positions. "
        "Nothing is changed without --confirm."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug", help="the dataset's name in addresses")
        parser.add_argument("calibration", type=Path, help="a cameras.json or a folder of calibrations")
        parser.add_argument(
            "--tvec-unit", choices=sorted(UNITS), default="m", help="unit of tvec in the extrinsic files (m)"
        )
        parser.add_argument("--confirm", action="store_true", help="put the new calibration in place")

    def handle(self, *args: object, **options: Any) -> None:
        dataset = dataset_named(options["slug"])
        try:
            cameras = read_replacement(dataset, options["calibration"].absolute(), options["tvec_unit"])
        except FormatError as error:
            for problem in error.problems:
                self.stderr.write(str(problem))
            count = len(error.problems)
            raise CommandError(f"{count} problem{'s' * (count > 1)}; nothing was changed") from error
        progress = ProgressLine(self.stdout)
        seen = preview(dataset, cameras, progress)
        progress.finish()
        self.tell(seen)
        if options["confirm"]:
            replace_calibration(dataset, cameras, seen)
            self.stdout.write("The new calibration is in place.")
        else:
            self.stdout.write("Nothing was changed; --confirm puts the new calibration in place.")

    def tell(self, seen: dict[str, Any]) -> None:
        self.stdout.write(f"{seen['annotations']} annotations; distances in pixels")
        self.stdout.write(HEADER)
        for each in seen["cameras"]:
            self.stdout.write(
                f"{each['name']:10}{each['compared']:10}{each['moved']:10}{each['median']:8.0f}"
                f"{each['p95']:8.0f}{each['max']:8.0f}{each['appeared']:10}{each['vanished']:10}"
            )
