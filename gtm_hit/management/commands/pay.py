from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError

from gtm_hit.management.campaign_command import CampaignCommand, amount, manager_named, told
from gtm_hit.management.lookups import campaign_named, worker_named
from gtm_hit.models import Campaign, MoneyEntry
from gtm_hit.ops.pay import csv_files, ledger, table

TITLES = (
    "worker",
    "accepted",
    "minutes",
    "per hour",
    "earned",
    "bonuses",
    "proposed",
    "paid",
    "on way",
    "to pay",
)


class Command(CampaignCommand):
    help = (
        "Who earned what in a campaign, and paying them: prints a table, and does what is asked before that."
    )

    def add_arguments(self, parser: ArgumentParser) -> None:
        super().add_arguments(parser)
        parser.add_argument("--approve-bonuses", action="store_true", help="that are proposed")
        parser.add_argument("--bonus", nargs=2, metavar=("WORKER", "AMOUNT"), help="one of another amount")
        parser.add_argument("--paid", metavar="WORKER", help="was paid by other ways")
        parser.add_argument("--amount", help="with --paid; all there is to pay when left out")
        parser.add_argument("--note", default="", help="how it was paid, or why it is taken back")
        parser.add_argument("--take-back", type=int, metavar="LINE", help="a line of the ledger")
        parser.add_argument(
            "--csv", type=Path, metavar="FOLDER", help="write workers.csv and ledger.csv there"
        )

    def handle(self, *, slug: str, campaign: str, **options: Any) -> None:
        found = campaign_named(slug, campaign)
        with told():
            self.act(found, options)
        if folder := options["csv"]:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "workers.csv").write_text(csv_files.workers(found), encoding="utf-8")
            (folder / "ledger.csv").write_text(csv_files.ledger_lines(found), encoding="utf-8")
        self.tell(found)

    def act(self, campaign: Campaign, options: dict[str, Any]) -> None:
        by = manager_named(options["username"], campaign)
        if options["approve_bonuses"]:
            table.approve_bonuses(campaign, by)
        if options["bonus"]:
            worker, given = options["bonus"]
            table.approve_bonuses(campaign, by, [worker], amount(given))
        if options["paid"]:
            given = options["amount"]
            worker = worker_named(options["paid"])
            ledger.mark_paid(campaign, worker, by, amount(given) if given else None, options["note"])
        if pk := options["take_back"]:
            entry = MoneyEntry.objects.select_related("campaign").filter(campaign=campaign, pk=pk).first()
            if entry is None:
                raise CommandError(f"there is no line {pk}")
            ledger.take_back(entry, by, options["note"])

    def tell(self, campaign: Campaign) -> None:
        lines = table.workers(campaign)
        self.stdout.write("  ".join(f"{title:>12}" for title in TITLES))
        for each in lines:
            money = each.balance
            cells = (
                *(each.worker.pseudonym, each.accepted, f"{each.minutes:.0f}", each.per_hour or "–"),
                *(
                    money.earned,
                    money.bonus_approved,
                    each.proposed,
                    money.paid,
                    money.on_its_way,
                    money.to_pay,
                ),
            )
            self.stdout.write("  ".join(f"{cell!s:>12}" for cell in cells))
        totals = table.totals(campaign, lines)
        self.stdout.write(
            f"{totals.accepted} of {totals.batches} batches accepted; cost {totals.cost}, "
            f"paid {totals.paid}, to pay {totals.to_pay}, forecast {totals.forecast} {campaign.currency}"
        )
