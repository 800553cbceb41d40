from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.lookups import campaign_named, layer_named
from gtm_hit.models import PlantedFault
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.gold import planting, results

KINDS = list(PlantedFault.Kind.values)


class Command(BaseCommand):
    help = (
        "Settle what a campaign's batches start with and which faults are planted; print what became of them."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug")
        parser.add_argument("campaign")
        parser.add_argument("--share", type=float, help="of the batches that get faults, 0 to 1")
        parser.add_argument("--start", help="layer whose people batches start with")
        parser.add_argument("--faults", type=int, default=2, help="in each of them (default: 2)")
        parser.add_argument("--kinds", nargs="+", default=KINDS, help=", ".join(KINDS))
        parser.add_argument("--seed", type=int, default=1)
        parser.add_argument("--stop", action="store_true", help="let batches start empty again")

    def handle(self, *, slug: str, campaign: str, start: str | None, **options: Any) -> None:
        found = campaign_named(slug, campaign)
        if options["stop"]:
            planting.stop(found)
        elif options["share"] is not None:
            layer = layer_named(slug, start) if start else None
            values = {name: options[name] for name in ("share", "faults", "kinds", "seed")}
            try:
                planting.settle(found, layer, **values)
            except OperationError as error:
                raise CommandError(str(error)) from error
        for one in results.fault_results(found):
            numbers = f"{one.planted} planted, {one.judged} submitted, {one.repaired} repaired"
            self.stdout.write(f"{one.kind}: {numbers}")
