"""The first guess as a job; what it found is kept with the draft, which stays as it is."""

from __future__ import annotations

from typing import Any

from django.contrib.auth.models import User

from gtm_hit.models import Job, VideoSync
from gtm_hit.ops.files import sources
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import Progress, steps
from gtm_hit.ops.sync import drafts
from gtm_hit.ops.sync.guessing import SyncRefused, Video, guess


def start(draft: VideoSync, user: User | None = None) -> Job:
    """The same source again finds the job that is under way."""
    parameters = {"source": draft.source, "sync": draft.pk}
    return queue.create_once(Job.Kind.SYNC_VIDEOS, None, parameters, user)


def under_way(draft: VideoSync) -> Job | None:
    waiting = [Job.State.QUEUED, Job.State.RUNNING]
    found = Job.objects.filter(kind=Job.Kind.SYNC_VIDEOS, parameters__sync=draft.pk, state__in=waiting)
    return found.first()


def run(mine: queue.Run) -> dict[str, Any]:
    draft = VideoSync.objects.filter(pk=mine.job.parameters["sync"]).first()
    if draft is None:
        raise queue.JobError(f"{mine.job.parameters['source']} is no longer there.")
    try:
        found = make_guess(draft, steps(mine))
    except SyncRefused as error:
        raise queue.JobError(str(error)) from error
    with mine.holding(1, 1):
        keep(draft, found)
    return {"sync": draft.pk, **found}


def keep(draft: VideoSync, found: dict[str, Any]) -> None:
    VideoSync.objects.filter(pk=draft.pk).update(guess=found)


def make_guess(draft: VideoSync, progress: Progress) -> dict[str, Any]:
    """What `keep` keeps. Raises SyncRefused."""
    source = sources.source(draft.source)
    if source is None:
        raise SyncRefused(f"{draft.source} is no longer there.")
    clocks = [clock for clock in drafts.current(draft).clocks if clock.used]
    videos = [Video(clock.camera, source.path / clock.file) for clock in clocks]
    calibrations = source.path / "calibrations"
    result = guess(videos, calibrations if calibrations.exists() else None, progress=progress).as_json()
    for place, clock in zip(result["places"], clocks, strict=True):
        place["file"] = clock.file
    return result
