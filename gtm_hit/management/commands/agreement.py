from __future__ import annotations

import json
from argparse import ArgumentParser
from collections.abc import Iterator
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import dataset_named
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.models import Dataset
from gtm_hit.ops.quality.agreement import BatchAgreement, as_numbers, batch_agreements, shared_batches

BATCHES_AT_ONCE = 50


class Command(BaseCommand):
    help = "Print how far workers who did the same batch agree, in metres; workers go by their pseudonyms."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument(
            "--radius", type=float, default=RADIUS, help="only pairs closer than this are matched, metres"
        )
        parser.add_argument("--json", action="store_true", help="print one object per batch and line")

    def handle(self, *, slug: str, radius: float, **options: Any) -> None:
        dataset = dataset_named(slug)
        if not radius > 0:
            raise CommandError(f"--radius must be a positive number of metres, not {radius}")
        for found in _all(dataset, radius):
            numbers = as_numbers(found)
            self.stdout.write(json.dumps(numbers) if options["json"] else "\n".join(_lines(numbers)))


def _all(dataset: Dataset, radius: float) -> Iterator[BatchAgreement]:
    numbers = list(shared_batches(dataset))
    for start in range(0, len(numbers), BATCHES_AT_ONCE):
        yield from batch_agreements(dataset, numbers[start : start + BATCHES_AT_ONCE], radius)


def _lines(numbers: dict[str, Any]) -> Iterator[str]:
    yield (
        f"batch {numbers['batch']}: {_percent(numbers['matched_share'])} matched, "
        f"median {_metres(numbers['median_distance'])}, p95 {_metres(numbers['p95_distance'])}, "
        f"identities {_percent(numbers['identity_agreement'])}"
    )
    for name, bias in numbers["workers"].items():
        x, y = (_metres(bias[axis], "+") for axis in ("bias_x", "bias_y"))
        yield f"  {name}: {bias['annotations']} annotations, bias X {x}, Y {y}"


def _percent(value: float | None) -> str:
    return "–" if value is None else f"{100 * value:.1f} %"


def _metres(value: float | None, sign: str = "") -> str:
    return "–" if value is None else f"{value:{sign}.3f} m"
