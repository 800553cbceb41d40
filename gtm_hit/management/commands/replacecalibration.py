"""Compare a dataset's boxes under another calibration, and put that in place on request."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import Camera
from gtm_hit.management.calibrating import versions as telling
from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.models import Dataset
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.calibration.cameras import UNITS
from gtm_hit.ops.calibration.differences import NotComparable, content, difference
from gtm_hit.ops.calibration.reading import file_report, read_replacement
from gtm_hit.ops.calibration.replacing import ReplacementError, preview, replace_calibration
from gtm_hit.ops.calibration.sides import Side, UnknownSide, side
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.jobs.progress import no_progress

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
            "--show", type=int, metavar="N", help="only tell where one is from and what was made under it"
        )
        parser.add_argument(
            "--compare",
            nargs=2,
            metavar=("A", "B"),
            help="only tell how two differ, on the ground as well: each a number, desk:NAME, job:NUMBER, "
            "a cameras.json or a folder",
        )
        parser.add_argument("--json", action="store_true", help="with --compare: as JSON, with the map")
        parser.add_argument(
            "--tvec-unit", choices=sorted(UNITS), default="m", help="unit of tvec in the extrinsic files (m)"
        )
        parser.add_argument("--confirm", action="store_true", help="put the new calibration in place")

    def handle(self, *args: object, **options: Any) -> None:
        dataset = dataset_named(options["slug"])
        if options["list"]:
            self.tell_versions(dataset)
            return
        if options["show"] is not None:
            self.tell_version(dataset, options["show"])
            return
        if options["compare"]:
            self.compare(dataset, options)
            return
        cameras, source, report = self.wanted(dataset, options)
        progress = ProgressLine(self.stdout)
        seen = preview(dataset, cameras, progress)
        progress.finish()
        self.tell(seen)
        if not options["confirm"]:
            self.stdout.write("Nothing was changed; --confirm puts the new calibration in place.")
            return
        try:
            placed = replace_calibration(dataset, cameras, seen, source, report=report)
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

    def tell_version(self, dataset: Dataset, number: int) -> None:
        try:
            found = versions.version(dataset, number)
        except versions.UnknownVersion as error:
            raise CommandError(str(error)) from error
        for line in telling.shown(found, found.pk == dataset.calibration_id):
            self.stdout.write(line)

    def compare(self, dataset: Dataset, options: dict[str, Any]) -> None:
        before, after = (self.side(dataset, key, options["tvec_unit"]) for key in options["compare"])
        line = ProgressLine(self.stdout)
        try:
            found = difference(dataset, before, after, None, no_progress if options["json"] else line)
        except NotComparable as error:
            raise CommandError(str(error)) from error
        line.finish()
        if options["json"]:
            self.stdout.write(json.dumps(content(found)))
            return
        for told in telling.differing(found):
            self.stdout.write(told)

    def side(self, dataset: Dataset, key: str, unit: str) -> Side:
        path = Path(key)
        try:
            if path.exists() and not key.isdecimal():
                return Side(key, path.name, self.read(dataset, path, unit))
            return side(dataset, key)
        except (UnknownSide, versions.UnknownVersion, DeskError) as error:
            raise CommandError(str(error)) from error

    def wanted(
        self, dataset: Dataset, options: dict[str, Any]
    ) -> tuple[Sequence[Camera], str, dict[str, Any]]:
        """The cameras to compare with, where they come from, and what is to be kept of that."""
        path, number = options["calibration"], options["number"]
        if (path is None) == (number is None):
            raise CommandError("Give either a calibration or --number.")
        try:
            if number is not None:
                found = versions.version(dataset, number)
                return versions.cameras_in(found), versions.gone_back(number), {}
        except versions.UnknownVersion as error:
            raise CommandError(str(error)) from error
        unit = options["tvec_unit"]
        cameras = self.read(dataset, path, unit)
        report = file_report(path.name, [path.read_bytes()], unit) if path.is_file() else {}
        return cameras, path.name, report

    def read(self, dataset: Dataset, path: Path, unit: str) -> list[Camera]:
        try:
            return read_replacement(dataset, path.absolute(), unit)
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
