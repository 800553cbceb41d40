from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.lookups import dataset_named
from gtm_hit.ops.work import batches


class Command(BaseCommand):
    help = "Cut a dataset's frames into batches; again: only what is new."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug")
        parser.add_argument("--size", type=int, default=10, help="frames per batch (default: 10)")
        parser.add_argument("--copies", type=int, default=1, help="opinions per frame (default: 1)")

    def handle(self, *args: Any, slug: str, size: int, copies: int, **options: Any) -> None:
        dataset = dataset_named(slug)
        try:
            added = batches.make_batches(dataset, size, copies)
        except batches.BatchError as error:
            raise CommandError(str(error)) from error
        self.stdout.write(
            f"{slug}: {added} batches added, {dataset.batches.filter(campaign=None).count()} in all"
        )
