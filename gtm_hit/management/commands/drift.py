from __future__ import annotations

import json
import re
from argparse import ArgumentParser, ArgumentTypeError
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.models import Dataset, DriftCheck
from gtm_hit.ops.drift import checking, remembering
from gtm_hit.ops.drift.pictures import DriftRefused, Span


class Command(BaseCommand):
    help = (
        "Tell whether the cameras of a dataset still stand as they were calibrated: marks remembered with "
        "--remember are looked for in other frames."
    )

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument(
            "--frames",
            type=_range,
            default=(None, None),
            metavar="A-B",
            help="only frames with these numbers",
        )
        parser.add_argument("--every", type=int, default=1, metavar="N", help="only every n-th of them")
        parser.add_argument(
            "--remember", action="store_true", help="take marks from these frames instead of comparing"
        )
        parser.add_argument("--json", action="store_true", help="print one object")

    def handle(self, *, slug: str, **options: Any) -> None:
        dataset, span = dataset_named(slug), _span(options)
        progress = ProgressLine(self.stderr)
        try:
            if options["remember"]:
                told = self.remember(dataset, span, progress)
            else:
                told = self.compare(dataset, span, progress)
        except DriftRefused as error:
            raise CommandError(str(error)) from error
        if options["json"]:
            self.stdout.write(json.dumps(told, allow_nan=False))
            return
        for line in told["lines"]:
            self.stdout.write(line)

    def remember(self, dataset: Dataset, span: Span, progress: ProgressLine) -> dict[str, Any]:
        rows = remembering.remember(dataset, span, progress)
        progress.finish()
        return {
            "marks": {row.camera.name: row.count for row in rows},
            "lines": [f"{row.camera.name}: {row.count} marks from {len(row.frames)} frames" for row in rows],
        }

    def compare(self, dataset: Dataset, span: Span, progress: ProgressLine) -> dict[str, Any]:
        found: DriftCheck = checking.check_frames(dataset, span, progress)
        progress.finish()
        return {
            "check": found.pk,
            "frames": found.frames,
            "warns": found.warns,
            "cameras": found.cameras,
            "lines": [camera["verdict"] for camera in found.cameras],
        }


def _span(options: dict[str, Any]) -> Span:
    first, last = options["frames"]
    return Span(first, last, options["every"])


def _range(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,9})-(\d{1,9})", text)
    if not found or int(found[1]) > int(found[2]):
        raise ArgumentTypeError(f"{text} is no range such as 0-200")
    return int(found[1]), int(found[2])
