from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser
from django.urls import reverse

from gtm_hit.crowd.platforms import platform_of
from gtm_hit.management.lookups import campaign_named
from gtm_hit.models import Campaign, CampaignLink
from gtm_hit.ops.campaigns import links, standing
from gtm_hit.ops.campaigns.errors import CampaignError

Kind = CampaignLink.Kind


class Command(BaseCommand):
    help = (
        "Make and print a campaign's link: the general one, with --worker somebody's own, with --invitation "
        "one that makes an account. --list, --revoke and --rotate look after those there are."
    )

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("name", help="the campaign")
        what = parser.add_mutually_exclusive_group()
        what.add_argument("--worker", default="", help="the worker's id or pseudonym")
        what.add_argument("--invitation", action="store_true", help="for one person of the own team")
        what.add_argument("--list", action="store_true", help="print the links there are")
        what.add_argument("--revoke", type=int, metavar="ID", help="a link by its number in --list")
        what.add_argument("--rotate", type=int, metavar="ID", help="another address for a link")
        parser.add_argument("--note", default="", help="for whom; only managers read it")
        parser.add_argument("--days", type=int, help="how long it is valid (default: as the settings say)")
        parser.add_argument("--base-url", default="http://127.0.0.1:8000", help="address of this server")

    def handle(self, *args: Any, slug: str, name: str, base_url: str, **options: Any) -> None:
        campaign = campaign_named(slug, name)
        self.base_url = base_url.rstrip("/")
        try:
            if options["list"]:
                for link in campaign.links.select_related("worker", "campaign__dataset"):
                    self.tell(link)
            elif options["revoke"] is not None:
                links.revoke(self.named(campaign, options["revoke"]))
                self.stdout.write("Nobody comes in by it any more.")
            elif options["rotate"] is not None:
                self.stdout.write(self.address(links.rotate(self.named(campaign, options["rotate"]))))
            else:
                self.stdout.write(self.address(self.made(campaign, options)))
        except CampaignError as error:
            raise CommandError(str(error)) from error

    def made(self, campaign: Campaign, options: dict[str, Any]) -> CampaignLink:
        words: dict[str, Any] = {"note": options["note"], "days": options["days"]}
        if options["worker"]:
            worker = standing.known_or_new(campaign, options["worker"])
            return links.make(campaign, Kind.PERSONAL, worker=worker, **words)
        kind = Kind.INVITATION if options["invitation"] else Kind.GENERAL
        return links.make(campaign, kind, **words)

    def named(self, campaign: Campaign, pk: int) -> CampaignLink:
        found = campaign.links.select_related("campaign__dataset").filter(pk=pk).first()
        if found is None:
            raise CommandError(f"no link {pk} of campaign {campaign.name}; --list names them")
        return found

    def tell(self, link: CampaignLink) -> None:
        shown = self.address(link) if link.state == "open" else ""
        whose = link.worker.pseudonym if link.worker else "-"
        self.stdout.write(f"{link.pk:6} {link.kind:<10} {link.state:<8} {whose:<12} {link.uses:4} {shown}")

    def address(self, link: CampaignLink) -> str:
        view = "invitation" if link.kind == Kind.INVITATION else "join"
        plain = self.base_url + reverse(view, args=[links.token(link)])
        return platform_of(link.campaign).entry_address(plain) if link.kind == Kind.GENERAL else plain
