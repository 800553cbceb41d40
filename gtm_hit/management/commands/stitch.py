from __future__ import annotations

import json
from argparse import ArgumentParser
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.models import StitchConflict
from gtm_hit.ops.jobs.progress import no_progress
from gtm_hit.ops.stitching.running import Asked, stitch_layer
from gtm_hit.ops.stitching.scope import StitchingError, named


class Command(BaseCommand):
    help = "Make one ground-truth layer of accepted batches; again: change only what changed."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("--campaign", default="", help="its batches; without: those of no campaign")
        parser.add_argument("--gate", type=float, default=Asked.gate, help="metres, in common frames")
        parser.add_argument("--gap", type=int, default=Asked.gap, help="frames somebody may be missing")
        parser.add_argument(
            "--margin", type=float, default=Asked.margin, help="log odds below which people are asked"
        )
        parser.add_argument("--return-seconds", type=float, default=Asked.return_seconds)
        parser.add_argument("--return-reach", type=float, default=Asked.return_reach, help="metres")
        parser.add_argument("--json", action="store_true", help="print one object")

    def handle(self, *, slug: str, campaign: str, json: bool, **options: Any) -> None:
        dataset = dataset_named(slug)
        progress = ProgressLine(self.stderr)
        asked = Asked(**{name: options[name] for name in vars(Asked())})
        try:
            scope = named(dataset, campaign)
            made = stitch_layer(scope, asked, None, no_progress if json else progress)
        except StitchingError as error:
            raise CommandError(str(error)) from error
        finally:
            progress.finish()
        conflicts = StitchConflict.objects.filter(stitching=made.stitching, state=StitchConflict.State.OPEN)
        layer, waiting = made.stitching.layer.name, conflicts.count()
        if json:
            self.stdout.write(_json({"layer": layer, "open_conflicts": waiting, **made.numbers}))
            return
        found = made.numbers
        self.stdout.write(
            f"{layer}: {found['people']} people in {found['annotations']} annotations of {found['batches']} "
            f"batches; {found['frames_changed']} frames changed, {found['frames_same']} stayed; "
            f"{waiting} conflicts wait for a decision"
        )


def _json(found: dict[str, Any]) -> str:
    return json.dumps(found)
