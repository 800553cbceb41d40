"""Frames of a dataset that are looked at, and their pictures in grey."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from django.core.files.storage import default_storage
from django.utils.translation import gettext as _

from gtm_hit.calibration.drift.marks import Grey
from gtm_hit.models import Camera, Dataset, Image
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.files.images import storage_name


class DriftRefused(OperationError, ValueError):
    """Nothing can be remembered or compared; says why."""


@dataclass(frozen=True)
class Span:
    """Frames from `first` to `last`, by number and both included; of these every n-th."""

    first: int | None = None
    last: int | None = None
    every: int = 1


def frames_in(dataset: Dataset, span: Span) -> list[int]:
    """Numbers of the frames that have pictures. Raises DriftRefused where there is none."""
    if span.every < 1:
        raise DriftRefused(_("Every 1st frame is the most that can be looked at."))
    frames = dataset.frames.filter(images__isnull=False)
    if span.first is not None:
        frames = frames.filter(number__gte=span.first)
    if span.last is not None:
        frames = frames.filter(number__lte=span.last)
    found = list(frames.order_by("number").values_list("number", flat=True).distinct())[:: span.every]
    if not found:
        raise DriftRefused(_("No frame with pictures lies in that range."))
    return found


def images_of(camera: Camera, frames: Sequence[int]) -> list[tuple[int, Image]]:
    found = Image.objects.filter(camera=camera, frame__number__in=frames).select_related("frame")
    return [(image.frame.number, image) for image in found.order_by("frame__number")]


def grey(image: Image) -> Grey:
    """Raises DriftRefused where the file is gone or damaged."""
    try:
        with default_storage.open(storage_name(image.full_digest)) as stream:
            data = np.frombuffer(stream.read(), np.uint8)
    except FileNotFoundError as error:
        raise DriftRefused(_("The file of picture %(name)s is gone.") % {"name": image}) from error
    pixels = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION) if data.size else None
    if pixels is None:
        raise DriftRefused(_("The file of picture %(name)s is damaged.") % {"name": image})
    return np.asarray(pixels, dtype=np.uint8)
