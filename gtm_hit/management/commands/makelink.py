from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser
from django.urls import reverse

from gtm_hit.management.lookups import dataset_named
from gtm_hit.ops import tokens, workers


class Command(BaseCommand):
    help = "Print the link that lets workers into a dataset; with --worker, one worker's personal link."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug")
        parser.add_argument("--worker", default="", help="the worker's id; the link then works for him only")
        parser.add_argument("--platform", default="link", help="where the workers come from (default: link)")
        parser.add_argument("--base-url", default="http://127.0.0.1:8000", help="address of this server")

    def handle(
        self, *args: Any, slug: str, worker: str, platform: str, base_url: str, **options: Any
    ) -> None:
        dataset = dataset_named(slug)
        try:
            platform = workers.clean_platform(platform)
            external_id = workers.clean_external_id(worker) if worker else None
        except workers.InvalidWorkerId as error:
            raise CommandError(str(error)) from error
        token = tokens.entry_token(dataset, platform, external_id)
        self.stdout.write(base_url.rstrip("/") + reverse("join", args=[token]))
