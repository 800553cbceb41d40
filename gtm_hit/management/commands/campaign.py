from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.lookups import campaign_named
from gtm_hit.management.rules import add_rules, given
from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns import editing, overview, states, tables
from gtm_hit.ops.campaigns.course import course
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.campaigns.estimate import estimate


class Command(BaseCommand):
    help = "Tell how a campaign goes; open, pause or close it; change its rules by the options."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("name", help="the campaign")
        parser.add_argument("step", nargs="?", choices=list(states.STEPS))
        parser.add_argument("--csv", choices=["batches", "workers"], help="print a table instead")
        add_rules(parser)

    def handle(self, *args: Any, slug: str, name: str, step: str | None, **options: Any) -> None:
        campaign = campaign_named(slug, name)
        try:
            if changes := given(options):
                campaign = editing.edit(campaign, changes)
            if step:
                campaign = states.take(campaign, step)
        except CampaignError as error:
            raise CommandError(str(error)) from error
        if options["csv"]:
            table = tables.workers_csv if options["csv"] == "workers" else tables.assignments_csv
            self.stdout.write(table(campaign), ending="")
            return
        self.tell(campaign)

    def tell(self, campaign: Campaign) -> None:
        going = course(campaign)
        counted = ", ".join(f"{state} {count}" for state, count in sorted(going.batches.items()))
        self.stdout.write(f"{campaign.name}: {campaign.get_state_display()}; batches: {counted}")
        self.stdout.write(f"frames submitted: {going.frames_done} of {going.frames}, every copy counted")
        self.stdout.write(f"cost so far: {overview.money(campaign).so_far} {campaign.currency}")
        self.stdout.write(f"cost when all is done: {estimate(campaign).cost} {campaign.currency}")
        if going.done_at:
            self.stdout.write(f"at the pace of the last days done about {going.done_at:%Y-%m-%d %H:%M} UTC")
