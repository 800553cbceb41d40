"""Commands about one campaign, named by its dataset and its own name."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Iterator
from contextlib import contextmanager
from decimal import Decimal, InvalidOperation

from django.contrib.auth.models import User
from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.acting import acting_as
from gtm_hit.models import Campaign
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.errors import OperationError


class CampaignCommand(BaseCommand):
    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("campaign", help="the campaign's name")
        parser.add_argument(
            "--as", dest="username", metavar="USER", help="under whose name it is written down; a manager"
        )


def manager_named(username: str | None, campaign: Campaign) -> User | None:
    """In whose name a manager's deed is written down; raises CommandError if he may not do it."""
    return acting_as(username, Role.MANAGER, campaign.dataset)


def amount(text: str) -> Decimal:
    try:
        return Decimal(text)
    except InvalidOperation:
        raise CommandError(f"{text!r} is no amount of money") from None


@contextmanager
def told() -> Iterator[None]:
    """What an operation refuses ends the command with its words."""
    try:
        yield
    except OperationError as error:
        raise CommandError(str(error)) from error
