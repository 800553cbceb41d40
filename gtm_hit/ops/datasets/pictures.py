"""The images of an import: sizes from their headers, then every pixel decoded and made into derivatives."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, as_completed, wait
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import FormatError, Problem, ProblemList
from gtm_hit.ops.files import images
from gtm_hit.ops.files.images import MOST_PIXELS, Derivatives, ImageError, Undistort
from gtm_hit.ops.jobs.progress import Steps

MOST_THREADS = 8
MOST_PIXELS_TOGETHER = MOST_PIXELS  # each is held several times over: nine bytes of memory and more
Key = tuple[int, int]
"""Camera index and frame number."""
Made = Derivatives | None


class Known(NamedTuple):
    """Digests of an image imported before: of its file then, and of what was made of it."""

    source: str
    light: str
    full: str


@dataclass(frozen=True)
class Picture:
    """One file to import."""

    key: Key
    path: Path
    pixels: int  # of its camera
    undistort: Undistort | None = None
    known: Known | None = None


def camera_sizes(
    paths: Mapping[str, Mapping[int, Path]],
    known: Mapping[str, tuple[int, int]],
    problems: ProblemList,
) -> dict[str, tuple[int, int]]:
    """Width and height per camera: the known one, else the one most of its images have.

    Images that cannot be read or differ are problems.
    """
    sizes = {}
    for camera, by_number in paths.items():
        found = _sizes(by_number.values(), problems)
        if camera not in known and not found:
            continue
        size = known.get(camera) or Counter(found.values()).most_common(1)[0][0]
        sizes[camera] = size
        for path, (width, height) in found.items():
            if (width, height) != size:
                reason = f"{width}×{height} pixels, but camera {camera} has {size[0]}×{size[1]}"
                problems.add("", reason, path)
    return sizes


def make_pictures(
    pictures: Sequence[Picture],
    progress: Steps,
    problems: ProblemList,
    only_check: bool = False,
) -> dict[Key, Derivatives]:
    """Decode all, and unless `only_check` store their derivatives.

    A picture known from before is compared instead; one that changed since is a problem, and one whose
    derivatives are gone from the storage is made again.
    """
    made: dict[Key, Derivatives] = {}
    found: dict[Path, str] = {}
    workers = min(MOST_THREADS, len(os.sched_getaffinity(0)))
    # Threads: decoding, remapping and encoding all let go of Python's lock. The file is read inside the
    # task, so no more pictures than threads are in memory.
    with ThreadPoolExecutor(workers) as pool:
        try:
            work = _completed(pool, workers, pictures, partial(_make, only_check=only_check))
            for done, (picture, future) in enumerate(work, start=1):
                try:
                    derivatives = future.result()
                except ImageError as error:
                    found[picture.path] = str(error)
                else:
                    if derivatives is not None:
                        made[picture.key] = derivatives
                progress(done, len(pictures))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    # In the order of the files, not in the order threads happened to end.
    problems.extend(
        Problem(str(picture.path), "", found[picture.path]) for picture in pictures if picture.path in found
    )
    return made


def _completed(
    pool: ThreadPoolExecutor, workers: int, pictures: Iterable[Picture], task: Callable[[Picture], Made]
) -> Iterator[tuple[Picture, Future[Made]]]:
    """As they end. No more are begun than keep all threads busy, and than memory can hold decoded."""
    begun: dict[Future[Made], Picture] = {}
    for picture in pictures:
        while begun and (
            len(begun) == 2 * workers or _pixels(begun.values()) + picture.pixels > MOST_PIXELS_TOGETHER
        ):
            for future in wait(begun, return_when=FIRST_COMPLETED).done:
                yield begun.pop(future), future
        begun[pool.submit(task, picture)] = picture
    for future in as_completed(list(begun)):
        yield begun.pop(future), future


def _pixels(pictures: Iterable[Picture]) -> int:
    return sum(picture.pixels for picture in pictures)


def _sizes(paths: Iterable[Path], problems: ProblemList) -> dict[Path, tuple[int, int]]:
    found = {}
    for path in paths:
        try:
            found[path] = images.header_size(path)
        except ImageError as error:
            problems.add("", str(error), path)
    return found


def _make(picture: Picture, only_check: bool) -> Derivatives | None:
    try:
        data = read_source(picture.path, images.MOST_BYTES)
    except FormatError as error:
        raise ImageError(error.problems[0].reason) from error
    if picture.known is not None:
        if images.digest_of(data) != picture.known.source:
            raise ImageError("differs from the image this frame was imported with")
        if images.is_stored(picture.known.light) and images.is_stored(picture.known.full):
            return None
    if only_check:
        images.decode(data)
        return None
    return images.make_derivatives(data, picture.undistort)
