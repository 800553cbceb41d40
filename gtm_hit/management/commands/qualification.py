from __future__ import annotations

from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.lookups import (
    campaign_named,
    dataset_named,
    layer_named,
    qualification_named,
    worker_named,
)
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.qualifications import grants, managing
from gtm_hit.ops.qualifications.managing import Order, PassMarks

MARKS = tuple(vars(PassMarks()))


class Command(BaseCommand):
    help = "List a dataset's qualifications; make, grant, revoke, close one, or let a campaign ask for some."

    def add_arguments(self, parser: CommandParser) -> None:
        parser.add_argument("slug")
        parser.add_argument("name", nargs="?")
        what = parser.add_mutually_exclusive_group()
        what.add_argument("--truth", help="make it, with the truth of this layer")
        what.add_argument("--grant", metavar="WORKER", help="pseudonym")
        what.add_argument("--revoke", metavar="WORKER", help="pseudonym; takes --why")
        what.add_argument("--close", action="store_true", help="no new tries")
        what.add_argument("--open", action="store_true", help="tries again")
        what.add_argument(
            "--require", metavar="CAMPAIGN", help="ask for this one and no other; without a name: none"
        )
        parser.add_argument("--why", default="")
        parser.add_argument("--title", default="", help="what workers read")
        parser.add_argument("--first-frame", type=int, default=0)
        parser.add_argument("--frames-per-try", type=int, default=5)
        parser.add_argument("--tries", type=int, default=2)
        for mark in MARKS:
            usual = getattr(PassMarks(), mark)
            parser.add_argument(f"--{mark.replace('_', '-')}", type=float, default=usual)

    def handle(self, *, slug: str, name: str | None, **options: Any) -> None:
        try:
            self.decide(slug, name, options)
        except OperationError as error:
            raise CommandError(str(error)) from error
        for one in managing.qualifications(dataset_named(slug)):
            state = "closed" if one.closed_at else "open"
            self.stdout.write(
                f"{one.name}: {state}, {one.tried} tried, {one.passed} passed, {one.waiting} at it"
            )

    def decide(self, slug: str, name: str | None, options: dict[str, Any]) -> None:
        if options["require"]:
            managing.require(campaign_named(slug, options["require"]), [name] if name else [])
        elif name is None:
            dataset_named(slug)
        elif options["truth"]:
            self.make(slug, name, options)
        else:
            self.change(slug, name, options)

    def make(self, slug: str, name: str, options: dict[str, Any]) -> None:
        marks = PassMarks(**{mark: options[mark] for mark in MARKS})
        wanted = ("title", "first_frame", "frames_per_try", "tries")
        order = Order(
            name, layer_named(slug, options["truth"]), marks=marks, **{key: options[key] for key in wanted}
        )
        managing.create(dataset_named(slug), order)

    def change(self, slug: str, name: str, options: dict[str, Any]) -> None:
        found = qualification_named(slug, name)
        if options["grant"]:
            grants.grant(found, worker_named(options["grant"]), None, options["why"])
        if options["revoke"]:
            grants.revoke(found, worker_named(options["revoke"]), None, options["why"])
        if options["close"]:
            managing.close(found)
        if options["open"]:
            managing.reopen(found)
