"""Make the demo scene; on a second run it is there already."""

from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.progress import ProgressLine
from gtm_hit.ops.datasets.demo import make_demo, open_campaign
from gtm_hit.ops.errors import OperationError


class Command(BaseCommand):
    help = (
        "Render the demo scene (seven views of a plaza with people), import it with its truth in a hidden "
        "layer, and cut it into batches."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("--slug", default="demo", help="the dataset's name in addresses (default: demo)")
        parser.add_argument("--frames", type=int, default=None, help="annotated frames (default: 20)")
        parser.add_argument("--seed", type=int, default=None, help="another seed gives other people")
        parser.add_argument("--campaign", action="store_true", help="open a campaign of it for the own team")

    def handle(
        self,
        *args: Any,
        slug: str,
        frames: int | None,
        seed: int | None,
        campaign: bool,
        **options: Any,
    ) -> None:
        progress = ProgressLine(self.stdout)
        try:
            demo = make_demo(slug, frames, seed, progress)
            opened = open_campaign(demo) if campaign else None
        except OperationError as error:
            progress.finish()
            raise CommandError(str(error)) from error
        progress.finish()
        state = "made" if demo.frames_added else "was there already"
        self.stdout.write(
            f"Demo scene {slug} {state}: {demo.dataset.frames.count()} frames, "
            f"{demo.dataset.batches.filter(campaign=None).count()} batches."
        )
        if opened:
            self.stdout.write(f"Campaign {opened.name}: {opened.get_state_display()}.")
