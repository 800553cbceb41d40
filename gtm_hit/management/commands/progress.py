from __future__ import annotations

import json
from argparse import ArgumentParser
from dataclasses import asdict
from typing import Any

from django.core.management.base import BaseCommand

from gtm_hit.management.lookups import dataset_named
from gtm_hit.models import Assignment
from gtm_hit.ops import overview


class Command(BaseCommand):
    help = "Tell how many batches are free, leased, submitted and accepted, and who has which, by pseudonym."

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("--state", choices=Assignment.State.values, help="only assignments in this state")
        parser.add_argument("--json", action="store_true", help="print one object")

    def handle(self, *, slug: str, state: str | None, **options: Any) -> None:
        dataset = dataset_named(slug)
        counts = asdict(overview.batch_counts(dataset))
        found = overview.assignments(dataset).filter(**({"state": state} if state else {}))
        rows = [facts(assignment) for assignment in found]
        if options["json"]:
            self.stdout.write(json.dumps({**counts, "assignments": rows}))
            return
        self.stdout.write(", ".join(f"{name.replace('_', ' ')}: {count}" for name, count in counts.items()))
        for row in rows:
            self.stdout.write(
                f"batch {row['batch']:5} copy {row['copy']}  {row['worker']:<12} {row['state']:<10} "
                f"{row['frames_done']} of {row['frames']} frames, {row['people']} people"
            )


def facts(assignment: Any) -> dict[str, Any]:
    """Of a row of `overview.assignments`; workers appear by their pseudonyms."""
    return {
        "batch": assignment.batch.number,
        "copy": assignment.batch.copy,
        "worker": assignment.worker.pseudonym,
        "layer": assignment.layer.name,
        "state": assignment.state,
        "frames": assignment.frame_count,
        "frames_done": assignment.frames_done,
        "people": assignment.people,
    }
