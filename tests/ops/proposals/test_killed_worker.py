"""A worker that is killed in the middle of proposing: nothing is lost, and nothing is done twice."""

from __future__ import annotations

from pathlib import Path

from tests.ops.proposals.slow_run import FRAMES
from tests.ops.site import Site

APP = "tests.ops.proposals.slow_run"


def looked(site: Site) -> list[int]:
    file = site.folder / "looked"
    return [int(line) for line in file.read_text().split()] if file.exists() else []


def kept(site: Site) -> int:
    return int(site.sql("SELECT count(*) FROM gtm_hit_proposalframe")[0][0])


def test_another_worker_goes_on_where_the_killed_one_was(tmp_path: Path) -> None:
    site = Site(tmp_path)
    site.python("manage.py", "migrate", "--verbosity", "0")
    job = int(site.python("-m", APP))
    with site.worker(APP):
        site.wait_until(lambda: kept(site) >= 5)
    before = kept(site)
    assert 5 <= before < FRAMES
    assert site.job(job)["state"] == "running"

    site.half_a_minute_passes()
    with site.worker(APP):
        site.wait_until(lambda: site.job(job)["state"] in {"done", "failed"})
    assert site.job(job) == {"state": "done", "attempts": 2, "message": ""}
    assert kept(site) == FRAMES
    people, tracks = site.sql("SELECT count(*), count(DISTINCT track) FROM gtm_hit_proposal")[0]
    assert (people, tracks) == (FRAMES, 1)
    numbers = looked(site)
    assert sorted(set(numbers)) == list(range(0, 5 * FRAMES, 5))
    assert len(numbers) <= FRAMES + 1  # the one it was looking at when it was killed
