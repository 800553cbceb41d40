"""Image derivatives: what a browser gets instead of the imported file, made once and stored by content.

Every picture becomes two JPEGs. The light one fills a pane on a wide screen, the full one has every pixel.
Both are files of Django's default storage, named by the SHA-256 of their bytes: equal pictures share a file,
and a browser may keep them for ever.
"""

from __future__ import annotations

import hashlib
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Protocol

import cv2
import numpy as np
from django.core.files.base import ContentFile
from django.core.files.storage import FileSystemStorage, default_storage
from numpy.typing import NDArray
from PIL import Image, ImageFile

from gtm_hit.formats.files import write_bytes
from gtm_hit.formats.jpeg import JpegError, without_metadata
from gtm_hit.ops.errors import OperationError

Pixels = NDArray[np.uint8]

LIGHT_WIDTH = 960  # pixels: a pane is 480 wide at 1920×1080, twice that on a dense display
LIGHT_QUALITY = 85  # seven real views: 0.7 MB
FULL_QUALITY = 95
MOST_BYTES = 200_000_000
MOST_PIXELS = 100_000_000
MOST_PROFILE_BYTES = 8_000  # colour profiles of displays and cameras fit, those of printing presses do not

_PNG_END = b"IEND\xaeB`\x82"
_ORIENTATION = 0x0112  # Exif's tag


class ImageError(OperationError, ValueError):
    """A picture that cannot be used; says why."""


class Undistort(Protocol):
    """Takes lens distortion out of (H, W, 3) pixels."""

    def __call__(self, pixels: Pixels) -> Pixels: ...


@dataclass(frozen=True)
class Derivatives:
    """The stored files of one picture."""

    source_digest: str
    light_digest: str
    full_digest: str
    light_bytes: int
    full_bytes: int


def storage_name(digest: str) -> str:
    return f"images/{digest[:2]}/{digest}.jpg"


def digest_of(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def header_size(path: Path) -> tuple[int, int]:
    """Width and height as the file's first bytes state them, without decoding it.

    Raises ImageError for a file that is missing, empty, too large, or neither PNG nor JPEG.
    """
    try:
        length = path.stat().st_size
        if length == 0:
            raise ImageError("the file is empty")
        if length > MOST_BYTES:
            raise ImageError(f"larger than {MOST_BYTES} bytes")
        with path.open("rb") as stream:
            return _opened(stream).size
    except OSError as error:
        raise ImageError(f"cannot be read: {error.strerror or type(error).__name__}") from error


def decode(data: bytes) -> Image.Image:
    """All pixels of a PNG or JPEG, whatever its file name claims.

    Raises ImageError when it is truncated or damaged; nothing is guessed to fill a gap.
    """
    image = _opened(io.BytesIO(data))
    if image.format == "PNG" and _PNG_END not in data:
        raise ImageError("damaged or truncated: its end is missing")
    try:
        # Decoding alone skips PNG's checksums.
        _opened(io.BytesIO(data)).verify()
        image.load()
    # Pillow's decoders raise a dozen kinds of errors on damaged input, none of them documented.
    except Exception as error:
        raise ImageError(f"damaged or truncated: {error}") from error
    return image


def derive(data: bytes, undistort: Undistort | None = None) -> tuple[bytes, bytes]:
    """The light and the full JPEG of a picture's file. Raises ImageError as `decode`."""
    image = decode(data)
    turned = image.getexif().get(_ORIENTATION, 1) != 1
    profile = image.info.get("icc_profile", b"")
    # A calibration speaks of pixels as stored, but a browser would turn a picture that asks for it.
    keeps = image.format != "PNG" and image.mode in {"RGB", "L"} and undistort is None and not turned
    image = _rgb(image)
    if undistort is not None:
        image = Image.fromarray(undistort(np.asarray(image)))
    icc = profile if len(profile) <= MOST_PROFILE_BYTES else b""
    full = _as_it_came(data) if keeps else None
    full = full or _jpeg(image, FULL_QUALITY, icc)
    if image.width > LIGHT_WIDTH:
        height = max(1, round(image.height * LIGHT_WIDTH / image.width))
        image = image.resize((LIGHT_WIDTH, height), Image.Resampling.LANCZOS)
    return _jpeg(image, LIGHT_QUALITY, icc), full


def _as_it_came(data: bytes) -> bytes | None:
    """The same pixels, without the place and the serial number that cameras write into a file."""
    try:
        return without_metadata(data)
    except JpegError:
        return None


def is_stored(digest: str) -> bool:
    return default_storage.exists(storage_name(digest))


def store(data: bytes) -> str:
    """The digest the bytes are stored under. Never seen half-written."""
    digest = digest_of(data)
    name = storage_name(digest)
    there = default_storage.exists(name)
    if there and default_storage.size(name) == len(data):
        return digest
    if isinstance(default_storage, FileSystemStorage):
        write_bytes(Path(default_storage.path(name)), data)
        return digest
    # An object store writes atomically by itself, but gives a taken name a suffix.
    if there:
        default_storage.delete(name)
    default_storage.save(name, ContentFile(data))
    return digest


def make_derivatives(data: bytes, undistort: Undistort | None = None) -> Derivatives:
    """Derive and store. Raises ImageError as `decode`; then nothing is stored."""
    light, full = derive(data, undistort)
    return Derivatives(digest_of(data), store(light), store(full), len(light), len(full))


def remapper(coarse: NDArray[Any], fine: NDArray[Any]) -> Undistort:
    """An `Undistort` by cv2.remap with its two maps; what lies outside the source becomes black."""

    def undistort(pixels: Pixels) -> Pixels:
        return np.asarray(cv2.remap(pixels, coarse, fine, cv2.INTER_CUBIC), dtype=np.uint8)

    return undistort


def _opened(stream: BinaryIO) -> ImageFile.ImageFile:
    try:
        image = Image.open(stream, formats=("PNG", "JPEG"))
    except Image.DecompressionBombError as error:
        raise ImageError(f"more than {MOST_PIXELS} pixels") from error
    # Hostile headers raise anything from SyntaxError to Pillow's own warnings made errors.
    except Exception as error:
        raise ImageError("neither a PNG nor a JPEG") from error
    if image.width * image.height > MOST_PIXELS:
        raise ImageError(f"{image.width}×{image.height} is more than {MOST_PIXELS} pixels")
    return image


def _rgb(image: Image.Image) -> Image.Image:
    if image.mode.startswith("I"):
        # Pillow cuts 16 bits off at 255 instead of scaling them.
        image = Image.fromarray((np.asarray(image) >> 8).astype(np.uint8))
    return image if image.mode == "RGB" else image.convert("RGB")


def _jpeg(image: Image.Image, quality: int, profile: bytes) -> bytes:
    stream = io.BytesIO()
    image.save(
        stream,
        "JPEG",
        quality=quality,
        subsampling="4:4:4",
        optimize=True,
        icc_profile=profile or None,
        comment=b"",  # Pillow would take the source's along
    )
    return stream.getvalue()
