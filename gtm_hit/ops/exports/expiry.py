"""The end of exports: their files go after EXPORT_KEEP_DAYS, or when somebody deletes them. Releases stay."""

from __future__ import annotations

import re
import shutil
from datetime import datetime, timedelta
from enum import StrEnum
from pathlib import Path

from django.conf import settings

from gtm_hit.models import Job
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.ground import table_sweep

OLDEST_UNFINISHED = timedelta(days=1)
_MADE_BY_JOB = re.compile(r".+-(?P<job>\d+)(?:\.zip)?")


class Removed(StrEnum):
    """Why a job's files are gone; stands in its result as `removed`."""

    EXPIRED = "expired"
    DELETED = "deleted"


def removed(job: Job) -> Removed | None:
    reason = job.result.get("removed")
    return Removed(reason) if reason else None


def expires_at(job: Job) -> datetime | None:
    """When the files of a finished export will be removed; None for never, or when there are none."""
    if not (exporting.made_files(job) and job.finished_at and settings.EXPORT_KEEP_DAYS):
        return None
    return job.finished_at + timedelta(days=settings.EXPORT_KEEP_DAYS)


def delete(job: Job, reason: Removed = Removed.DELETED) -> bool:
    """Remove the files of a finished export; whether there were any. The job stays, and can be done again."""
    if not exporting.made_files(job):
        return False
    folder = settings.EXPORTS_ROOT / job.result["folder"]
    _remove(folder)
    _remove(exporting.archive_of(folder))
    # Last: whoever is killed before finds the files' row again.
    job.result = {**job.result, "removed": reason}
    Job.objects.filter(pk=job.pk).update(result=job.result)
    return True


def expire(now: datetime) -> int:
    """Remove what is older than EXPORT_KEEP_DAYS, and what no job knows of; how many exports expired."""
    _remove_unfinished_tables(now)
    table_sweep.sweep(now)
    if not settings.EXPORT_KEEP_DAYS:
        return 0
    oldest = now - timedelta(days=settings.EXPORT_KEEP_DAYS)
    old = Job.objects.filter(
        kind=Job.Kind.EXPORT_LAYER, state=Job.State.DONE, finished_at__lt=oldest, result__removed__isnull=True
    )
    count = sum(delete(job, Removed.EXPIRED) for job in old.iterator())
    _remove_orphans(oldest)
    return count


def _remove_orphans(oldest: datetime) -> None:
    """Files of jobs that were deleted with their dataset."""
    if not settings.EXPORTS_ROOT.is_dir():
        return
    for path in list(settings.EXPORTS_ROOT.iterdir()):
        match = _MADE_BY_JOB.fullmatch(path.name)
        if not match or exporting.PARTIAL.fullmatch(path.name):
            continue
        old = path.stat().st_mtime < oldest.timestamp()
        if old and not Job.objects.filter(pk=int(match["job"])).exists():
            _remove(path)


def _remove_unfinished_tables(now: datetime) -> None:
    """Rectangle tables and grid files whose process was killed while it made them."""
    oldest = (now - OLDEST_UNFINISHED).timestamp()
    for pattern in (".rectangles-*", ".grid-*"):
        for path in settings.TABLES_ROOT.glob(pattern):
            if path.stat().st_mtime < oldest:
                _remove(path)


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)
