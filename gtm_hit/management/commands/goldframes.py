from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.lookups import campaign_named, layer_named
from gtm_hit.models import Campaign
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.gold import frames, results


class Command(BaseCommand):
    help = "Choose which frames of a campaign are gold; without a layer, print how they came out."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug")
        parser.add_argument("campaign")
        parser.add_argument("--layer", help="the layer with the truth")
        parser.add_argument("--share", type=float, default=0.1, help="of the frames it knows (default: 0.1)")
        parser.add_argument("--seed", type=int, default=1)

    def handle(self, *, slug: str, campaign: str, layer: str | None, **options: Any) -> None:
        found = campaign_named(slug, campaign)
        if layer:
            try:
                frames.choose(found, layer_named(slug, layer), options["share"], options["seed"])
            except OperationError as error:
                raise CommandError(str(error)) from error
        self.tell(found)

    def tell(self, campaign: Campaign) -> None:
        gold = results.gold_result(campaign)
        self.stdout.write(f"{campaign}: {gold.frames} gold frames, annotated {gold.judged} times")
        if gold.truth:
            self.stdout.write(
                f"  {gold.truth} people: {gold.found:.0f} found, {gold.placed:.0f} of them within 15 cm; "
                f"{gold.extra:.0f} invented"
            )
