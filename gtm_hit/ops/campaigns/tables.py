"""A campaign's tables as CSV."""

from __future__ import annotations

from typing import Any

from gtm_hit.models import Campaign, Worker
from gtm_hit.ops.campaigns import overview
from gtm_hit.ops.files.csv_text import csv_text


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
    return csv_text(
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
    return csv_text([*head, "taken_utc", "submitted_utc", "submission", "layer"], rows)


def moment(at: Any) -> str:
    return at.strftime("%Y-%m-%dT%H:%M:%SZ") if at else ""
