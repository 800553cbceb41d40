from __future__ import annotations

import os
from datetime import timedelta
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from django.core.management import call_command
from django.utils import timezone

from gtm_hit.models import Job, LayerFrame
from gtm_hit.ops.exports import expiry, exporting
from gtm_hit.ops.jobs import queue
from tests.work_scene import make_dataset, make_layer

pytestmark = pytest.mark.django_db

NOW = timezone.now()
LATER = NOW + timedelta(days=31)


@pytest.fixture
def job(exports: Path) -> Job:
    dataset = make_dataset()
    layer = make_layer(dataset)
    LayerFrame.objects.create(layer=layer, frame=dataset.frames.all()[0], revision=1)
    started = exporting.start(layer)
    queue.run(started.pk, {started.kind: exporting.run})
    started.refresh_from_db()
    return started


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_files_of_an_export_are_kept_for_the_days_that_are_set(job: Job, exports: Path) -> None:
    assert expiry.expires_at(job) == job.finished_at + timedelta(days=30)  # type: ignore[operator]
    assert expiry.expire(NOW + timedelta(days=29)) == 0
    assert len(names(exports)) == 2
    assert expiry.expire(LATER) == 1
    assert names(exports) == []


def test_an_expired_export_says_so_and_is_not_counted_again(job: Job) -> None:
    expiry.expire(LATER)
    job.refresh_from_db()
    assert expiry.removed(job) is expiry.Removed.EXPIRED
    assert exporting.finished(job) is expiry.expires_at(job) is None
    assert job.result["counts"]["frames"] == 1
    assert expiry.expire(LATER) == 0


def test_whoever_was_killed_in_the_middle_is_followed_by_one_that_ends_it(job: Job, exports: Path) -> None:
    done = exporting.finished(job)
    assert done is not None
    done.archive.unlink()
    assert expiry.expire(LATER) == 1
    assert names(exports) == []


def test_zero_days_keep_everything(job: Job, exports: Path, settings: Any) -> None:
    settings.EXPORT_KEEP_DAYS = 0
    assert expiry.expire(LATER) == 0
    assert len(names(exports)) == 2
    assert expiry.expires_at(job) is None


def test_files_are_deleted_once(job: Job, exports: Path) -> None:
    assert expiry.delete(job)
    assert not expiry.delete(job)
    assert names(exports) == []
    job.refresh_from_db()
    assert expiry.removed(job) is expiry.Removed.DELETED


def test_files_of_jobs_that_are_gone_go_too_and_what_is_no_export_stays(job: Job, exports: Path) -> None:
    kept = names(exports)
    for name in ("square-own-999", "square-own-999.zip", "by hand", "young-998"):
        (exports / name).mkdir()
    old = (NOW - timedelta(days=40)).timestamp()
    for path in exports.iterdir():
        if path.name != "young-998":
            os.utime(path, (old, old))
    expiry.expire(NOW)
    assert names(exports) == sorted([*kept, "by hand", "young-998"])


def test_the_command_and_the_clock_do_the_same(job: Job, exports: Path, settings: Any) -> None:
    from annotator.celery import app
    from gtm_hit import tasks

    assert app.conf.beat_schedule["expire-exports"]["task"] == tasks.expire_exports.name
    Job.objects.update(finished_at=NOW - timedelta(days=40))
    out = StringIO()
    settings.UPLOADS_ROOT = exports / "uploads"
    call_command("cleanup", stdout=out)
    assert out.getvalue() == "1 expired exports removed; exports are kept for 30 days.\n"
    assert names(exports) == []
