from __future__ import annotations

import sys
from argparse import ArgumentParser
from dataclasses import replace
from pathlib import Path
from typing import Any

from django.core.management.base import CommandError
from django.urls import reverse

from gtm_hit.crowd.prolific import connect
from gtm_hit.management.campaign_command import CampaignCommand, manager_named, told
from gtm_hit.management.lookups import campaign_named
from gtm_hit.models import Campaign
from gtm_hit.ops.outbox import accounts, studies


class Command(CampaignCommand):
    help = "A campaign's study at Prolific: how it is reached, drafting, publishing, pausing."

    def add_arguments(self, parser: ArgumentParser) -> None:
        super().add_arguments(parser)
        parser.add_argument("--address", help="of its interface, one of PROLIFIC_ADDRESSES")
        parser.add_argument("--study", help="number of a study that was made there")
        parser.add_argument(
            "--key-file", metavar="FILE", help="file with the key; - reads it from standard input"
        )
        parser.add_argument("--secret-file", metavar="FILE", help="the same for the secret of its messages")
        action = parser.add_mutually_exclusive_group()
        action.add_argument("--draft", metavar="LINK", help="draft a study that sends workers to this link")
        for name in (*studies.ACTIONS, "look"):
            action.add_argument(f"--{name}", dest="action", action="store_const", const=name)
        action.add_argument(
            "--messages", nargs=2, metavar=("WORKSPACE", "URL"), help="have them sent to our door"
        )
        parser.add_argument("--places", type=int, help="with --draft; as many as batches when left out")

    def handle(self, *, slug: str, campaign: str, **options: Any) -> None:
        found = campaign_named(slug, campaign)
        by = manager_named(options["username"], found)
        with told():
            self.configure(found, options, by)
            if options["draft"]:
                wanted = studies.proposed(found, options["draft"])
                wanted = replace(wanted, places=options["places"] or wanted.places)
                studies.draft(found, connect(found), wanted, by)
            if options["messages"]:
                workspace, server = options["messages"]
                door = server.rstrip("/") + reverse("hook-prolific", args=[slug, campaign])
                studies.have_messages_sent(found, connect(found), workspace, door, by)
            if options["action"] == "look":
                studies.look(found, connect(found))
            elif options["action"]:
                studies.change(found, connect(found), options["action"], by)
        self.tell(found)

    def configure(self, campaign: Campaign, options: dict[str, Any], by: Any) -> None:
        given = [options[name] for name in ("address", "study", "key_file", "secret_file")]
        if all(each is None for each in given):
            return
        now = accounts.of(campaign)
        accounts.configure(
            campaign,
            by,
            address=now.address if options["address"] is None else options["address"],
            study=now.study if options["study"] is None else options["study"],
            token=secret(options["key_file"]),
            hook_secret=secret(options["secret_file"]),
        )

    def tell(self, campaign: Campaign) -> None:
        account = accounts.of(campaign)
        self.stdout.write(f"study: {account.study or 'none'} {account.study_state.lower()}".rstrip())
        if account.completion_code:
            self.stdout.write(f"completion code: {account.completion_code}")
        key = "there is one" if accounts.has_key(account) else "none, everything goes by files"
        self.stdout.write(f"key: {key}")


def secret(name: str | None) -> str:
    """Never an argument: those are read by everybody on the machine."""
    if name is None:
        return ""
    try:
        text = sys.stdin.readline() if name == "-" else Path(name).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise CommandError(f"{name}: {error}") from error
    if not text.strip():
        raise CommandError(f"{name} is empty")
    return text.strip()
