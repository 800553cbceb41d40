from __future__ import annotations

import json
from argparse import ArgumentParser
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import dataset_named
from gtm_hit.models import Release
from gtm_hit.ops.releases import releasing


class Command(BaseCommand):
    help = "List a dataset's releases, the newest first, and where their files are."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("number", type=int, nargs="?", help="only this one")
        parser.add_argument("--json", action="store_true", help="print one object per release and line")
        parser.add_argument(
            "--print", choices=releasing.PARTS, dest="part", help="print this file of the release NUMBER"
        )

    def handle(self, *, slug: str, number: int | None, part: str | None, **options: Any) -> None:
        dataset = dataset_named(slug)
        found = releasing.releases(dataset)
        if number is not None:
            found = found.filter(number=number)
            if not found:
                raise CommandError(f"{slug} has no release {number}")
        if part:
            return self.print_part(found[0] if number is not None else None, part)
        for release in found:
            numbers = facts(release)
            self.stdout.write(json.dumps(numbers) if options["json"] else line(numbers))

    def print_part(self, release: Release | None, part: str) -> None:
        if release is None:
            raise CommandError("--print takes the NUMBER of a release")
        if releasing.part_of(release, part) is None:
            raise CommandError(f"{part} of release {release.number} is not on this machine")
        self.stdout.write(releasing.text_of(release, part), ending="")


def facts(release: Any) -> dict[str, Any]:
    """Of a row of `ops.releases.releases`."""
    return {
        "number": release.number,
        "title": release.title,
        "layer": release.layer.name,
        "calibration": release.calibration.number if release.calibration else None,
        "counts": release.counts,
        "manifest_digest": release.manifest_digest,
        "created_at": release.created_at.isoformat(),
        "archive": str(releasing.archive_of(release)),
    }


def line(numbers: dict[str, Any]) -> str:
    counts = numbers["counts"]
    return (
        f"{numbers['number']:4}  {numbers['created_at'][:10]}  {numbers['layer']:<20} "
        f"{counts['frames']} frames, {counts['annotations']} annotations  {numbers['archive']}  "
        f"{numbers['title']}"
    ).rstrip()
