from __future__ import annotations

import json
from argparse import ArgumentParser
from dataclasses import asdict
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import layer_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.proposals import snapping


class Command(BaseCommand):
    help = (
        "Put everybody of a layer where the boxes and the foreground that the run in use has kept show them, "
        "by half a metre at most. Every frame that changes is a save, which its history can take back."
    )

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("layer", help="the layer's name")
        parser.add_argument("--json", action="store_true", help="print one object")

    def handle(self, *, slug: str, layer: str, **options: Any) -> None:
        found = layer_named(slug, layer)
        progress = ProgressLine(self.stderr)
        try:
            done = snapping.snap_layer(found, None, progress)
        except OperationError as error:
            raise CommandError(str(error)) from error
        finally:
            progress.finish()
        if options["json"]:
            return self.stdout.write(json.dumps(asdict(done)))
        moved = f"{done.moved} of {done.people} people moved, by {100 * done.metres:.1f} cm on average"
        self.stdout.write(f"{moved}, in {done.frames} frames")
        if done.unseen:
            self.stdout.write(f"{done.unseen} of them the run in use has not looked at: nobody moves there")
        if done.boxes_alone:
            self.stdout.write(
                f"{done.boxes_alone} of them went by boxes alone, for the run has kept no foreground: "
                "a new run keeps it"
            )
