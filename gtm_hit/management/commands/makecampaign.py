from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.rules import add_rules, given
from gtm_hit.ops.campaigns import editing, states
from gtm_hit.ops.campaigns.errors import CampaignError


class Command(BaseCommand):
    help = "Make a campaign of a dataset. It is a draft, unless --open opens it at once."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("name", help="the campaign's name in addresses")
        parser.add_argument("--open", action="store_true", help="let workers in at once")
        add_rules(parser)

    def handle(self, *args: Any, slug: str, name: str, **options: Any) -> None:
        dataset = dataset_named(slug)
        try:
            campaign = editing.create(dataset, {"name": name, **given(options)})
            if options["open"]:
                campaign = states.take(campaign, "open")
        except CampaignError as error:
            raise CommandError(str(error)) from error
        self.stdout.write(f"{name}: {campaign.get_state_display()}, {campaign.batches.count()} batches")
