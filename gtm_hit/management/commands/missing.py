from __future__ import annotations

import json
from argparse import ArgumentParser
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import layer_named
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.proposals import missing

SHOWN = 30


class Command(BaseCommand):
    help = "List who is missing in a layer or should not be there, the likeliest first; or decide about one."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("layer", help="the layer's name")
        parser.add_argument("--start", type=int, default=0, metavar="N", help="first frame number to look at")
        parser.add_argument(
            "--most", type=int, default=SHOWN, metavar="N", help="how many to list (%(default)s)"
        )
        parser.add_argument("--json", action="store_true", help="print one object, with every place")
        decision = parser.add_mutually_exclusive_group()
        for name, text in (("place", "mark somebody there"), ("nobody", "it was looked at: nobody is there")):
            decision.add_argument(f"--{name}", nargs=2, type=int, metavar=("FRAME", "POSITION"), help=text)
        parser.add_argument("--person", type=int, help="whom to mark with --place (default: somebody new)")

    def handle(self, *, slug: str, layer: str, **options: Any) -> None:
        found = layer_named(slug, layer)
        try:
            if options["place"]:
                frame, position = options["place"]
                person = missing.place(found, frame, position, options["person"], None)
                return self.stdout.write(f"person {person} placed")
            if options["nobody"]:
                frame, position = options["nobody"]
                missing.dismiss(found, frame, position, None)
                return self.stdout.write("remembered")
            report = missing.missing(found, options["start"])
        except OperationError as error:
            raise CommandError(str(error)) from error
        if options["json"]:
            places = [place.as_dict() for place in report.places]
            told = {"frames": report.frames, "later": report.later, "places": places}
            return self.stdout.write(json.dumps(told))
        self.stdout.write(f"{len(report.places)} places in {report.frames} frames")
        if report.run is None:
            self.stdout.write("nothing is proposed for this dataset: only people with holes are found")
        for place in report.places[: max(options["most"], 0)]:
            self.stdout.write(f"{place.frame:08d}  {place.position:8d}  {place.weight:4.2f}  {place.words}")
        return None
