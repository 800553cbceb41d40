"""Pictures of the ground as cameras and phones write them."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.core.files.storage import default_storage
from PIL import Image

from gtm_hit.models import Desk, DeskCamera
from gtm_hit.ops.desk import desks, pictures
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.files.images import storage_name
from tests.desk_scene import make_desk

pytestmark = pytest.mark.django_db

ORIENTATION = 0x0112


@pytest.fixture
def desk(settings: Any, tmp_path: Path) -> Desk:
    settings.MEDIA_ROOT, settings.DATA_DIR = tmp_path / "media", tmp_path
    return desks.make("yard", cameras=["C1"])


def written(image: Image.Image, kind: str = "PNG", **options: Any) -> bytes:
    stream = io.BytesIO()
    image.save(stream, kind, **options)
    return stream.getvalue()


def half_bright(mode: str, size: tuple[int, int] = (320, 180)) -> Image.Image:
    """Black on the left, three quarters of white on the right."""
    bright = np.zeros((size[1], size[0]), np.uint16)
    bright[:, size[0] // 2 :] = 0xC000
    if mode == "I;16":
        return Image.fromarray(bright)
    return Image.fromarray((bright >> 8).astype(np.uint8)).convert(mode)


def stored() -> np.ndarray:
    digest = DeskCamera.objects.get().full_digest
    with default_storage.open(storage_name(digest)) as file:
        return np.asarray(Image.open(file).convert("L"))


@pytest.mark.parametrize("mode", ["RGB", "L", "I;16"])
def test_grey_and_16_bits_show_what_colours_show(desk: Desk, mode: str) -> None:
    pictures.put(desk, "C1", written(half_bright(mode)))
    shown = stored()
    assert shown.shape == (180, 320)
    assert shown[:, :150].max() < 8 and abs(int(np.median(shown[:, 170:])) - 0xC0) < 4


def test_a_wish_to_be_turned_is_not_followed_and_taken_out_of_the_file(desk: Desk) -> None:
    exif = Image.Exif()
    exif[ORIENTATION] = 6
    pictures.put(desk, "C1", written(half_bright("RGB"), "JPEG", exif=exif))
    camera = DeskCamera.objects.get()
    assert (camera.width, camera.height) == (320, 180)
    with default_storage.open(storage_name(camera.full_digest)) as file:
        assert Image.open(file).getexif().get(ORIENTATION, 1) == 1
    assert stored()[:, :150].max() < 8


def test_an_upright_picture_is_one_like_others(desk: Desk) -> None:
    pictures.put(desk, "C1", written(half_bright("RGB", (180, 320))))
    camera = DeskCamera.objects.get()
    assert (camera.width, camera.height) == (180, 320)


def test_a_picture_of_another_size_than_the_cameras_is_refused() -> None:
    desk = make_desk()
    before = desk.cameras.get(name="C1").full_digest
    with pytest.raises(DeskError, match=r"The picture has 320×180 pixels; C1 has 1920×1080"):
        pictures.put(desk, "C1", written(half_bright("RGB")))
    assert desk.cameras.get(name="C1").full_digest == before


def test_what_is_no_picture_is_refused_in_a_sentence(desk: Desk) -> None:
    with pytest.raises(DeskError, match="The picture cannot be used: neither a PNG nor a JPEG"):
        pictures.put(desk, "C1", b"no picture")
