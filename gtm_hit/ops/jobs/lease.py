"""A running job's sign of life, apart from its progress: a thread beats while the operation goes on.

Two places, because each fails alone. The row's heartbeat is seen from every machine, but a long transaction
of the job itself may keep it from being written. So the process also locks a file: the kernel lets go of
the lock when the process dies, however it dies, and keeps it through the longest silent step.
"""

from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from datetime import timedelta
from pathlib import Path
from threading import Event, Thread

from django.conf import settings
from django.db import DatabaseError, connection, connections

SECONDS_BETWEEN_BEATS = 3.0
SECONDS_TO_STOP = 5.0
# The thread waits for a locked row or file only this long: the next beat comes soon.
WAIT_BRIEFLY = {"sqlite": "PRAGMA busy_timeout = 1000", "postgresql": "SET lock_timeout = '1s'"}


@contextmanager
def lease(job: int, attempt: int, beat: Callable[[], object]) -> Iterator[None]:
    """Hold the file while the block runs, and call `beat` now and then over a connection of its own."""
    path, stop = _path(job, attempt), Event()
    thread = Thread(target=_beat_until, args=(stop, path, beat), name=f"heartbeat of job {job}", daemon=True)
    with _locked(path):
        thread.start()
        try:
            yield
        finally:
            stop.set()
            thread.join(SECONDS_TO_STOP)


def silence(job: int, attempt: int) -> timedelta | None:
    """How long a process that holds the lease has not beaten; None when no process holds it."""
    path = _path(job, attempt)
    try:
        with path.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        with suppress(FileNotFoundError):
            return timedelta(seconds=time.time() - path.stat().st_mtime)
    except FileNotFoundError:
        pass
    return None


def forget(job: int, attempt: int) -> None:
    """Remove what a killed process left."""
    _path(job, attempt).unlink(missing_ok=True)


def _path(job: int, attempt: int) -> Path:
    return settings.DATA_DIR / "leases" / f"job-{job}-{attempt}"


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        try:
            yield
        finally:
            path.unlink(missing_ok=True)


def _beat_until(stop: Event, path: Path, beat: Callable[[], object]) -> None:
    try:
        while not stop.wait(SECONDS_BETWEEN_BEATS):
            with suppress(OSError):
                os.utime(path)
            try:
                with connection.cursor() as cursor:
                    cursor.execute(WAIT_BRIEFLY[connection.vendor])
                beat()
            except DatabaseError:
                connection.close()
    finally:
        connections.close_all()  # this thread's only
