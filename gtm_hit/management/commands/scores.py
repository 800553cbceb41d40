from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandParser

from gtm_hit.management.lookups import campaign_named
from gtm_hit.models import Campaign
from gtm_hit.ops.scores import computing, listing, words
from gtm_hit.ops.scores.suspicion import by_suspicion


class Command(BaseCommand):
    help = "Print a campaign's workers by score, or its submitted assignments by suspicion, and why."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug")
        parser.add_argument("campaign")
        parser.add_argument("--recompute", action="store_true", help="measure everything anew first")
        parser.add_argument("--suspicion", action="store_true", help="assignments instead of workers")

    def handle(self, *, slug: str, campaign: str, recompute: bool, suspicion: bool, **options: Any) -> None:
        found = campaign_named(slug, campaign)
        if recompute:
            self.stdout.write(f"{computing.recompute(found)} assignments measured")
        (self.tell_suspicion if suspicion else self.tell_workers)(found)

    def tell_workers(self, campaign: Campaign) -> None:
        for row in listing.workers(campaign):
            numbers = f"{row.score:.0f} ({row.low:.0f} to {row.high:.0f})"
            self.stdout.write(f"{row.worker.pseudonym}: {numbers}, {row.assignments} batches")
            for line in words.of_score(row):
                self.stdout.write(f"  {line}")

    def tell_suspicion(self, campaign: Campaign) -> None:
        for one in by_suspicion(campaign):
            score = getattr(one, "score", None)
            share = f"{score.suspicion:.0%}" if score else "not measured"
            self.stdout.write(f"batch {one.batch.number}/{one.batch.copy} by {one.worker.pseudonym}: {share}")
            for line in words.of_suspicion(score) if score else []:
                self.stdout.write(f"  {line}")
