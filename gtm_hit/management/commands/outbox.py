from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError

from gtm_hit.crowd.prolific import connect
from gtm_hit.management.campaign_command import CampaignCommand, manager_named, told
from gtm_hit.management.lookups import campaign_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.models import Campaign, OutboxRow
from gtm_hit.ops.outbox import handover, overview, planning, rows, sending

SHOWN = 50


class Command(CampaignCommand):
    help = "What is told to a campaign's platform: prints it, and does what is asked before that."

    def add_arguments(self, parser: ArgumentParser) -> None:
        super().add_arguments(parser)
        action = parser.add_mutually_exclusive_group()
        action.add_argument("--plan-payouts", action="store_true", help="pay what is to be paid through it")
        action.add_argument("--send", action="store_true", help="send what is planned, now")
        action.add_argument("--retry", type=int, metavar="ROW", help="that failed")
        action.add_argument("--withdraw", type=int, metavar="ROW", help="that is planned")
        action.add_argument("--happened", type=int, metavar="ROW", help="that was unclear")
        action.add_argument("--not-happened", type=int, metavar="ROW", help="that was unclear")
        action.add_argument("--file", choices=list(handover.KINDS), help="print what is planned, for pasting")
        action.add_argument("--done", choices=list(handover.KINDS), help="what the file says is done")
        action.add_argument("--submissions", type=Path, metavar="FILE", help="take in Prolific's list")
        parser.add_argument("--dry-run", action="store_true", help="with --plan-payouts or --send: only tell")
        parser.add_argument("--upto", type=int, metavar="ROW", help="with --done: last row of the file")

    def handle(self, *, slug: str, campaign: str, **options: Any) -> None:
        found = campaign_named(slug, campaign)
        with told():
            if self.act(found, options):
                return
        self.tell(found)

    def act(self, campaign: Campaign, options: dict[str, Any]) -> bool:
        """Whether everything there is to say was said."""
        by = manager_named(options["username"], campaign)
        for action in ("retry", "withdraw", "happened", "not_happened"):
            if pk := options[action]:
                rows.decide(row_numbered(campaign, pk), action, by)
        if options["plan_payouts"]:
            return self.plan(campaign, options["dry_run"], by)
        if options["send"]:
            return self.send(campaign, options["dry_run"])
        if options["file"]:
            made = handover.made(campaign, options["file"])
            self.stdout.write(made.text, ending="")
            self.stderr.write(f"{made.rows} rows; mark them by --done {options['file']} --upto {made.upto}")
            return True
        if options["done"]:
            if options["upto"] is None:
                raise CommandError("--done needs --upto, which --file told")
            self.stdout.write(
                f"{handover.done(campaign, options['done'], options['upto'], by)} rows are done"
            )
        if path := options["submissions"]:
            lines, news = handover.take_in(campaign, read(path))
            self.stdout.write(f"{lines} submissions read, {news} of them are news")
        return False

    def plan(self, campaign: Campaign, dry: bool, by: Any) -> bool:
        found = planning.preview(campaign) if dry else planning.plan_payouts(campaign, by)
        for row in found:
            self.stdout.write(f"{row.kind:<12} {row.worker.pseudonym}  {row.submission}  {row.amount}")
        total = sum(row.amount for row in found)
        self.stdout.write(
            f"{'would plan' if dry else 'planned'}: {len(found)} rows, {total} {campaign.currency}"
        )
        return dry

    def send(self, campaign: Campaign, dry: bool) -> bool:
        if dry:
            for each in overview.next_run(campaign):
                self.stdout.write(
                    f"would send: {each.rows} × {each.label}, {each.amount} {campaign.currency}"
                )
            return True
        platform, progress = connect(campaign), ProgressLine(self.stderr)
        sending.look(campaign, platform)
        report = sending.send(campaign, platform, lambda done, total: progress("sending", done, total))
        progress.finish()
        self.stdout.write(f"confirmed {report.confirmed}, failed {report.failed}, unclear {report.unclear}")
        if wait := sending.next_wait(campaign):
            self.stdout.write(f"the platform asked to wait; try again in {wait:.0f} seconds")
        return False

    def tell(self, campaign: Campaign) -> None:
        for row in overview.listed(campaign)[:SHOWN]:
            text = f"{row.pk:6}  {row.state:<10} {row.kind:<14} {row.worker.pseudonym}  {row.submission}"
            self.stdout.write(f"{text}  {row.amount}  {row.error}".rstrip())
        counted = (f"{number} {state}" for state, number in overview.counts(campaign).items() if number)
        self.stdout.write(", ".join(counted) or "nothing was ever planned")


def row_numbered(campaign: Campaign, pk: int) -> OutboxRow:
    row = OutboxRow.objects.select_related("campaign", "after").filter(campaign=campaign, pk=pk).first()
    if row is None:
        raise CommandError(f"there is no row {pk}")
    return row


def read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise CommandError(f"{path}: {error.strerror}") from error
