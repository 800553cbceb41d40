from __future__ import annotations

import json
from typing import Any

from django.core.management.base import BaseCommand, CommandParser

from gtm_hit.management.calibrating import adjust, board, check, drift, export, ground, lens, sync, undistort
from gtm_hit.management.calibrating.step import Step

STEPS: dict[str, Step] = {
    "lens": lens,
    "board": board,
    "ground": ground,
    "adjust": adjust,
    "check": check,
    "drift": drift,
    "undistort": undistort,
    "export": export,
    "sync": sync,
}


class Command(BaseCommand):
    help = "Calibrate cameras from files, step by step; needs neither a dataset nor a database."
    requires_system_checks = ()

    def add_arguments(self, parser: CommandParser) -> None:
        steps = parser.add_subparsers(dest="step", required=True, metavar="STEP")
        for name, step in STEPS.items():
            sub = steps.add_parser(name, help=step.HELP, description=step.HELP)
            step.add_arguments(sub)
            sub.add_argument("--json", action="store_true", help="print the result as one JSON object")

    def handle(self, *args: Any, step: str, **options: Any) -> None:
        as_json = options["json"]
        say = self.stderr.write if as_json else self.stdout.write
        found = STEPS[step].run(options, say)
        if as_json:
            self.stdout.write(json.dumps(found, allow_nan=False))
