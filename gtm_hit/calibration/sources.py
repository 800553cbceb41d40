"""Pictures out of a folder, a zip or a video, one after the other, as grey pixels."""

from __future__ import annotations

import io
import zipfile
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path, PurePosixPath

import cv2
import numpy as np
from PIL import Image

from gtm_hit.calibration.reasons import sharpness
from gtm_hit.calibration.spotting import shrunk
from gtm_hit.calibration.views import Grey, NotFound, Picture
from gtm_hit.geometry.errors import GeometryError

SUFFIXES = {".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff", ".webp", ".pgm", ".ppm"}
VIDEOS = {".mp4", ".mov", ".avi", ".mkv", ".m4v", ".webm", ".mpg", ".mpeg", ".mts", ".ts"}
MOST_PICTURES = 2000
MOST_BYTES = 64 * 2**20  # of one picture's file
MOST_PIXELS = 200_000_000
SAMPLED = 120  # frames of a video
TRIED = 3  # frames around each of them, of which the sharpest is taken
UNKNOWN_STEP = 10  # frames, where a video does not tell how long it is
BLURRED = 0.3  # of the median sharpness of a video's frames


class SourceError(GeometryError):
    """A folder, zip or video that pictures cannot be taken from; says why."""


@dataclass(frozen=True)
class Source:
    """Pictures of one size that have not been decoded yet."""

    size: tuple[int, int]  # width, height
    count: int
    notes: tuple[str, ...]  # what whoever calibrates should know
    read: Callable[[], Iterator[Picture | NotFound]]


def open_source(path: Path, sampled: int = SAMPLED) -> Source:
    """What `path` holds. Raises SourceError, also for pictures of different sizes, naming which."""
    if path.is_dir():
        try:
            return _of_folder(path)
        except OSError as error:
            raise SourceError(f"{path} cannot be read: {error.strerror}.") from error
    if not path.is_file():
        raise SourceError(f"{path} is {'no plain file' if path.exists() else 'not there'}.")
    if zipfile.is_zipfile(path):
        return _of_zip(path)
    if path.suffix.lower() in SUFFIXES:
        raise SourceError(
            f"{path.name} is a single picture; give the folder with all pictures of the camera."
        )
    return _of_video(path, sampled)


def decoded(name: str, data: bytes) -> Picture | NotFound:
    """The pixels as stored: grey, 16-bit and transparent files too; a wish to be turned is not followed."""
    if not data:
        return NotFound(name, "The file is empty.")
    flags = cv2.IMREAD_UNCHANGED | cv2.IMREAD_IGNORE_ORIENTATION
    try:
        pixels = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    except cv2.error:
        pixels = None
    if pixels is None:
        return NotFound(name, "The picture cannot be decoded; it may be damaged or cut off.")
    return Picture(name, as_grey(pixels))


def as_grey(pixels: np.ndarray) -> Grey:
    """Eight bits of grey; what has more is stretched over the range it uses."""
    if pixels.ndim == 3 and pixels.shape[2] == 1:
        pixels = pixels[:, :, 0]
    if pixels.ndim == 3:
        pixels = cv2.cvtColor(pixels[:, :, :3], cv2.COLOR_BGR2GRAY)
    if pixels.dtype == np.uint8:
        return np.ascontiguousarray(pixels)
    values = np.nan_to_num(pixels.astype(np.float64), posinf=0, neginf=0)
    dark, bright = np.percentile(values, (0.1, 99.9))
    return np.clip((values - dark) * (255 / max(bright - dark, 1e-9)), 0, 255).round().astype(np.uint8)


def _of_folder(path: Path) -> Source:
    files = sorted(file for file in path.iterdir() if _is_picture(file.name) and file.is_file())
    if not files:
        raise SourceError(f"There are no pictures in {path}.{_hint(path)}")

    def load(file: Path) -> bytes:
        with file.open("rb") as stream:
            return stream.read(MOST_BYTES + 1)

    return _of_files({file.name: partial(load, file) for file in files})


def _hint(path: Path) -> str:
    """What was probably meant instead of a folder without pictures."""
    videos = sorted(file.name for file in path.iterdir() if file.suffix.lower() in VIDEOS)
    if videos:
        return f" For the video in it, give {videos[0]} itself."
    folders = sorted(each for each in path.iterdir() if each.is_dir() and each.name[0] != ".")
    holding = [each.name for each in folders if any(_is_picture(file.name) for file in each.iterdir())]
    if not holding:
        return ""
    others = f" (or {', '.join(holding[1:4])}{', …' if len(holding) > 4 else ''})" if holding[1:] else ""
    return f" There are some in its folder {holding[0]}{others}: give that one, one camera at a time."


def _of_zip(path: Path) -> Source:
    try:
        with zipfile.ZipFile(path) as archive:
            entries = [entry for entry in archive.infolist() if _is_picture(entry.filename)]
    except (zipfile.BadZipFile, OSError) as error:
        raise SourceError(f"{path.name} is a damaged zip: {error}.") from error
    if not entries:
        raise SourceError(f"There are no pictures in {path.name}.")

    def load(entry: zipfile.ZipInfo) -> bytes:
        try:
            with zipfile.ZipFile(path) as archive, archive.open(entry) as stream:
                return stream.read(MOST_BYTES + 1)
        except (zipfile.BadZipFile, RuntimeError, NotImplementedError, OSError):
            return b""  # told as a picture that is empty; the others may be whole

    entries.sort(key=lambda entry: entry.filename)
    return _of_files({entry.filename: partial(load, entry) for entry in entries})


