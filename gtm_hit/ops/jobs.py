"""The life of a job: queued → running → done, failed or cancelled.

The row is the truth. A broker's message only wakes a worker; it may be lost or come twice. A worker owns a
running row as long as `attempts` is the number it claimed with: whoever lost the row can neither report nor
finish it.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from functools import partial
from typing import Any

from celery import current_app
from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import F, Q
from django.utils import timezone

from gtm_hit.models import Dataset, Job

TASK = "gtm_hit.tasks.run_job"
LOST_AFTER = timedelta(seconds=20)
MESSAGE_LIVES = timedelta(minutes=10)
MOST_ATTEMPTS = 5
SECONDS_BETWEEN_REPORTS = 0.5

logger = logging.getLogger(__name__)


class JobError(Exception):
    """A reason to stop that the person who started the job can read."""


class JobCancelled(JobError):
    """Somebody pressed Cancel."""


class JobLost(JobError):
    """The row belongs to somebody else by now."""


@dataclass
class Run:
    """One worker's hold on a running job."""

    job: Job
    attempt: int
    clock: Callable[[], float] = time.monotonic
    _reported_at: float = field(default=float("-inf"), repr=False)

    def report(self, done: int, total: int, message: str = "") -> None:
        """Say how far the job is; call it as often as you like, it writes at most twice a second.

        Raises JobCancelled or JobLost: the caller cleans up and lets it pass.
        """
        if self.clock() - self._reported_at >= SECONDS_BETWEEN_REPORTS:
            self.confirm(done, total, message)

    def confirm(self, done: int, total: int, message: str = "") -> None:
        """Like `report`, without throttling: before a step that cannot be taken back."""
        mine = self._mine().filter(cancel_requested=False)
        if not mine.update(done=done, total=total, message=message, heartbeat_at=timezone.now()):
            if self._mine().exists():
                raise JobCancelled(f"job {self.job.pk} was cancelled")
            raise JobLost(f"job {self.job.pk} is no longer attempt {self.attempt}")
        self._reported_at = self.clock()

    def finish(self, result: dict[str, Any]) -> None:
        self._end(Job.State.DONE, message="", result=result, done=F("total"))

    def fail(self, message: str) -> None:
        self._end(Job.State.FAILED, message=message)

    def cancelled(self) -> None:
        self._end(Job.State.CANCELLED, message="")

    def _mine(self) -> Any:
        return Job.objects.filter(pk=self.job.pk, state=Job.State.RUNNING, attempts=self.attempt)

    def _end(self, state: str, **values: Any) -> None:
        now = timezone.now()
        if not self._mine().update(state=state, finished_at=now, heartbeat_at=now, **values):
            raise JobLost(f"job {self.job.pk} is no longer attempt {self.attempt}")


Operation = Callable[[Run], dict[str, Any]]


def create(kind: str, dataset: Dataset | None, parameters: dict[str, Any], user: User | None = None) -> Job:
    """Queue a job; the message goes out when the surrounding transaction is committed."""
    job = Job.objects.create(
        dataset=dataset, kind=kind, parameters=parameters, created_by=user, heartbeat_at=timezone.now()
    )
    _send_after_commit(job.pk)
    return job


def create_once(
    kind: str, dataset: Dataset | None, parameters: dict[str, Any], user: User | None = None
) -> Job:
    """Like `create`, but a second press on the button finds the job that is still under way."""
    with transaction.atomic():
        if dataset:
            Dataset.objects.select_for_update().get(pk=dataset.pk)
        under_way = Job.objects.filter(
            dataset=dataset,
            kind=kind,
            parameters=parameters,
            state__in=[Job.State.QUEUED, Job.State.RUNNING],
            cancel_requested=False,
        ).first()
        return under_way or create(kind, dataset, parameters, user)


def claim(job_id: int) -> Run | None:
    """Take a queued job; None when it is not there to be taken (any more)."""
    now = timezone.now()
    taken = Job.objects.filter(pk=job_id, state=Job.State.QUEUED).update(
        state=Job.State.RUNNING,
        attempts=F("attempts") + 1,
        started_at=now,
        heartbeat_at=now,
        done=0,
        total=0,
        message="",
    )
    if not taken:
        return None
    job = Job.objects.select_related("dataset").get(pk=job_id)
    return Run(job, job.attempts)


def run(job_id: int, operations: dict[str, Operation]) -> None:
    """Claim a job, do its operation, and write down how it ended."""
    mine = claim(job_id)
    if mine is None:
        return
    try:
        _run_to_its_end(mine, operations)
    except JobLost as error:
        logger.warning("%s", error)


def _run_to_its_end(mine: Run, operations: dict[str, Operation]) -> None:
    try:
        result = operations[mine.job.kind](mine)
    except JobCancelled:
        mine.cancelled()
    except JobLost:
        raise
    except JobError as error:
        mine.fail(str(error))
    except Exception as error:
        logger.exception("job %s failed", mine.job.pk)
        mine.fail(f"{type(error).__name__}: {error}")
    else:
        mine.finish(result)


def cancel(job: Job) -> None:
    """A waiting job ends at once; a running one ends at its next report."""
    now = timezone.now()
    waiting = Job.objects.filter(pk=job.pk, state=Job.State.QUEUED)
    if not waiting.update(state=Job.State.CANCELLED, cancel_requested=True, finished_at=now):
        Job.objects.filter(pk=job.pk, state=Job.State.RUNNING).update(cancel_requested=True)


def retry(job: Job, user: User | None = None) -> Job:
    """Start the same work again; the failed row stays as it is."""
    return create_once(job.kind, job.dataset, job.parameters, user)


def requeue_lost(now: datetime) -> list[int]:
    """Give jobs back whose worker fell silent, and wake a worker for those nobody came for.

    Returns the ids of the jobs that were sent again.
    """
    silent = Q(heartbeat_at__lt=now - LOST_AFTER) | Q(heartbeat_at__isnull=True)
    unfinished = Q(state__in=[Job.State.QUEUED, Job.State.RUNNING])
    return [job.pk for job in Job.objects.filter(silent, unfinished) if _give_back(job, now)]


def _give_back(job: Job, now: datetime) -> bool:
    # Whoever is first wins: a worker that reports after all, or another process that looks as well.
    same = Job.objects.filter(
        pk=job.pk, state=job.state, attempts=job.attempts, heartbeat_at=job.heartbeat_at
    )
    if job.cancel_requested:
        same.update(state=Job.State.CANCELLED, finished_at=now)
        return False
    if job.state == Job.State.RUNNING and job.attempts >= MOST_ATTEMPTS:
        same.update(
            state=Job.State.FAILED,
            finished_at=now,
            message=f"Its worker stopped in the middle, {job.attempts} times. Look into the worker's log.",
        )
        return False
    if not same.update(state=Job.State.QUEUED, heartbeat_at=now):
        return False
    _send_after_commit(job.pk)
    return True


def _send_after_commit(job_id: int) -> None:
    transaction.on_commit(partial(_send, job_id))


def _send(job_id: int) -> None:
    try:
        current_app.send_task(
            TASK, args=[job_id], expires=MESSAGE_LIVES.total_seconds(), retry=False, ignore_result=True
        )
    except Exception:
        # The row is there; `requeue_lost` sends it again when the broker is back.
        logger.exception("no broker for job %s", job_id)
