from __future__ import annotations

import json
from argparse import ArgumentParser
from typing import Any

from django.contrib.auth.models import User
from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.acting import acting_as
from gtm_hit.management.lookups import dataset_named
from gtm_hit.models import Assignment, Campaign, Category, Dataset
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.review import comments, facts, mending, queue
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition

DECISIONS = {
    "accept": Action.ACCEPT,
    "accept-mended": Action.ACCEPT_MENDED,
    "return": Action.RETURN,
    "take-back": Action.TAKE_BACK,
    "reject": Action.REJECT,
    "uphold": Action.UPHOLD,
    "overturn": Action.OVERTURN,
}
NEED_ID = ["show", "comment", "mend", *DECISIONS]


class Command(BaseCommand):
    help = "List what waits for a review, and decide: accept, return, reject, or an appeal."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("what", nargs="?", default="list", choices=["list", *NEED_ID])
        parser.add_argument("id", type=int, nargs="?", help="the assignment, as the list shows it")
        parser.add_argument("--campaign", help="list only this campaign's work")
        parser.add_argument("--list", choices=list(facts.LISTS), default="waiting", dest="which")
        parser.add_argument("--by", metavar="USER", help="who decides; must be a reviewer of the dataset")
        parser.add_argument("--category", choices=Category.values, default="", help="of a rejection")
        parser.add_argument("--reason", default="", help="what the worker reads; a comment's text")
        parser.add_argument("--frame", type=int, help="of a comment: the frame's number")
        parser.add_argument("--person", type=int, help="of a comment: the person's number")
        parser.add_argument("--position", type=int, help="of a comment: the place's number")
        parser.add_argument("--json", action="store_true", help="print one object")

    def handle(self, *, slug: str, what: str, **options: Any) -> None:
        dataset = dataset_named(slug)
        if what == "list":
            return self.print_list(dataset, options)
        assignment = assignment_with(dataset, options["id"])
        if what != "show":
            try:
                act(assignment, what, reviewer_named(options["by"], dataset), options)
            except OperationError as error:
                raise CommandError(str(error)) from error
        told = facts.whole(assignment_with(dataset, assignment.pk))
        self.stdout.write(json.dumps(told) if options["json"] else "\n".join(lines_of(told)))

    def print_list(self, dataset: Dataset, options: dict[str, Any]) -> None:
        rows, told = facts.LISTS[options["which"]]
        found = [
            told(row) for row in rows(queue.Scope(dataset, campaign_named(dataset, options["campaign"])))
        ]
        if options["json"]:
            self.stdout.write(json.dumps({options["which"]: found}))
            return
        for one in found:
            self.stdout.write("  ".join(f"{name} {value}" for name, value in one.items() if value))
        if not found:
            self.stdout.write("nothing")


def act(assignment: Assignment, what: str, by: User, options: dict[str, Any]) -> None:
    if what == "comment":
        pin = comments.Pin(options["frame"], options["person"], options["position"])
        comments.remark(assignment, by, options["reason"], pin)
    elif what == "mend":
        mending.mend(assignment, by)
    else:
        transition(assignment, DECISIONS[what], by, category=options["category"], reason=options["reason"])


def lines_of(told: dict[str, Any]) -> list[str]:
    lines = [
        f"{told['id']}: batch {told['batch']} copy {told['copy']} by {told['worker']}, {told['state']}",
        *(
            f"  {one['at'][:16]}  {one['by']}: {one['action']}  {one['reason']}".rstrip()
            for one in told["steps"]
        ),
    ]
    for one in told["comments"]:
        where = f"frame {one['frame']}" if one["frame"] is not None else "all"
        lines.append(f"  {where}: {one['text']}{' (done)' if one['resolved'] else ''}")
    return lines


def assignment_with(dataset: Dataset, pk: int | None) -> Assignment:
    if pk is None:
        raise CommandError("say which: the number `list` shows")
    rows = Assignment.objects.filter(batch__dataset=dataset)
    found = queue.described(rows).filter(pk=pk).first()
    if found is None:
        raise CommandError(f"{dataset.slug} has no assignment {pk}")
    return found


def reviewer_named(name: str | None, dataset: Dataset) -> User:
    found = acting_as(name, Role.REVIEWER, dataset)
    if found is None:
        raise CommandError("say who decides: --by USER")
    return found


def campaign_named(dataset: Dataset, name: str | None) -> Campaign | None:
    if not name:
        return None
    found = Campaign.objects.filter(dataset=dataset, name=name).first()
    if found is None:
        raise CommandError(f"{dataset.slug} has no campaign {name}")
    return found
