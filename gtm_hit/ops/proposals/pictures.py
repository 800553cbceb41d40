"""Stored pictures as detectors want them, decoded when they are looked at."""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

import cv2
import numpy as np
from django.core.files.storage import default_storage

from gtm_hit.models import Frame, Image
from gtm_hit.ops.files import images
from gtm_hit.vision.boxes import Picture

KEPT = 64  # decoded pictures of a group, at most


class StoredPictures(Mapping[str, Picture]):
    """By camera; what is missing in the storage is missing here."""

    def __init__(self, digests: Mapping[str, str], number: int = 0) -> None:
        self.number = number  # the frame's
        self.digests = {name: each for name, each in digests.items() if images.is_stored(each)}

    def __getitem__(self, camera: str) -> Picture:
        return decoded(self.digests[camera])

    def __iter__(self) -> Iterator[str]:
        return iter(self.digests)

    def __len__(self) -> int:
        return len(self.digests)

    @property
    def digest(self) -> str:
        """Of all of them together."""
        told = "\n".join(f"{name} {each}" for name, each in sorted(self.digests.items()))
        return hashlib.sha256(told.encode()).hexdigest()


def decoded(digest: str) -> Picture:
    with default_storage.open(images.storage_name(digest)) as file:
        data = np.frombuffer(file.read(), np.uint8)
    picture = cv2.imdecode(data, cv2.IMREAD_COLOR)
    if picture is None:
        raise images.ImageError(f"picture {digest} cannot be read")
    return picture  # type: ignore[return-value]


def pictures_of(frames: Iterable[Frame]) -> dict[int, StoredPictures]:
    """By frame id, with one query."""
    numbers = {frame.pk: frame.number for frame in frames}
    digests: dict[int, dict[str, str]] = defaultdict(dict)
    rows = Image.objects.filter(frame__in=list(numbers)).order_by("camera__index")
    for frame, camera, digest in rows.values_list("frame_id", "camera__name", "full_digest"):
        digests[frame][camera] = digest
    return {pk: StoredPictures(digests[pk], number) for pk, number in numbers.items()}
