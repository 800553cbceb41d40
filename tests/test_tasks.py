"""What a worker is sent by name, it knows."""

from __future__ import annotations

from annotator.celery import app
from gtm_hit import tasks  # noqa: F401  (registers them)
from gtm_hit.ops.gold import submission


def test_a_worker_knows_every_task_that_the_clock_or_a_submission_sends() -> None:
    sent = {entry["task"] for entry in app.conf.beat_schedule.values()} | {submission.TASK}
    assert sent - set(app.tasks) == set()
