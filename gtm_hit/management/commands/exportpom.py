from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.formats.pom import PomHeader, write_pom
from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.ops.ground.coverage import table


class Command(BaseCommand):
    help = "Write a dataset's rectangles, all positions in all cameras, as a POM file."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument(
            "file", type=Path, help="for example rectangles.pom; an existing file is replaced"
        )

    def handle(self, *, slug: str, file: Path, **options: Any) -> None:
        dataset = dataset_named(slug)
        progress = ProgressLine(self.stderr)
        rectangles = table(dataset, lambda done, total: progress("rectangle table", done, total))
        header = PomHeader(dataset.grid, dataset.cylinder, rectangles.cameras_count)
        try:
            write_pom(file, header, rectangles, lambda done, total: progress("writing lines", done, total))
        except OSError as error:
            raise CommandError(f"{error.filename or file}: {error.strerror}") from error
        finally:
            progress.finish()
        self.stdout.write(f"{rectangles.cameras_count} cameras × {dataset.grid.count} positions: {file}")
