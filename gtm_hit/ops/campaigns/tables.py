"""A campaign's tables as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from typing import Any

from gtm_hit.models import Campaign, Worker
from gtm_hit.ops.campaigns import overview

# A spreadsheet takes a cell that begins like this for a formula.
FORMULA = ("=", "+", "-", "@", "\t", "\r")


def workers_csv(campaign: Campaign) -> str:
    head = ["worker", "standing", "batches", "submitted", "accepted", "returned", "rejected"]
    rows = [
        [
            row.worker.pseudonym,
            row.standing,
            row.batches,
            row.submitted,
            *(row.counts.get(state, 0) for state in ("accepted", "returned", "rejected")),
            row.frames_done,
            row.minutes,
            moment(row.last_at),
            *((row.score.score, row.score.low, row.score.high) if row.score else ("", "", "")),
        ]
        for row in overview.worker_rows(campaign, overview.workers(campaign))
    ]
    return table(
        [*head, "frames_done", "active_minutes", "last_batch_taken_utc", "score", "score_low", "score_high"],
        rows,
    )


def assignments_csv(campaign: Campaign, worker: Worker | None = None) -> str:
    """Of everybody, or of one worker."""
    head = ["batch", "copy", "worker", "state", "frames_done", "active_minutes"]
    rows = [
        [
            row.assignment.batch.number,
            row.assignment.batch.copy,
            row.assignment.worker.pseudonym,
            row.assignment.state,
            row.frames_done,
            row.minutes,
            moment(row.assignment.leased_at),
            moment(row.assignment.submitted_at),
            row.assignment.submission,
            row.assignment.layer.name,
        ]
        for row in overview.with_sums(overview.assignments(campaign, worker))
    ]
    return table([*head, "taken_utc", "submitted_utc", "submission", "layer"], rows)


def moment(at: Any) -> str:
    return at.strftime("%Y-%m-%dT%H:%M:%SZ") if at else ""


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    written = io.StringIO()
    writer = csv.writer(written, lineterminator="\n")
    writer.writerow(head)
    for row in rows:
        writer.writerow([harmless(cell) for cell in row])
    return written.getvalue()


def harmless(cell: Any) -> Any:
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(FORMULA) else cell
