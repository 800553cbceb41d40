"""Remembering marks of every camera for the calibration in place."""

from __future__ import annotations

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import QuerySet
from django.utils.translation import gettext as _

from gtm_hit.calibration.drift.marks import DriftError, Marks, choose
from gtm_hit.models import Calibration, Camera, Dataset, DriftMarks
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.drift.pictures import DriftRefused, Span, frames_in, grey, images_of
from gtm_hit.ops.jobs.progress import Progress, no_progress

REMEMBERING = "remembering marks"
PICTURES = 9  # of each camera; the median of so many has nobody in it who walks
BEGINNING = 90  # frames at the beginning of which they are taken where nobody says which


def remembered(dataset: Dataset) -> QuerySet[DriftMarks]:
    """Marks for the calibration in place; what they look like is fetched when asked for."""
    found = DriftMarks.objects.filter(calibration=versions.in_place_id(dataset.pk))
    return found.select_related("camera", "calibration").defer("content", "calibration__cameras")


def remember(
    dataset: Dataset, span: Span | None = None, progress: Progress = no_progress, user: User | None = None
) -> list[DriftMarks]:
    """Take marks from frames in which the cameras stood as calibrated; replaces those there were.

    All cameras' or none's: raises DriftRefused, and nothing is changed then.
    """
    calibration = in_place(dataset)
    frames = frames_in(dataset, span or Span())
    if span is None or span == Span():
        frames = frames[:BEGINNING]
    frames = _spread(frames)
    rows = []
    cameras = list(dataset.cameras.all())
    for done, camera in enumerate(cameras):
        progress(REMEMBERING, done, len(cameras))
        marks, numbers = _marks(camera, frames)
        rows.append(_row(calibration, camera, marks, numbers, user))
    progress(REMEMBERING, len(cameras), len(cameras))
    with transaction.atomic():
        DriftMarks.objects.filter(calibration=calibration).delete()
        return DriftMarks.objects.bulk_create(rows)


def in_place(dataset: Dataset) -> Calibration:
    found = versions.in_place(dataset)
    if found is None:
        raise DriftRefused(_("The dataset has no calibration yet."))
    return found


def _spread(frames: list[int]) -> list[int]:
    count = min(PICTURES, len(frames))
    return [frames[index * len(frames) // count] for index in range(count)]


def _marks(camera: Camera, frames: list[int]) -> tuple[Marks, list[int]]:
    images = images_of(camera, frames)
    if not images:
        raise DriftRefused(_("%(camera)s has no picture in these frames.") % {"camera": camera})
    try:
        return choose([grey(image) for _number, image in images]), [number for number, _image in images]
    except DriftError as error:
        raise DriftRefused(f"{camera}: {error}.") from error


def _row(
    calibration: Calibration, camera: Camera, marks: Marks, frames: list[int], user: User | None
) -> DriftMarks:
    return DriftMarks(
        calibration=calibration,
        camera=camera,
        frames=frames,
        count=len(marks.marks),
        content=marks.as_json(),
        created_by=user,
    )
