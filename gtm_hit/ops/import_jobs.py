"""Imports as jobs: of a folder or archive, and of videos."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from django.conf import settings
from django.contrib.auth.models import User

from gtm_hit.formats.problems import FormatError, Problem
from gtm_hit.models import Dataset, Job
from gtm_hit.ops import jobs, uploads
from gtm_hit.ops.importing.dataset import ImportFailed, import_dataset
from gtm_hit.ops.importing.options import ImportOptions, SceneValues
from gtm_hit.ops.videos.importing import import_videos
from gtm_hit.ops.videos.options import VideoOptions, VideoSource
from gtm_hit.ops.videos.plan import USUAL

UNPACKING = "unpacking"
WRITING = "writing to the database"
# Percents of the whole at which each phase begins and ends.
SHARES = {
    UNPACKING: (0, 20),
    "reading image headers": (20, 23),
    "reading annotations": (23, 26),
    "computing rectangles": (26, 35),
    "checking images": (35, 95),
    "making images": (35, 95),
    WRITING: (95, 100),
}


def start_import(source: uploads.Source, options: dict[str, Any], user: User | None = None) -> Job:
    """`options` are fields of ImportOptions, but for the folder."""
    parameters = {"source": source.key, "options": options}
    return jobs.create_once(Job.Kind.IMPORT_DATASET, _dataset(options), parameters, user)


def start_videos(
    source: uploads.Source,
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
        "videos": [[each.camera, str(each.path), each.offset] for each in videos],
        "start": start,
        "until": until,
    }
    return jobs.create_once(Job.Kind.IMPORT_VIDEOS, _dataset(options), parameters, user)


def video_values(slug: str, preset: str | None, given: SceneValues) -> SceneValues:
    """With WILDTRACK's frames where neither a preset nor the dataset says which to take."""
    known = preset or Dataset.objects.filter(slug=slug).exists()
    return given if known else SceneValues(**{**USUAL, **given})


def run_import(mine: jobs.Run) -> dict[str, Any]:
    source = _source(mine)

    def report(phase: str, done: int, total: int) -> None:
        start, end = SHARES[phase]
        steps = start + (end - start) * done // max(total, 1)
        # What is written cannot be taken back by pressing Cancel.
        tell = mine.confirm if (phase, done) == (WRITING, 0) else mine.report
        tell(steps, 100, f"{phase}: {done} of {total}")

    def work() -> dict[str, Any]:
        with uploads.unpacked(source, mine.job, lambda *steps: report(UNPACKING, *steps)) as folder:
            found = import_dataset(ImportOptions(folder=folder, **mine.job.parameters["options"]), report)
        _belongs_to(mine.job, found.dataset)
        return {
            "dataset": found.dataset.slug,
            "layer": found.layer.name if found.layer else "",
            "frames": found.frames_added,
            "images": found.images_added,
            "people": found.people_added,
            "notes": found.notes,
        }

    result = _or_problems(work, "nothing was imported")
    if source.was_uploaded:
        source.path.unlink(missing_ok=True)
    return result


def run_videos(mine: jobs.Run) -> dict[str, Any]:
    source, parameters = _source(mine), mine.job.parameters

    def report(phase: str, done: int, total: int) -> None:
        mine.report(done, total, f"{phase}: {done} of {total}")

    def work() -> dict[str, Any]:
        found = import_videos(video_options(source, parameters), report)
        if found.dataset is not None:
            _belongs_to(mine.job, found.dataset)
        return {
            "dataset": parameters["options"]["slug"],
            "frames": found.frames_added,
            "images": found.images_added,
            "known": found.frames_known,
            "notes": found.notes,
        }

    return _or_problems(work, "frames taken before stay")


def video_options(source: uploads.Source, parameters: dict[str, Any]) -> VideoOptions:
    """Raises JobError for a video outside the source's folder, whatever a job's row says."""
    root = source.path.resolve()
    videos = []
    for camera, name, offset in parameters["videos"]:
        path = (root / name).resolve()
        if not path.is_relative_to(root):
            raise jobs.JobError(f"{name} does not lie in {source.key}.")
        videos.append(VideoSource(camera, path, offset))
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
    raise jobs.JobError(told(problems, consequence))


def told(problems: tuple[Problem, ...], consequence: str) -> str:
    """Without where this server keeps its data: what is read has no other place for whoever asked."""
    count = f"{len(problems)} problem{'s' * (len(problems) > 1)}; {consequence}:"
    lines = FormatError(problems).relative_to(settings.DATA_DIR).problems
    return "\n".join([count, *map(str, lines)])


def _source(mine: jobs.Run) -> uploads.Source:
    key = mine.job.parameters["source"]
    found = uploads.source(key)
    if found is None:
        raise jobs.JobError(f"{key} is no longer there.")
    return found


def _dataset(options: dict[str, Any]) -> Dataset | None:
    return Dataset.objects.filter(slug=options["slug"]).first()


def _belongs_to(job: Job, dataset: Dataset) -> None:
    Job.objects.filter(pk=job.pk).update(dataset=dataset)
