from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import layer_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.exports.formats.registry import FORMATS
from gtm_hit.ops.releases import releasing


class Command(BaseCommand):
    help = "Release a layer: a numbered export with provenance, changes, licence and statistics."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("layer", help="the layer's name")
        parser.add_argument("--title", default="", help="a few words for the list of releases")
        parser.add_argument("--licence", type=Path, required=True, metavar="FILE", help="text of the licence")
        parser.add_argument(
            "--format",
            type=lambda text: text.split(","),
            default=releasing.FORMATS,
            metavar="FORMAT,FORMAT",
            dest="formats",
            help=f"{', '.join(FORMATS)} (default: {', '.join(releasing.FORMATS)})",
        )

    def handle(self, *, slug: str, layer: str, licence: Path, **options: Any) -> None:
        found = layer_named(slug, layer)
        progress = ProgressLine(self.stderr)
        try:
            text = licence.read_text(encoding="utf-8")
            order = releasing.Order(found, text, options["title"], options["formats"])
            partial = settings.RELEASES_ROOT / slug / ".partial"
            release = releasing.make_release(order, partial, progress)
        except exporting.ExportError as error:
            raise CommandError(str(error)) from error
        except UnicodeDecodeError as error:
            raise CommandError(f"{licence} is no text in UTF-8") from error
        except OSError as error:
            raise CommandError(f"{error.filename}: {error.strerror}") from error
        finally:
            progress.finish()
        counts = release.manifest["counts"]
        self.stdout.write(
            f"Release {release.number}: {counts['frames']} frames, {counts['annotations']} annotations: "
            f"{releasing.folder_of(release)}\nSHA-256 of manifest.json {release.manifest_digest}"
        )
