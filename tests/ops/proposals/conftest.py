from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.core.files.base import ContentFile
from django.core.files.storage import default_storage
from PIL import Image as Pixels

from gtm_hit.models import Dataset, Image
from gtm_hit.ops.files.images import storage_name
from tests.work_scene import digest, make_dataset

NUMBERS = tuple(range(0, 40, 5))


@pytest.fixture
def dataset(db: None, settings: Any, tmp_path: Path) -> Dataset:
    """Eight frames of two cameras, with pictures of its own in the storage."""
    settings.MEDIA_ROOT, settings.TABLES_ROOT = tmp_path / "media", tmp_path / "tables"
    made = make_dataset(frames=len(NUMBERS), images=True)
    for image in Image.objects.filter(frame__dataset=made):
        store(image)
    return made


def store(image: Image, shade: int = 0) -> None:
    """Give an image a picture, different for each."""
    pixels = np.full((54, 96, 3), (image.pk * 3 + shade) % 251, np.uint8)
    stream = io.BytesIO()
    Pixels.fromarray(pixels).save(stream, "JPEG")
    data = stream.getvalue() + f"{image.pk} {shade}".encode()
    image.full_digest = digest(data)
    image.save(update_fields=["full_digest"])
    default_storage.save(storage_name(image.full_digest), ContentFile(data))
