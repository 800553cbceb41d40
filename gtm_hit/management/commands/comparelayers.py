from __future__ import annotations

import json
from argparse import ArgumentParser
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import layer_named
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.ops.quality.comparing import Scope, as_numbers, compare, frame_lines
from gtm_hit.ops.quality.layer_rows import QualityError

WORST_SHOWN = 10


class Command(BaseCommand):
    help = "Compare a layer with another that is taken for the truth: people found, and identities kept."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("truth", help="the layer that is right")
        parser.add_argument("found", help="the layer that is judged")
        parser.add_argument(
            "--radius", type=float, default=RADIUS, help="only pairs closer than this are matched, metres"
        )
        parser.add_argument(
            "--frames",
            choices=[scope.value for scope in Scope],
            default=Scope.BOTH.value,
            help="frames that both layers have, or that either has",
        )
        parser.add_argument("--json", action="store_true", help="print one object, with every frame")

    def handle(self, *, slug: str, truth: str, found: str, **options: Any) -> None:
        sides = layer_named(slug, truth), layer_named(slug, found)
        try:
            result = compare(*sides, radius=options["radius"], scope=Scope(options["frames"]))
        except QualityError as error:
            raise CommandError(str(error)) from error
        numbers, frames = as_numbers(result), frame_lines(result)
        if options["json"]:
            self.stdout.write(json.dumps(numbers | {"worst_frames": frames}))
            return
        numbers.pop("curve")
        lines = [f"{name:<20} {_shown(value)}" for name, value in numbers.items()]
        lines += ["", "worst frames         missed  extra  swapped"]
        lines += [
            f"{line['frame']:08d}             {line['missed']:6d} {line['extra']:6d}  {line['swapped']:7d}"
            for line in frames[:WORST_SHOWN]
        ]
        self.stdout.write("\n".join(lines))


def _shown(value: float | int | None) -> str:
    if value is None:
        return "not defined"
    return str(value) if isinstance(value, int) else f"{value:.4f}"
