"""The program as it runs for real: its own processes, data folder, database and broker."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psycopg

from tests.conftest import REPOSITORY

PATIENCE = 60  # seconds; machines that run tests are busy


class Site:
    def __init__(self, folder: Path, database: str = "", broker: str = "") -> None:
        self.folder = folder
        self.exports = folder / "exports"
        self.database = database
        self.environment = {
            **os.environ,
            "SECRET_KEY": "site-" + "k" * 40,
            "DATA_DIR": str(folder),
            "DJANGO_SETTINGS_MODULE": "annotator.settings",
            "DATABASE_URL": database or f"sqlite:///{folder}/gtm.sqlite3",
            "CELERY_BROKER_URL": broker or "filesystem://",
        }

    def python(self, *arguments: str) -> str:
        """Run a program to its end and give back what it printed."""
        finished = subprocess.run(
            [sys.executable, *arguments],
            cwd=REPOSITORY,
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )
        assert finished.returncode == 0, finished.stderr
        return finished.stdout

    @contextmanager
    def worker(self, app: str = "annotator", processes: int = 1) -> Iterator[subprocess.Popen[bytes]]:
        """A Celery worker with its clock; killed at the end like by a power cut."""
        command = [sys.executable, "-m", "celery", "-A", app, "worker", "-B"]
        command += ["-c", str(processes), "-l", "INFO"]
        with (self.folder / "worker.log").open("wb") as log:
            process = subprocess.Popen(
                command, cwd=REPOSITORY, env=self.environment, stdout=log, stderr=log, start_new_session=True
            )
            try:
                yield process
            finally:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait(timeout=PATIENCE)

    def sql(self, statement: str, *values: Any) -> list[tuple[Any, ...]]:
        if self.database:
            with psycopg.connect(self.database) as connection:
                cursor = connection.execute(statement.replace("?", "%s"), values)
                return cursor.fetchall() if cursor.description else []
        with sqlite3.connect(self.folder / "gtm.sqlite3", timeout=PATIENCE) as database:
            return database.execute(statement, values).fetchall()

    def job(self, pk: int) -> dict[str, Any]:
        state, attempts, message = self.sql(
            "SELECT state, attempts, message FROM gtm_hit_job WHERE id = ?", pk
        )[0]
        return {"state": state, "attempts": attempts, "message": message}

    def half_a_minute_passes(self) -> None:
        """For the jobs' signs of life; cheaper than waiting."""
        self.sql("UPDATE gtm_hit_job SET heartbeat_at = ?", "2020-01-01 00:00:00")

    def names(self) -> list[str]:
        return sorted(path.name for path in self.exports.glob("*"))

    def log(self) -> str:
        return (self.folder / "worker.log").read_text()[-4000:]

    def wait_until(self, condition: Callable[[], bool]) -> None:
        for _ in range(PATIENCE * 20):
            if condition():
                return
            time.sleep(0.05)
        raise AssertionError(f"it did not happen; the worker's log ends with:\n{self.log()}")
