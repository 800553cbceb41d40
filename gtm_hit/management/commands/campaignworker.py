from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.lookups import campaign_named
from gtm_hit.models import Campaign, Worker
from gtm_hit.ops.campaigns import seats, standing, tables
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work import links


class Command(BaseCommand):
    help = (
        "Invite or block a worker of a campaign, or end their links; without a deed print the batches as CSV."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("name", help="the campaign")
        parser.add_argument("worker", help="pseudonym, or the platform's id")
        deed = parser.add_mutually_exclusive_group()
        deed.add_argument("--invite", action="store_true", help="let them in where only invited workers are")
        deed.add_argument("--block", metavar="REASON", help="hand out no more batches")
        deed.add_argument("--forget", action="store_true", help="neither invited nor blocked any more")
        deed.add_argument("--revoke-links", action="store_true", help="end whatever leads to their work")
        deed.add_argument("--revoke-link", type=int, metavar="BATCH", help="end the link of one batch")

    def handle(self, *args: Any, slug: str, name: str, worker: str, **options: Any) -> None:
        campaign = campaign_named(slug, name)
        try:
            if options["invite"]:
                row = standing.invite(campaign, worker)
                self.stdout.write(f"{row.worker.pseudonym} is invited.")
                return
            found = seats.named(campaign, worker)
            if found is None:
                raise CommandError(f"no worker {worker} in campaign {name}")
            self.do(campaign, found, options)
        except CampaignError as error:
            raise CommandError(str(error)) from error

    def do(self, campaign: Campaign, worker: Worker, options: dict[str, Any]) -> None:
        if options["block"] is not None:
            standing.block(campaign, worker, options["block"])
            self.stdout.write(f"{worker.pseudonym} is blocked; what is already taken may be finished.")
        elif options["forget"]:
            standing.forget(campaign, worker)
            self.stdout.write(f"The campaign's rules count for {worker.pseudonym} again.")
        elif options["revoke_links"]:
            links.revoke_worker(worker)
            self.stdout.write(f"No link of {worker.pseudonym} opens anything any more.")
        elif options["revoke_link"] is not None:
            self.revoke(campaign, worker, options["revoke_link"])
        else:
            self.stdout.write(tables.assignments_csv(campaign, worker), ending="")

    def revoke(self, campaign: Campaign, worker: Worker, number: int) -> None:
        found = worker.assignments.filter(batch__campaign=campaign, batch__number=number).first()
        if found is None:
            raise CommandError(f"{worker.pseudonym} never had batch {number} of {campaign.name}")
        links.revoke_assignment(found)
        self.stdout.write(f"The link of batch {number} is revoked.")
