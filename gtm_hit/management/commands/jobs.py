from __future__ import annotations

import json
import time
from argparse import ArgumentParser
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.models import Job
from gtm_hit.ops import overview
from gtm_hit.ops.jobs import queue

SHOWN = 50
SECONDS_BETWEEN_LOOKS = 1.0


class Command(BaseCommand):
    help = (
        "List long work and how far it is, the newest first; with its number: show, await, stop or repeat it."
    )

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("job", type=int, nargs="?", help="a job's number")
        parser.add_argument("--dataset", metavar="SLUG", help="only jobs of this dataset")
        parser.add_argument("--kind", choices=Job.Kind.values)
        parser.add_argument("--state", choices=Job.State.values)
        parser.add_argument(
            "--most", type=int, default=SHOWN, metavar="N", help=f"how many to list ({SHOWN})"
        )
        parser.add_argument("--json", action="store_true", help="print one object per job and line")
        action = parser.add_mutually_exclusive_group()
        action.add_argument("--wait", action="store_true", help="until the job has ended; fails unless done")
        action.add_argument("--cancel", action="store_true", help="a running job ends at its next step")
        action.add_argument("--retry", action="store_true", help="do the same again, as a new job")

    def handle(self, *, job: int | None, **options: Any) -> None:
        if job is None:
            if options["wait"] or options["cancel"] or options["retry"]:
                raise CommandError("say which job, by its number")
            return self.tell(list(chosen(options)[: max(options["most"], 0)]), options["json"])
        found = by_number(job)
        if options["wait"]:
            found = self.wait(found)
        elif options["cancel"]:
            queue.cancel(found)
        elif options["retry"]:
            if not found.finished:
                raise CommandError(f"job {job} is still under way")
            found = queue.retry(found)
        found = by_number(found.pk)
        self.tell([found], options["json"])
        if options["wait"] and found.state != Job.State.DONE:
            raise CommandError(f"job {job}: {found.get_state_display()}")

    def wait(self, job: Job) -> Job:
        progress = ProgressLine(self.stderr)
        while not job.finished:
            progress(job.get_kind_display(), job.done, max(job.total, 1))
            time.sleep(SECONDS_BETWEEN_LOOKS)
            job = by_number(job.pk)
        progress.finish()
        return job

    def tell(self, found: list[Job], as_json: bool) -> None:
        for job in found:
            self.stdout.write(json.dumps(facts(job)) if as_json else line(job))


def chosen(options: dict[str, Any]) -> Any:
    if options["dataset"]:
        dataset_named(options["dataset"])
    wanted = {"dataset__slug": options["dataset"], "kind": options["kind"], "state": options["state"]}
    given = {name: value for name, value in wanted.items() if value}
    return overview.jobs().filter(**given).order_by("-created_at", "-pk")


def by_number(pk: int) -> Job:
    found = overview.jobs().filter(pk=pk).first()
    if found is None:
        raise CommandError(f"there is no job {pk}")
    return found


def facts(job: Job) -> dict[str, Any]:
    return {
        "id": job.pk,
        "dataset": job.dataset.slug if job.dataset else None,
        "kind": job.kind,
        "state": job.state,
        "done": job.done,
        "total": job.total,
        "message": job.message,
        "result": job.result,
        "created_at": job.created_at.isoformat(),
        "finished_at": job.finished_at.isoformat() if job.finished_at else None,
    }


def line(job: Job) -> str:
    percent = f"{100 * job.done // job.total if job.total else 0:3d} %"
    slug = job.dataset.slug if job.dataset else "–"
    began = f"{job.created_at:%Y-%m-%d %H:%M}"
    return f"{job.pk:6}  {began}  {slug:<20} {job.kind:<20} {job.state:<9} {percent}  {job.message}".rstrip()
