from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser
from django.urls import reverse

from gtm_hit.management.lookups import dataset_named
from gtm_hit.ops.work import entry_links, links, workers


class Command(BaseCommand):
    help = "Print the link that lets workers into a dataset; with --worker, one worker's personal link."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug")
        parser.add_argument("--worker", default="", help="the worker's id; the link then works for them only")
        parser.add_argument("--platform", default="link", help="where the workers come from (default: link)")
        switch = parser.add_mutually_exclusive_group()
        switch.add_argument("--close", action="store_true", help="let nobody new in by the general link")
        switch.add_argument("--open", action="store_true", help="make a new general link after --close")
        parser.add_argument("--base-url", default="http://127.0.0.1:8000", help="address of this server")

    def handle(
        self, *args: Any, slug: str, worker: str, platform: str, base_url: str, **options: Any
    ) -> None:
        if worker and (options["close"] or options["open"]):
            raise CommandError("--close and --open are for the general link, --worker is for a personal one.")
        dataset = dataset_named(slug)
        try:
            platform = workers.clean_platform(platform)
            external_id = workers.clean_external_id(worker) if worker else None
        except workers.InvalidWorkerId as error:
            raise CommandError(str(error)) from error
        if options["close"]:
            entry_links.close(dataset, platform)
            self.stdout.write("The link is closed. Whoever works already goes on; personal links work.")
            return
        if options["open"]:
            entry_links.reopen(dataset, platform)
        elif not worker and entry_links.state(dataset, platform).closed_at:
            raise CommandError("The link is closed; --open makes a new one.")
        token = links.entry_token(dataset, platform, external_id)
        self.stdout.write(base_url.rstrip("/") + reverse("join", args=[token]))
