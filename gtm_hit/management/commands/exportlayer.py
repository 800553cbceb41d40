from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import layer_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.exports.formats.registry import DEFAULT_FORMATS, FORMATS, chosen


class Command(BaseCommand):
    help = "Write a layer to a folder and a zip beside it, in one or more formats, with a manifest."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("layer", help="the layer's name")
        parser.add_argument("folder", type=Path, help="a new or empty folder, or one with an earlier export")
        parser.add_argument(
            "--format",
            type=lambda text: text.split(","),
            default=DEFAULT_FORMATS,
            metavar="FORMAT,FORMAT",
            dest="formats",
            help=f"{', '.join(FORMATS)} (default: {', '.join(DEFAULT_FORMATS)})",
        )

    def handle(self, *, slug: str, layer: str, folder: Path, formats: list[str], **options: Any) -> None:
        found = layer_named(slug, layer)
        folder = folder.absolute()
        progress = ProgressLine(self.stderr)
        try:
            formats = chosen(formats)
            exporting.require_replaceable(folder)
            partial = folder.with_name(f".{folder.name}.partial")
            manifest = exporting.export_layer(found, folder, partial, progress, formats=formats)
        except (exporting.ExportError, ValueError) as error:
            raise CommandError(str(error)) from error
        except OSError as error:
            raise CommandError(f"{error.filename or folder}: {error.strerror}") from error
        finally:
            progress.finish()
        archive = exporting.archive_of(folder)
        self.stdout.write(
            f"{manifest.counts['frames']} frames, {manifest.counts['annotations']} annotations: {folder}\n"
            f"{archive.stat().st_size:,} bytes, SHA-256 {exporting.sha256(archive)}: {archive}"
        )
