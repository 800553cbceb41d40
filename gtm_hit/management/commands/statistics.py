from __future__ import annotations

import json
from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.formats.files import write_bytes
from gtm_hit.management.lookups import layer_named
from gtm_hit.ops.quality.statistics.figures import FIGURES
from gtm_hit.ops.quality.statistics.files import PICTURES, numbers_csv
from gtm_hit.ops.quality.statistics.measuring import (
    EVERY,
    ground_coverage,
    layer_statistics,
    unmeasurable,
)
from gtm_hit.ops.quality.statistics.numbers import DISTRIBUTIONS, as_numbers


class Command(BaseCommand):
    help = "Print what a paper prints about a dataset: counts, visibility, tracks, speeds, heights, coverage."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("layer", help="the layer's name")
        parser.add_argument(
            "--every", type=int, default=EVERY, help="coverage: every n-th position along both axes"
        )
        parser.add_argument("--json", action="store_true", help="print one object")
        parser.add_argument(
            "--figures",
            type=Path,
            metavar="FOLDER",
            help="write the figures there, as SVG and PNG, and all numbers as CSV",
        )

    def handle(self, *, slug: str, layer: str, every: int, figures: Path | None, **options: Any) -> None:
        if every < 1:
            raise CommandError(f"--every must be 1 or more, not {every}")
        wanted = layer_named(slug, layer)
        if reason := unmeasurable(wanted.dataset):
            raise CommandError(reason)
        found, ground = layer_statistics(wanted), ground_coverage(wanted.dataset, every)
        numbers = as_numbers(found, ground)
        self.stdout.write(json.dumps(numbers) if options["json"] else "\n".join(_lines(numbers)))
        if figures:
            write_bytes(figures / "numbers.csv", numbers_csv(found, ground).encode())
            for name in FIGURES:
                for kind, (_content_type, draw) in PICTURES.items():
                    write_bytes(figures / f"{name}.{kind}", draw(name, found, ground))


def _lines(numbers: dict[str, Any]) -> list[str]:
    views, exactly, ground = numbers["visible_per_view"], numbers["visible_in_exactly"], numbers["coverage"]
    lines = [_line(name, f"{numbers[name]:,}") for name in ("frames", "people", "annotations")]
    lines.append(_line("visible per view", "  ".join(f"{name} {count:,}" for name, count in views.items())))
    lines.append(_line("in exactly 0, 1 …", "  ".join(f"{count:,}" for count in exactly)))
    lines.append(_line("views/annotation", _shown(numbers["views_per_annotation"])))
    for name, unit in DISTRIBUTIONS.items():
        lines.append(_line(name.replace("_", " "), f"{_told(numbers[name])}  {unit}"))
    counts = "  ".join(f"{count:,}" for count in ground["seen_by_exactly"])
    lines.append(_line("coverage 0, 1 …", f"{counts}  of {ground['positions']:,} positions"))
    lines.append(_line("cameras/position", _shown(ground["mean"])))
    return lines


def _line(name: str, words: str) -> str:
    return f"{name:<18} {words}"


def _told(parts: dict[str, Any]) -> str:
    return "  ".join(f"{part} {_shown(parts[part])}" for part in ("mean", "least", "median", "p95", "most"))


def _shown(value: float | None) -> str:
    return "–" if value is None else f"{value:,.2f}"
