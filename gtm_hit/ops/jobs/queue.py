"""The life of a job: queued → running → done, failed or cancelled.

The row is the truth. A broker's message only wakes a worker; it may be lost or come twice. A worker owns a
running row as long as `attempts` is the number it claimed with: whoever lost the row can neither report nor
finish it, and what it writes in one transaction with `Run.keep` is taken back.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.jobs import lease

TASK = "gtm_hit.tasks.run_job"
LOST_AFTER = timedelta(seconds=20)
STOPPED_AFTER = timedelta(minutes=2)  # for a process that is there but does not move
MESSAGE_LIVES = timedelta(minutes=10)
MOST_ATTEMPTS = 3  # what killed three workers would kill the fourth
SECONDS_BETWEEN_REPORTS = 0.5

logger = logging.getLogger(__name__)


class JobError(OperationError):
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
            raise self._lost()
        self._reported_at = self.clock()

    def keep(self, **values: Any) -> None:
        """Write onto the row, or raise JobLost.

        Inside the transaction of the work itself: work and row change together, or not at all.
        """
        if not self._mine().update(**values):
            raise self._lost()

    @contextmanager
    def holding(self, done: int, total: int) -> Iterator[None]:
        """`confirm`, and nobody can take the job away until the block ends; for steps of an instant."""
        with transaction.atomic():
            self.confirm(done, total)
            yield

    def beat(self) -> None:
        """A sign of life without progress."""
        self._mine().update(heartbeat_at=timezone.now())

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
        self.keep(state=state, finished_at=now, heartbeat_at=now, **values)

    def _lost(self) -> JobLost:
        return JobLost(f"job {self.job.pk} is no longer attempt {self.attempt}")


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
        with lease.lease(job_id, mine.attempt, mine.beat):
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
    """Give jobs back whose worker is gone, and wake a worker for those nobody came for.

    Returns the ids of the jobs that were sent again.
    """
    silent = Q(heartbeat_at__lt=now - LOST_AFTER) | Q(heartbeat_at__isnull=True)
    unfinished = Q(state__in=[Job.State.QUEUED, Job.State.RUNNING])
    found = Job.objects.filter(silent, unfinished)
    return [job.pk for job in found if not _is_held(job) and _give_back(job, now)]


def _is_held(job: Job) -> bool:
    """Whether a process on it is alive, though the row does not say so."""
    silence = lease.silence(job.pk, job.attempts) if job.state == Job.State.RUNNING else None
    return silence is not None and silence < STOPPED_AFTER


def _give_back(job: Job, now: datetime) -> bool:
    with transaction.atomic():
        # Whoever is first wins: a worker that reports after all, or another process that looks as well.
        # Somebody who has the row locked is alive.
        same = Job.objects.filter(
            pk=job.pk, state=job.state, attempts=job.attempts, heartbeat_at=job.heartbeat_at
        )
        if not list(same.select_for_update(skip_locked=True)):
            return False
        if job.state == Job.State.RUNNING:
            lease.forget(job.pk, job.attempts)
        ended = _end_of_lost(job)
        if ended:
            same.update(finished_at=now, **ended)
            return False
        same.update(state=Job.State.QUEUED, heartbeat_at=now)
        _send_after_commit(job.pk)
        return True


def _end_of_lost(job: Job) -> dict[str, Any]:
    """How a lost job ends that is not to be done again; empty when it is."""
    if job.result:
        return {}  # its work is done and written: the next worker only says so
    if job.cancel_requested:
        return {"state": Job.State.CANCELLED}
    if job.state == Job.State.RUNNING and job.attempts >= MOST_ATTEMPTS:
        return {"state": Job.State.FAILED, "message": _killer(job)}
    return {}


def _killer(job: Job) -> str:
    at = f", the last time at “{job.message}”" if job.message else ""
    return (
        f"Its worker was killed {job.attempts} times{at}. Most often the machine has too little memory for "
        "it; the worker's log may say more. Try again with less at once or on a larger machine."
    )


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
