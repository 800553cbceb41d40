"""Imports as jobs: of a folder or archive, and of videos."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

from django.conf import settings
from django.contrib.auth.models import User

from gtm_hit.formats.problems import FormatError, Problem
from gtm_hit.models import Dataset, Job
from gtm_hit.ops.datasets.importing import ImportFailed, ImportReport, import_dataset
from gtm_hit.ops.datasets.options import ImportOptions, SceneValues
from gtm_hit.ops.datasets.videos.importing import import_videos
from gtm_hit.ops.datasets.videos.options import VideoOptions, VideoSource
from gtm_hit.ops.datasets.videos.plan import USUAL
from gtm_hit.ops.files import sources
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import UNPACKING, WRITING, percents, steps

SHARES = {
    UNPACKING: (0, 20),
    "reading image headers": (20, 23),
    "reading annotations": (23, 26),
    "computing rectangles": (26, 35),
    "checking images": (35, 95),
    "making images": (35, 95),
    WRITING: (95, 100),
}


def start_import(source: sources.Source, options: dict[str, Any], user: User | None = None) -> Job:
    """`options` are fields of ImportOptions, but for the folder."""
    parameters = {"source": source.key, "options": options}
    return queue.create_once(Job.Kind.IMPORT_DATASET, _dataset(options), parameters, user)


def start_videos(
    source: sources.Source,
    options: dict[str, Any],
    videos: list[VideoSource],
    start: float = 0.0,
    until: float | None = None,
    user: User | None = None,
) -> Job:
    """Videos by their paths seen from the source's folder; calibrations lie in the same folder."""
    parameters = {
        "source": source.key,
        "options": options,
        "videos": [[each.camera, str(each.path), each.offset, each.drift] for each in videos],
        "start": start,
        "until": until,
    }
    return queue.create_once(Job.Kind.IMPORT_VIDEOS, _dataset(options), parameters, user)


def video_values(slug: str, preset: str | None, given: SceneValues) -> SceneValues:
    """With WILDTRACK's frames where neither a preset nor the dataset says which to take."""
    known = preset or Dataset.objects.filter(slug=slug).exists()
    return given if known else SceneValues(**{**USUAL, **given})


def run_import(mine: queue.Run) -> dict[str, Any]:
    """The operation of an import job. A worker that takes it up again finds what it has written."""
    if not mine.job.result:
        _import(mine, _source(mine))
    sources.let_go(mine.job.parameters["source"], mine.job)
    return mine.job.result


def _import(mine: queue.Run, source: sources.Source) -> None:
    progress = percents(mine, SHARES)

    def remember(found: ImportReport) -> None:
        # In the import's own transaction: there is never one its job does not know of.
        mine.keep(dataset=found.dataset, result=_result(found))

    def work() -> dict[str, Any]:
        with sources.unpacked(source, mine.job, partial(progress, UNPACKING)) as folder:
            options = ImportOptions(folder=folder, **mine.job.parameters["options"])
            return _result(import_dataset(options, progress, remember))

    mine.job.result = _or_problems(work, "nothing was imported")


def _result(found: ImportReport) -> dict[str, Any]:
    return {
        "dataset": found.dataset.slug,
        "layer": found.layer.name if found.layer else "",
        "frames": found.frames_added,
        "images": found.images_added,
        "people": found.people_added,
        "notes": found.notes,
    }


def run_videos(mine: queue.Run) -> dict[str, Any]:
    source, parameters = _source(mine), mine.job.parameters

    def remember(part: ImportReport) -> None:
        # In the part's own transaction: whoever lost the job adds nothing.
        mine.keep(dataset=part.dataset)

    def work() -> dict[str, Any]:
        found = import_videos(video_options(source, parameters), steps(mine), remember)
        return {
            "dataset": parameters["options"]["slug"],
            "frames": found.frames_added,
            "images": found.images_added,
            "known": found.frames_known,
            "notes": found.notes,
        }

    return _or_problems(work, "frames taken before stay")


def video_options(source: sources.Source, parameters: dict[str, Any]) -> VideoOptions:
    """Raises JobError for a video outside the source's folder, whatever a job's row says."""
    root = source.path.resolve()
    videos = []
    for camera, name, offset, *drift in parameters["videos"]:  # jobs from before know none
        path = (root / name).resolve()
        if not path.is_relative_to(root):
            raise queue.JobError(f"{name} does not lie in {source.key}.")
        videos.append(VideoSource(camera, path, offset, *drift))
    until = parameters["until"]
    dataset = ImportOptions(folder=source.path, **parameters["options"])
    return VideoOptions(dataset, tuple(videos), parameters["start"], math.inf if until is None else until)


def _or_problems(work: Callable[[], dict[str, Any]], consequence: str) -> dict[str, Any]:
    try:
        return work()
    except ImportFailed as error:
        problems = error.problems
    except FormatError as error:
        problems = error.relative_to(settings.UPLOADS_ROOT).problems
    raise queue.JobError(told(problems, consequence))


def told(problems: tuple[Problem, ...], consequence: str) -> str:
    """Without where this server keeps its data: what is read has no other place for whoever asked."""
    count = f"{len(problems)} problem{'s' * (len(problems) > 1)}; {consequence}:"
    lines = FormatError(problems).relative_to(settings.DATA_DIR).problems
    return "\n".join([count, *map(str, lines)])


def _source(mine: queue.Run) -> sources.Source:
    key = mine.job.parameters["source"]
    found = sources.source(key)
    if found is None:
        raise queue.JobError(f"{key} is no longer there.")
    return found


def _dataset(options: dict[str, Any]) -> Dataset | None:
    return Dataset.objects.filter(slug=options["slug"]).first()
