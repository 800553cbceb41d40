"""Import annotations of other programs as a layer."""

from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.layers.findings import Kind
from gtm_hit.ops.layers.importing import AnnotationSource, import_annotations
from gtm_hit.ops.layers.reading import READERS


class Command(BaseCommand):
    help = (
        "Make a layer of annotation files. Everything is checked first; what does not fit is listed with "
        "file and line, and nothing is imported until it is dealt with or dropped by name."
    )

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("path", type=Path, help="a file, or the folder of formats with several files")
        parser.add_argument("--format", choices=sorted(READERS), required=True)
        parser.add_argument("--layer", default="imported", help="the new layer's name (imported)")
        parser.add_argument("--hidden-layer", action="store_true", help="never show this layer to workers")
        parser.add_argument(
            "--drop",
            type=drop,
            default=(),
            metavar="KIND,KIND",
            help=f"leave these out instead of stopping: {', '.join(Kind)}",
        )

    def handle(self, *, slug: str, path: Path, **options: Any) -> None:
        dataset = dataset_named(slug)
        source = AnnotationSource(
            path.absolute(), options["format"], options["layer"], options["hidden_layer"], options["drop"]
        )
        progress = ProgressLine(self.stderr)
        try:
            report = import_annotations(dataset, source, progress)
        except ImportFailed as error:
            progress.finish()
            for problem in error.problems:
                self.stderr.write(str(problem))
            count = len(error.problems)
            raise CommandError(f"{count} problem{'s' * (count > 1)}; nothing was imported") from error
        progress.finish()
        for kind, rows in report.dropped.items():
            self.stdout.write(f"Dropped ({kind}): {rows}")
        self.stdout.write(
            f"Layer {report.layer.name}: {report.annotations} annotations of {report.people} people "
            f"in {report.frames} frames."
        )


def drop(text: str) -> list[Kind]:
    return [Kind(word) for word in text.split(",") if word]
