"""A part of a picture of a try, for the worker whose try it is."""

from __future__ import annotations

import io

from django.core.files.storage import default_storage
from PIL import Image as Picture

from gtm_hit.models import Image, QualificationAttempt
from gtm_hit.ops.files.images import storage_name

QUALITY = 88
LARGEST = 640  # pixels on a side


def crop(
    attempt: QualificationAttempt, frame: int, camera: int, region: tuple[int, int, int, int]
) -> bytes | None:
    """JPEG; None unless the try is judged, the picture is one of its own, and the region lies within."""
    image = Image.objects.filter(
        frame__batches=attempt.assignment.batch_id, frame__number=frame, camera__index=camera
    ).first()
    left, top, width, height = region
    if attempt.passed is None or image is None or not (width and height):
        return None
    try:
        with default_storage.open(storage_name(image.full_digest)) as file, Picture.open(file) as picture:
            if left + width > picture.width or top + height > picture.height:
                return None
            part = picture.crop((left, top, left + width, top + height)).convert("RGB")
    except FileNotFoundError:
        return None
    part.thumbnail((LARGEST, LARGEST))
    written = io.BytesIO()
    part.save(written, "JPEG", quality=QUALITY)
    return written.getvalue()
