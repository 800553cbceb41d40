"""Comparing frames with the marks: what each camera did over a range of frames."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django.contrib.auth.models import User
from django.utils.translation import gettext as _

from gtm_hit.calibration.drift.checking import MOVED, WARN, Drift, check
from gtm_hit.calibration.drift.marks import DriftError, marks_of
from gtm_hit.models import Dataset, DriftCheck, DriftMarks, Job
from gtm_hit.ops.drift.pictures import DriftRefused, Span, frames_in, grey, images_of
from gtm_hit.ops.drift.remembering import in_place
from gtm_hit.ops.jobs.progress import Progress, no_progress

__all__ = ["NOTHING_REMEMBERED", "WARN", "check_frames"]

CHECKING = "comparing with the marks"
NOTHING_REMEMBERED = "No marks are remembered for the calibration in place. Remember marks first."


def check_frames(
    dataset: Dataset,
    span: Span,
    progress: Progress = no_progress,
    user: User | None = None,
    job: Job | None = None,
) -> DriftCheck:
    """Raises DriftRefused. A job that runs again writes over what it wrote."""
    calibration = in_place(dataset)
    frames = frames_in(dataset, span)
    rows = list(DriftMarks.objects.filter(calibration=calibration).select_related("camera"))
    if not rows:
        raise DriftRefused(_(NOTHING_REMEMBERED))
    cameras = []
    for done, row in enumerate(rows):
        cameras.append(_camera(row, frames, progress, done * len(frames), len(rows) * len(frames)))
    progress(CHECKING, len(rows) * len(frames), len(rows) * len(frames))
    values = {
        "calibration": calibration,
        "frames": frames,
        "cameras": cameras,
        "warns": any(camera["state"] == MOVED for camera in cameras),
        "created_by": user,
    }
    if job is None:
        return DriftCheck.objects.create(dataset=dataset, **values)
    return DriftCheck.objects.update_or_create(job=job, dataset=dataset, defaults=values)[0]


def _camera(row: DriftMarks, frames: Sequence[int], progress: Progress, before: int, total: int) -> Any:
    marks, camera = marks_of(row.content), row.camera.calibrated
    told: list[tuple[int, str, Drift]] = []
    for done, (number, image) in enumerate(images_of(row.camera, frames)):
        progress(CHECKING, before + done, total)
        try:
            told.append((number, image.light_digest, check(row.camera.name, marks, grey(image), camera)))
        except DriftError as error:
            raise DriftRefused(f"{error}.") from error
    if not told:
        raise DriftRefused(_("%(camera)s has no picture in these frames.") % {"camera": row.camera})
    return _summary(told)


def _summary(told: Sequence[tuple[int, str, Drift]]) -> dict[str, Any]:
    """The frame in which the camera is farthest off speaks for all, and it is told since when it is off."""
    number, image, worst = max(told, key=lambda each: each[2].most_px or 0.0)
    since = next((frame for frame, _image, drift in told if drift.state == MOVED), None)
    verdict = worst.verdict
    if since is not None and since != told[0][0]:
        verdict = f"{verdict[:-1]}, first seen in frame {since}."
    return {
        **worst.as_json(),
        "verdict": verdict,
        "frame": number,
        "image": image,
        "since": since,
        "series": [[frame, _rounded(drift.most_px), _rounded(drift.cm)] for frame, _image, drift in told],
    }


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 3)
