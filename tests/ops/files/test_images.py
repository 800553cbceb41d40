from __future__ import annotations

import contextlib
import io
import math
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from django.core.files.base import ContentFile
from django.core.files.storage import InMemoryStorage, default_storage
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageCms

from gtm_hit.formats.jpeg import JpegError, without_metadata
from gtm_hit.geometry.camera import Camera, undistort_maps
from gtm_hit.ops.files import images
from gtm_hit.ops.files.images import (
    ImageError,
    decode,
    derive,
    header_size,
    make_derivatives,
    remapper,
    store,
)
from tests.dataset_folder import picture

WIDE = picture(1, 1920, 1080, "JPEG")


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"


def opened(data: bytes) -> Image.Image:
    return Image.open(io.BytesIO(data))


def encoded(image: Image.Image, kind: str, **how: Any) -> bytes:
    stream = io.BytesIO()
    image.save(stream, kind, **how)
    return stream.getvalue()


def error_between(first: Image.Image, second: Image.Image) -> float:
    """Mean difference of 8-bit values."""
    one, other = (np.asarray(image.convert("RGB"), dtype=float) for image in (first, second))
    return float(np.abs(one - other).mean())


# Deriving


def test_the_light_derivative_is_960_pixels_wide_and_looks_the_same() -> None:
    light, _full = derive(WIDE)
    assert opened(light).size == (960, 540)
    assert error_between(opened(light), opened(WIDE).resize((960, 540))) < 3


def test_a_narrow_picture_is_not_enlarged() -> None:
    light, _full = derive(picture(1, 640, 480))
    assert opened(light).size == (640, 480)


def test_a_jpeg_is_served_in_full_as_it_came() -> None:
    assert derive(WIDE)[1] == WIDE


def test_a_png_becomes_a_jpeg_of_every_pixel() -> None:
    source = picture(1, 640, 480)
    full = opened(derive(source)[1])
    assert (full.format, full.size) == ("JPEG", (640, 480))
    assert error_between(full, opened(source)) < 1


def test_the_bytes_decide_and_not_the_file_name() -> None:
    """WILDTRACK's original frames are PNG files named .jpg, with an opaque alpha channel."""
    source = encoded(opened(picture(1)).convert("RGBA"), "PNG")
    assert opened(derive(source)[1]).mode == "RGB"


def test_sixteen_bits_are_scaled_and_not_cut_off() -> None:
    ramp = np.tile(np.linspace(0, 65535, 256).astype(np.uint16), (16, 1))
    full = np.asarray(opened(derive(encoded(Image.fromarray(ramp), "PNG"))[1]).convert("L"))
    assert np.abs(full[8].astype(int) - np.arange(256)).max() <= 3


@pytest.mark.parametrize("mode", ["L", "P", "1", "CMYK"])
def test_every_colour_mode_becomes_a_picture(mode: str) -> None:
    kind = "JPEG" if mode == "CMYK" else "PNG"
    light, full = derive(encoded(opened(picture(1)).convert(mode), kind))
    assert opened(light).size == opened(full).size == (320, 240)


def test_a_picture_that_asks_to_be_turned_is_shown_as_its_pixels_are_stored() -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    source = encoded(opened(picture(1)), "JPEG", exif=exif, quality=95)
    for derivative in derive(source):
        assert opened(derivative).size == (320, 240)
        assert opened(derivative).getexif().get(0x0112, 1) == 1


def test_deriving_twice_gives_the_same_bytes() -> None:
    assert derive(WIDE) == derive(WIDE)


# Refusing


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
@given(part=st.floats(0, 1, exclude_max=True))
def test_a_picture_cut_off_anywhere_is_refused(kind: str, part: float) -> None:
    source = picture(1, 64, 48, kind)
    with pytest.raises(ImageError):
        decode(source[: math.floor(len(source) * part)])


@given(data=st.binary(max_size=300), place=st.integers(0, 2000), kind=st.sampled_from(["PNG", "JPEG"]))
def test_damaged_bytes_raise_nothing_but_image_errors(data: bytes, place: int, kind: str) -> None:
    source = picture(1, 64, 48, kind)
    damaged = source[:place] + data + source[place + len(data) :]
    try:
        decode(damaged)
    except ImageError as error:
        assert str(error)


@given(place=st.integers(0, 10**9), bit=st.integers(0, 7))
def test_no_flipped_bit_of_a_png_goes_unnoticed(place: int, bit: int) -> None:
    source = bytearray(picture(1, 64, 48))
    source[place % len(source)] ^= 1 << bit
    with pytest.raises(ImageError):
        decode(bytes(source))


@pytest.mark.parametrize("kind", ["GIF", "BMP", "TIFF", "WEBP"])
def test_other_kinds_of_pictures_are_refused(kind: str) -> None:
    with pytest.raises(ImageError, match="neither a PNG nor a JPEG"):
        decode(encoded(opened(picture(1)), kind))


def test_a_header_tells_the_size_without_the_pixels(tmp_path: Path) -> None:
    path = tmp_path / "cut.jpg"
    path.write_bytes(WIDE[:1000])
    assert header_size(path) == (1920, 1080)


