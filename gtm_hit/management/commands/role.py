from __future__ import annotations

import json
from typing import Any

from django.core.management.base import BaseCommand, CommandError, CommandParser

from gtm_hit.management.acting import acting_as
from gtm_hit.management.lookups import dataset_named
from gtm_hit.models import Dataset
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role


class Command(BaseCommand):
    help = "Give, take and list roles: for one dataset, or without --dataset for all of them."

    def add_arguments(self, parser: CommandParser) -> None:
        actions = parser.add_subparsers(dest="action", required=True)
        for name, text in (("grant", "give a role"), ("revoke", "take a role")):
            action = actions.add_parser(name, help=text)
            action.add_argument("username")
            action.add_argument("role", choices=Role.values)
            action.add_argument("--dataset", metavar="SLUG", help="only for this dataset")
            action.add_argument(
                "--by", metavar="USERNAME", help="in the name of this administrator (default: the operator's)"
            )
        action = actions.add_parser("list", help="who has which role")
        action.add_argument("--dataset", metavar="SLUG", help="for this dataset")
        action.add_argument("--json", action="store_true", help="print one object per role and line")

    def handle(self, *, action: str, **options: Any) -> None:
        dataset = dataset_named(options["dataset"]) if options["dataset"] else None
        if action == "list":
            return self.tell(dataset, options["json"])
        by = acting_as(options["by"], Role.ADMINISTRATOR, dataset)
        role, where = Role(options["role"]), f"of {dataset.slug}" if dataset else "of all datasets"
        try:
            user = granting.user_named(options["username"])
            change = granting.grant if action == "grant" else granting.revoke
            changed = change(user, role, dataset, by)
        except granting.RoleError as error:
            raise CommandError(str(error)) from error
        told = {
            ("grant", True): "is now",
            ("grant", False): "was already",
            ("revoke", True): "is no longer",
            ("revoke", False): "was not",
        }
        self.stdout.write(f"{options['username']} {told[action, changed]} {role.value} {where}")

    def tell(self, dataset: Dataset | None, as_json: bool) -> None:
        for each in granting.holdings(dataset):
            facts = {
                "user": each.user.get_username(),
                "role": each.role.value,
                "dataset": dataset.slug if dataset else None,
                "superuser": each.by_account,
            }
            note = "  (superuser)" if each.by_account else ""
            line = f"{facts['user']:<30} {facts['role']}{note}"
            self.stdout.write(json.dumps(facts) if as_json else line)
