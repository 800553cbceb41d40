"""Exports by a real Celery worker, and what a killed one leaves behind."""

from __future__ import annotations

from pathlib import Path

import pytest

from gtm_hit.formats.manifest import verify
from tests.ops.export_scene import FRAMES, LAYER, SLUG
from tests.ops.site import Site
from tests.services import postgres_url, redis_url  # noqa: F401


def built(site: Site) -> Site:
    site.python("manage.py", "migrate", "--verbosity", "0")
    site.python("-m", "tests.ops.export_scene", "build")
    return site


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Site:
    """One machine: SQLite in a file, the broker in a folder."""
    return built(Site(tmp_path_factory.mktemp("site")))


@pytest.fixture(scope="module")
def production(
    tmp_path_factory: pytest.TempPathFactory,
    postgres_url: str,  # noqa: F811
    redis_url: str,  # noqa: F811
) -> Site:
    return built(Site(tmp_path_factory.mktemp("production"), postgres_url, redis_url))


def start(site: Site) -> int:
    return int(site.python("-m", "tests.ops.export_scene", "start"))


def undisturbed(site: Site) -> Path:
    folder = site.folder / "undisturbed"
    if not folder.exists():
        site.python("manage.py", "exportlayer", SLUG, LAYER, str(folder))
    return folder


def wait_for_frames(site: Site, job: int, count: int = 20) -> None:
    site.wait_until(lambda: len(list(site.exports.glob(f"*.partial-{job}-*/content/*/*.json"))) >= count)


def contents(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()
    }


def check_killed_in_the_middle(site: Site) -> None:
    expected = undisturbed(site)
    job = start(site)
    with site.worker():
        wait_for_frames(site, job)
    name = f"{SLUG}-{LAYER}-{job}"
    assert site.job(job)["state"] == "running"
    assert site.names() == [f"{name}.partial-{job}-1"]

    site.half_a_minute_passes()
    with site.worker():
        site.wait_until(lambda: site.job(job)["state"] in {"done", "failed"})
        site.wait_until(lambda: not any("partial" in each for each in site.names()))

    assert site.job(job) == {"state": "done", "attempts": 2, "message": ""}
    assert site.names() == [name, f"{name}.zip"]
    folder = site.exports / name
    assert verify(folder) == []
    assert contents(folder) == contents(expected)
    assert len(list((folder / "annotations_positions").iterdir())) == FRAMES
    assert folder.with_name(f"{name}.zip").read_bytes() == expected.with_name("undisturbed.zip").read_bytes()


@pytest.fixture(autouse=True)
def empty_exports(request: pytest.FixtureRequest) -> None:
    for name in {"site", "production"} & set(request.fixturenames):
        used: Site = request.getfixturevalue(name)
        used.python("-c", "import shutil, sys; shutil.rmtree(sys.argv[1], True)", str(used.exports))


def test_a_worker_killed_in_the_middle_leaves_one_complete_export_in_the_end(site: Site) -> None:
    check_killed_in_the_middle(site)


@pytest.mark.services
def test_a_killed_worker_is_made_good_on_postgresql_and_redis_too(production: Site) -> None:
    check_killed_in_the_middle(production)


def test_the_clock_finds_a_job_whose_message_was_lost(site: Site) -> None:
    job = start(site)
    for message in (site.folder / "broker" / "queue").iterdir():
        message.unlink()
    with site.worker():
        site.wait_until(lambda: "requeue_lost_jobs" in site.log().partition("ready.")[2])
        site.half_a_minute_passes()
        site.wait_until(lambda: site.job(job)["state"] == "done")
    assert site.job(job)["attempts"] == 1


def test_cancelling_stops_a_running_export_and_leaves_no_file(site: Site) -> None:
    job = start(site)
    with site.worker():
        wait_for_frames(site, job)
        site.sql("UPDATE gtm_hit_job SET cancel_requested = ? WHERE id = ?", True, job)
        site.wait_until(lambda: site.job(job)["state"] == "cancelled")
    assert site.names() == []
