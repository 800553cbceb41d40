"""Real workers that are silent, stopped or killed in the middle of a job."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.ops.site import Site
from tests.services import postgres_url  # noqa: F401


def migrated(site: Site) -> Site:
    site.python("manage.py", "migrate", "--verbosity", "0")
    return site


@pytest.fixture(params=["sqlite", pytest.param("postgres", marks=pytest.mark.services)])
def site(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Site]:
    url = request.getfixturevalue("postgres_url") if request.param == "postgres" else ""
    made = migrated(Site(tmp_path, url))
    yield made
    made.sql("DELETE FROM gtm_hit_job")
    made.sql("DELETE FROM gtm_hit_dataset")


def start(site: Site, how: str, seconds: float) -> int:
    return int(site.python("-m", "tests.ops.jobs.long_job", how, str(seconds)))


def attempts_done(site: Site) -> list[str]:
    path = site.folder / "done"
    return path.read_text().split() if path.exists() else []


def children(pid: int) -> list[int]:
    found = subprocess.run(["pgrep", "-P", str(pid)], capture_output=True, text=True).stdout
    return [int(line) for line in found.split()]


def wait_for_start(site: Site, job: int, attempt: int = 1) -> None:
    site.wait_until(lambda: site.job(job) == {"state": "running", "attempts": attempt, "message": ""})


def holder(site: Site, job: int, attempt: int = 1) -> int:
    """The process that works on a job: it has the job's lease open."""
    lease = site.folder / "leases" / f"job-{job}-{attempt}"
    for descriptor in Path("/proc").glob("[0-9]*/fd/*"):
        try:
            if descriptor.readlink() == lease:
                return int(descriptor.parts[2])
        except OSError:
            continue
    raise AssertionError(f"nobody holds {lease}")


@contextmanager
def impatient(site: Site, processes: int = 2) -> Iterator[subprocess.Popen[bytes]]:
    with site.worker("tests.ops.jobs.long_job", processes) as worker:
        yield worker


@pytest.mark.parametrize("how", ["computing", "writing"])
def test_a_job_that_is_silent_for_long_is_done_once(site: Site, how: str) -> None:
    job = start(site, how, 14)
    with impatient(site):
        site.wait_until(lambda: site.job(job)["state"] == "done")
        time.sleep(5)  # nobody comes for it afterwards
    assert site.job(job) == {"state": "done", "attempts": 1, "message": ""}
    assert attempts_done(site) == ["1"]


def test_the_job_of_a_killed_process_is_soon_done_by_another(site: Site) -> None:
    job = start(site, "computing", 4)
    with impatient(site):
        wait_for_start(site, job)
        time.sleep(1)
        killed = time.monotonic()
        os.kill(holder(site, job), signal.SIGKILL)
        wait_for_start(site, job, 2)
        assert time.monotonic() - killed < 10  # a quarter of half a minute, and a busy machine
        site.wait_until(lambda: site.job(job)["state"] == "done")
    assert attempts_done(site) == ["2"]
    assert list((site.folder / "leases").iterdir()) == []


def test_a_stopped_worker_that_wakes_does_nothing_more_to_a_job_it_lost(site: Site) -> None:
    job = start(site, "computing", 6)
    with impatient(site, processes=3):
        wait_for_start(site, job)
        time.sleep(1)
        stopped = holder(site, job)
        os.kill(stopped, signal.SIGSTOP)
        try:
            site.wait_until(lambda: site.job(job)["state"] == "done")
        finally:
            os.kill(stopped, signal.SIGCONT)
        site.wait_until(lambda: f"job {job} is no longer attempt 1" in site.log())
    assert site.job(job) == {"state": "done", "attempts": 2, "message": ""}
    assert attempts_done(site) == ["2"]


def test_a_job_is_done_again_though_the_clock_was_killed_before_its_worker(tmp_path: Path) -> None:
    site = migrated(Site(tmp_path))
    with impatient(site, processes=1) as worker:
        # What a worker does at its start is over: only the clock can find the job.
        site.wait_until(lambda: bool(re.search("expire_exports.* succeeded", site.log())))
        job = start(site, "computing", 3)
        wait_for_start(site, job)
        before = children(worker.pid)
        assert len(before) == 2, before  # the clock and the pool's process
        for pid in before:
            os.kill(pid, signal.SIGKILL)
        site.wait_until(lambda: site.job(job)["state"] == "done")
        assert re.search(r"the clock was killed \(.*\); it is started again", site.log())
    assert site.job(job)["attempts"] == 2


def runs(pid: int) -> bool:
    """A dead child nobody has waited for runs no more."""
    try:
        return "State:\tZ" not in Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return False


def clock_of(worker: int) -> int:
    """The child that has closed what it inherited."""
    return min(children(worker), key=lambda pid: len(list(Path(f"/proc/{pid}/fd").iterdir())))


def test_a_clock_that_was_started_again_ends_with_its_worker(tmp_path: Path) -> None:
    site = migrated(Site(tmp_path))
    with impatient(site, processes=1) as worker:
        site.wait_until(lambda: "requeue_lost_jobs" in site.log().partition("ready.")[2])
        killed = clock_of(worker.pid)
        os.kill(killed, signal.SIGKILL)
        site.wait_until(lambda: "it is started again" in site.log() and len(children(worker.pid)) == 2)
        clock = clock_of(worker.pid)
        assert clock != killed
        worker.terminate()
        worker.wait(timeout=30)
        site.wait_until(lambda: not runs(clock))