def test_a_file_that_is_not_there_has_no_size(tmp_path: Path) -> None:
    with pytest.raises(ImageError, match="cannot be read: No such file"):
        header_size(tmp_path / "nothing.png")


# Storing


def test_a_file_is_named_by_its_bytes() -> None:
    digest = store(b"bytes")
    with default_storage.open(f"images/{digest[:2]}/{digest}.jpg") as stream:
        assert stream.read() == b"bytes"


def test_the_same_bytes_are_stored_once(tmp_path: Path) -> None:
    assert store(b"bytes") == store(b"bytes")
    assert len([path for path in (tmp_path / "media").rglob("*") if path.is_file()]) == 1


def test_a_file_cut_short_by_a_crash_is_written_again() -> None:
    digest = store(b"bytes")
    Path(default_storage.path(images.storage_name(digest))).write_bytes(b"by")
    assert store(b"bytes") == digest
    with default_storage.open(images.storage_name(digest)) as stream:
        assert stream.read() == b"bytes"


def test_a_storage_without_a_folder_takes_the_same_names(monkeypatch: pytest.MonkeyPatch) -> None:
    storage = InMemoryStorage()
    monkeypatch.setattr(images, "default_storage", storage)
    digest = store(b"bytes")
    assert store(b"bytes") == digest
    assert storage.open(images.storage_name(digest)).read() == b"bytes"


def test_an_object_cut_short_is_replaced_under_its_own_name(monkeypatch: pytest.MonkeyPatch) -> None:
    storage = InMemoryStorage()
    monkeypatch.setattr(images, "default_storage", storage)
    name = images.storage_name(images.digest_of(b"bytes"))
    storage.save(name, ContentFile(b"by"))
    store(b"bytes")
    assert storage.open(name).read() == b"bytes"


def test_a_damaged_picture_stores_nothing(tmp_path: Path) -> None:
    with pytest.raises(ImageError):
        make_derivatives(WIDE[:-1000])
    assert not (tmp_path / "media").exists()


# Undistorting


def test_undistortion_brings_a_point_to_where_the_camera_without_lens_sees_it() -> None:
    matrix = np.array([[300.0, 0, 160], [0, 300, 120], [0, 0, 1]])
    camera = Camera(0, "C1", 320, 240, matrix, np.zeros(3), np.zeros(3), np.array([-0.5, 0.1, 0, 0, 0]))
    ray = np.array([[[0.3, -0.2, 1.0]]])
    seen, _ = cv2.projectPoints(ray, np.zeros(3), np.zeros(3), matrix, camera.distortion)
    ideal, _ = cv2.projectPoints(ray, np.zeros(3), np.zeros(3), matrix, np.zeros(5))
    pixels = np.zeros((240, 320, 3), np.uint8)
    cv2.circle(pixels, tuple(int(value) for value in seen.ravel().round()), 3, (255, 255, 255), -1)
    _light, full = derive(encoded(Image.fromarray(pixels), "PNG"), remapper(*undistort_maps(camera)))
    found = np.argwhere(np.asarray(opened(full).convert("L")) > 128).mean(axis=0)[::-1]
    assert found == pytest.approx(ideal.ravel(), abs=1)
    assert np.linalg.norm(seen - ideal) > 5


# What cameras write beside the picture


def revealing(**how: Any) -> bytes:
    """A JPEG as a phone makes it: maker, serial number, place, comment, XMP, and something behind its end."""
    exif = Image.Exif()
    exif[0x010F], exif[0xA431] = "Maker", "SN-1234567"
    exif.get_ifd(0x8825).update({1: "N", 2: (46.0, 31.0, 7.0)})
    xmp = b"<x:xmpmeta>SN-1234567</x:xmpmeta>"
    data = encoded(opened(WIDE), "JPEG", exif=exif, comment=b"SN-1234567", xmp=xmp, quality=90, **how)
    return data + b"SN-1234567"


@pytest.mark.parametrize("how", [{}, {"progressive": True}, {"subsampling": "4:4:4"}])
def test_workers_get_no_exif_and_no_comment_but_every_pixel(how: dict[str, Any]) -> None:
    source = revealing(**how)
    light, full = derive(source)
    for each in (light, full):
        assert b"SN-1234567" not in each and b"Exif" not in each
        assert not opened(each).getexif() and "comment" not in opened(each).info
    assert np.array_equal(np.asarray(opened(full)), np.asarray(opened(source)))


def test_a_picture_made_anew_takes_no_comment_along() -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    source = encoded(opened(WIDE), "JPEG", exif=exif, comment=b"SN-1234567")
    assert all(b"SN-1234567" not in each for each in derive(source))


def test_colours_keep_their_profile() -> None:
    profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    for each in derive(revealing(icc_profile=profile)):
        assert opened(each).info["icc_profile"] == profile


@given(part=st.floats(0, 1))
def test_half_a_jpeg_is_refused_or_loses_its_metadata(part: float) -> None:
    source = revealing()[: round(len(WIDE) * part)]
    with contextlib.suppress(JpegError):
        assert b"SN-1234567" not in without_metadata(source)
