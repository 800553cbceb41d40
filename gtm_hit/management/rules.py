"""Rules of a campaign as options of a command."""

from __future__ import annotations

from argparse import ArgumentParser
from decimal import Decimal
from typing import Any

from django.core.management.base import CommandError
from django.db import models

from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns import changes

TYPES: dict[type[models.Field[Any, Any]], Any] = {
    models.PositiveIntegerField: int,
    models.PositiveSmallIntegerField: int,
    models.FloatField: float,
    models.DecimalField: Decimal,
}


def add_rules(parser: ArgumentParser) -> None:
    """One option for each rule; what is not given is not in what `given` finds."""
    for name in changes.FIELDS:
        if name in {"name", "platform_settings"}:
            continue
        field = Campaign._meta.get_field(name)
        assert isinstance(field, models.Field)
        parser.add_argument(
            f"--{name.replace('_', '-')}",
            type=TYPES.get(type(field), str),
            choices=[choice for choice, _label in field.choices] if field.choices else None,
            help=changes.label(name),
        )
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a setting of the platform; again for more, several values with blanks between them",
    )


def given(options: dict[str, Any]) -> dict[str, Any]:
    found = {name: options[name] for name in changes.FIELDS if options.get(name) is not None}
    if options["set"]:
        found["platform_settings"] = dict(setting(word) for word in options["set"])
    return found


def setting(word: str) -> tuple[str, Any]:
    name, sign, value = word.partition("=")
    if not sign:
        raise CommandError(f"--set takes NAME=VALUE, not {word}")
    return name, value.split() if name in {"frame_ancestors", "submit_to"} else value
