from __future__ import annotations

import json
from argparse import ArgumentParser
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.formats.problems import FormatError
from gtm_hit.metrics.annotations import MetricsError
from gtm_hit.metrics.limits import TooManyPeople
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.ops.quality.text_files import SCORES, Question, evaluate


class Command(BaseCommand):
    help = (
        "Compare detections with ground truth, both text files with one `frame column row` line per person. "
        "A frame that only one of the files has counts as well: its people are all missed, or all extra."
    )
    # Only the two files matter; a site half set up must not keep anybody from comparing them.
    requires_system_checks: list[str] = []

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("truth", type=Path, metavar="GT.txt")
        parser.add_argument("found", type=Path, metavar="DETECTIONS.txt")
        parser.add_argument("--step", type=float, required=True, help="metres between neighbouring positions")
        parser.add_argument(
            "--radius", type=float, default=RADIUS, help="only pairs closer than this are matched, metres"
        )
        parser.add_argument("--json", action="store_true", help="print one object, scores as fractions")
        parser.add_argument(
            "--identities",
            action="store_true",
            help="lines are `frame column row person`; compare the identities as well",
        )
        parser.add_argument("--curve", action="store_true", help="add the scores at radii from 5 cm to 1 m")

    def handle(self, *args: Any, **options: Any) -> None:
        names = ("truth", "found", "step", "radius", "identities", "curve")
        try:
            result = evaluate(Question(**{name: options[name] for name in names}))
        except TooManyPeople as error:
            raise CommandError(str(error)) from error
        except MetricsError as error:
            raise CommandError(f"--{error}") from error
        except FormatError as error:
            lines = ["nothing was compared:", *map(str, error.problems)]
            raise CommandError("\n".join(lines)) from error
        self.stdout.write(json.dumps(result) if options["json"] else "\n".join(_lines(result)))


def _lines(result: dict[str, Any]) -> Iterator[str]:
    curve = result.pop("curve", [])
    yield from (f"{name:<14} {_shown(value)}" for name, value in result.items())
    if curve:
        yield ""
        yield "".join(f"{name:>12}" for name in SCORES)
        yield from ("".join(f"{_shown(each[name]):>12}" for name in SCORES) for each in curve)


def _shown(value: float | int | None) -> str:
    if value is None:
        return "not defined"
    return str(value) if isinstance(value, int) else f"{value:.4f}"