def _is_picture(name: str) -> bool:
    inner = PurePosixPath(name)
    return (
        inner.suffix.lower() in SUFFIXES and not inner.name.startswith(".") and "__MACOSX" not in inner.parts
    )


def _of_files(load: dict[str, Callable[[], bytes]]) -> Source:
    if len(load) > MOST_PICTURES:
        raise SourceError(f"{len(load)} pictures are too many; {MOST_PICTURES} are the most.")
    sizes: dict[tuple[int, int], list[str]] = defaultdict(list)
    turned, broken = [], {}
    for name, read in load.items():
        try:
            size, is_turned = _header(read())
        except SourceError as error:
            broken[name] = str(error)
            continue
        sizes[size].append(name)
        turned += [name] * is_turned
    if not sizes:
        raise SourceError(f"None of the {len(load)} pictures can be read. {next(iter(broken.values()))}")
    _check_one_size(sizes)

    def read_all() -> Iterator[Picture | NotFound]:
        for name, read in load.items():
            yield NotFound(name, broken[name]) if name in broken else decoded(name, read())

    return Source(next(iter(sizes)), len(load), _turned_note(turned), read_all)


def _header(data: bytes) -> tuple[tuple[int, int], bool]:
    if len(data) > MOST_BYTES:
        raise SourceError(f"The file is larger than {MOST_BYTES // 2**20} MiB.")
    try:
        with Image.open(io.BytesIO(data)) as image:
            if image.width * image.height > MOST_PIXELS:
                raise SourceError(f"{image.width}×{image.height} pixels are too many.")
            return image.size, image.getexif().get(0x0112, 1) != 1
    except SourceError:
        raise
    # Pillow's readers raise a dozen kinds of errors on damaged input, none of them documented.
    except Exception as error:
        raise SourceError("The file is no picture, or a damaged one.") from error


def _check_one_size(sizes: dict[tuple[int, int], list[str]]) -> None:
    if len(sizes) == 1:
        return
    by_count = sorted(sizes.items(), key=lambda item: (-len(item[1]), item[0]))
    (width, height), most = by_count[0]
    others = [
        f"{len(names)} of {size[0]}×{size[1]} ({', '.join(names[:3])}{', …' if len(names) > 3 else ''})"
        for size, names in by_count[1:]
    ]
    turned = " Pictures taken upright must not be mixed with others." if (height, width) in sizes else ""
    raise SourceError(
        f"The pictures are not all of one size: {len(most)} of {width}×{height}, {' and '.join(others)}. "
        f"One lens is solved from one size.{turned}"
    )


def _turned_note(turned: list[str]) -> tuple[str, ...]:
    if not turned:
        return ()
    which = turned[0] if len(turned) == 1 else f"{len(turned)} pictures"
    asks = "asks" if len(turned) == 1 else "ask"
    return (
        f"{which} {asks} viewers to turn what they show. The lens is solved for the pixels as stored, "
        "which is how pictures are imported here.",
    )


def _of_video(path: Path, sampled: int) -> Source:
    with _capture(path) as capture:
        ok, first = capture.read()
        if not ok:
            raise SourceError(f"{path.name} holds no frame that can be decoded.")
        total = int(capture.get(cv2.CAP_PROP_FRAME_COUNT))
        turned = [path.name] if capture.get(cv2.CAP_PROP_ORIENTATION_META) else []
    size = (first.shape[1], first.shape[0])
    step = max(1, total // max(1, sampled)) if total > 0 else UNKNOWN_STEP
    count = min(sampled, total) if total > 0 else sampled

    def read_all() -> Iterator[Picture | NotFound]:
        yield from _sharp(_sampled(path, step))

    return Source(size, count, _turned_note(turned), read_all)


@contextmanager
def _capture(path: Path) -> Iterator[cv2.VideoCapture]:
    capture = cv2.VideoCapture(str(path.absolute()), cv2.CAP_FFMPEG)
    if not capture.isOpened():
        raise SourceError(f"{path.name} is neither a folder, a zip nor a video that can be decoded.")
    # A calibration speaks of pixels as stored, not as a player would turn them.
    capture.set(cv2.CAP_PROP_ORIENTATION_AUTO, 0)
    try:
        yield capture
    finally:
        capture.release()


def _sampled(path: Path, step: int) -> Iterator[tuple[Picture, float]]:
    """One frame out of every `step`: the sharpest of a few, with its sharpness."""
    tried = {round(at * step / TRIED) for at in range(TRIED)}
    with _capture(path) as capture:
        number, best = 0, None
        while capture.grab():
            if number % step == 0 and best is not None:
                yield best
                best = None
            if number % step in tried:
                best = _sharper(best, capture, number)
            number += 1
        if best is not None:
            yield best


def _sharper(
    best: tuple[Picture, float] | None, capture: cv2.VideoCapture, number: int
) -> tuple[Picture, float] | None:
    ok, pixels = capture.retrieve()
    if not ok:
        return best
    picture = Picture(f"frame-{number:06d}", as_grey(pixels))
    sharp = sharpness(shrunk(picture.grey, 960)[0])
    return (picture, sharp) if best is None or sharp > best[1] else best


def _sharp(frames: Iterator[tuple[Picture, float]]) -> Iterator[Picture | NotFound]:
    """Leaves out frames much less sharp than those before them were."""
    known: list[float] = []
    for picture, sharp in frames:
        known.append(sharp)
        if len(known) >= 5 and sharp < BLURRED * float(np.median(known)):
            yield NotFound(picture.name, "The frame is blurred, much more than the others; it was left out.")
        else:
            yield picture
