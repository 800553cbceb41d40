"""The change of calibration as a job: it compares, and waits for somebody to confirm."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django.contrib.auth.models import User
from django.db import transaction
from django.utils import timezone

from gtm_hit.formats.calibration.cameras_json import camera_facts
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Dataset, Job
from gtm_hit.ops.access.roles import Somebody, may_know
from gtm_hit.ops.calibration import replacing, versions
from gtm_hit.ops.calibration.replacing import ReplacementError
from gtm_hit.ops.drift import job as drift_job
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import percents

SHARES = {replacing.COMPARING: (0, 100)}


def start(
    dataset: Dataset,
    cameras: Sequence[Camera],
    user: User | None = None,
    source: str = "",
    version: int = 0,
    report: dict[str, Any] | None = None,
) -> Job:
    """The numbers go into the job's row: no file has to outlive the request.

    `source`: where they come from, in words; `version`: their number where the dataset had them before;
    `report`: a desk's, which is kept with them when they are put in place.
    """
    parameters = {
        "cameras": [camera_facts(camera) for camera in cameras],
        "source": source,
        "version": version or None,
        **({"report": report} if report else {}),
    }
    return queue.create_once(Job.Kind.REPLACE_CALIBRATION, dataset, parameters, user)


def start_version(dataset: Dataset, number: int, user: User | None = None) -> Job:
    """Compare with a calibration the dataset had before. Raises UnknownVersion."""
    found = versions.version(dataset, number)
    return start(dataset, versions.cameras_in(found), user, versions.gone_back(number), number)


def run(mine: queue.Run) -> dict[str, Any]:
    assert mine.job.dataset is not None
    return replacing.preview(mine.job.dataset, cameras_of(mine.job), percents(mine, SHARES))


def confirm(job: Job, user: User | None = None) -> None:
    """Put a finished job's cameras in place, once. Raises ReplacementError."""
    with transaction.atomic():
        # Dataset before job, as everywhere.
        Dataset.objects.select_for_update().filter(jobs=job).first()
        job = Job.objects.select_for_update().get(pk=job.pk)
        if job.kind != Job.Kind.REPLACE_CALIBRATION or job.state != Job.State.DONE or job.dataset is None:
            raise ReplacementError("There is no finished comparison to confirm.")
        if "confirmed_at" in job.result:
            raise ReplacementError("This calibration was put in place before.")
        placed = replacing.replace_calibration(
            job.dataset,
            cameras_of(job),
            job.result,
            job.parameters.get("source", ""),
            user,
            job.parameters.get("report"),
        )
        confirmed = {
            "confirmed_at": timezone.now().isoformat(),
            "confirmed_by": str(user or ""),
            "calibration": placed.number,
        }
        job.result = {**job.result, **confirmed}
        job.save(update_fields=["result"])
        drift_job.start_by_itself(job.dataset, user)


def seen_by(user: Somebody, job: Job) -> dict[str, Any]:
    """What a finished job found, without people of layers that somebody may not read."""
    assert job.dataset is not None
    kept = set(job.dataset.layers.filter(hidden=True).values_list("name", flat=True))
    if not kept or may_know(user, job.dataset):
        return job.result
    worst = [moved for moved in job.result["worst"] if moved["layer"] not in kept]
    picture = job.result["picture"]
    if picture["layer"] in kept:
        nobody: list[Any] = [[] for _ in picture["before"]]
        picture = {**picture, "layer": None, "before": nobody, "after": nobody}
    return {**job.result, "worst": worst, "picture": picture}


def cameras_of(job: Job) -> list[Camera]:
    return [Camera(index=index, **facts) for index, facts in enumerate(job.parameters["cameras"])]
