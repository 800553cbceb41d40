"""Makes the demo scene's pictures in the published folder layout."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import lru_cache
from multiprocessing import get_context, parent_process
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Thread
from typing import Any

import cv2
import numpy as np

from gtm_hit.demo.arrays import Bytes
from gtm_hit.demo.backdrop import Place
from gtm_hit.demo.people import Cast, moment
from gtm_hit.demo.scene import Scene
from gtm_hit.demo.view import View, photograph
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.steps import Steps

JPEG_QUALITY = 92
WORKERS = 2
MALLOC_HABITS = {-3: 1 << 25, -1: 1 << 28, -2: 1 << 25}  # M_MMAP_THRESHOLD, M_TRIM_THRESHOLD, M_TOP_PAD


@dataclass(frozen=True)
class Truth:
    """Where one person stands in one frame."""

    number: int  # of the frame
    person: int
    position: int  # the grid position nearest to the true place
    x: float  # metres
    y: float
    height: float


def truth(scene: Scene, cast: Cast | None = None) -> list[Truth]:
    """Everybody on the grid in every frame; people beyond its border are in the pictures only."""
    walks = (cast or Cast.of(scene)).walks
    rows = []
    for frame, number in enumerate(scene.frame_numbers):
        positions = scene.grid.position(walks.xy[frame])
        for person in np.flatnonzero(walks.present[frame]):
            x, y = walks.xy[frame, person].tolist()
            rows.append(Truth(number, int(person), int(positions[person]), x, y, float(walks.height[person])))
    return rows


def make_demo_frame(scene: Scene, camera: Camera, frame: int) -> Bytes:
    """The picture (H, W, 3), RGB, of the frame with this index; `render_scene` shares work between many."""
    place, cast = Place(scene), Cast.of(scene)
    view = View.of(scene, camera, place.backdrop(camera))
    now = moment(cast, frame, (place.sun_map, place.shade))
    return photograph(scene, camera, view, cast, now, frame)


def render_scene(
    scene: Scene,
    cameras: Sequence[Camera],
    folder: Path,
    progress: Steps | None = None,
    workers: int = WORKERS,
) -> list[Truth]:
    """Write `Image_subsets/C<index + 1>/<number>.jpg` for all cameras and frames; returns the truth.

    The same scene and cameras give the same bytes, whatever the number of workers.
    """
    done, total = 0, len(cameras) * (1 + scene.frame_count)
    with TemporaryDirectory(prefix="demo-scene-") as scratch, _runner(workers) as run:
        views = [Path(scratch) / f"view-{camera.index}" for camera in cameras]
        prepare = [(_prepare_view, scene, *pair) for pair in zip(cameras, views, strict=True)]
        paint = [
            (_paint_frame, scene, cameras, views, frame, folder / "Image_subsets")
            for frame in range(scene.frame_count)
        ]
        for jobs in (prepare, paint):
            for count in run(jobs):
                done += count
                if progress is not None:
                    progress(done, total)
    return truth(scene)


Job = tuple[Any, ...]  # a function of this module and what it is called with; it returns how much is done


@contextmanager
def _runner(workers: int) -> Iterator[Callable[[list[Job]], Iterator[int]]]:
    """Runs jobs and yields their results as they come; more than one worker means other processes."""
    if workers == 1:
        yield lambda jobs: (function(*given) for function, *given in jobs)
        return
    # Spawned, not forked: whoever calls may hold database connections and threads.
    with ProcessPoolExecutor(workers, get_context("spawn"), _start_worker) as pool:

        def run(jobs: list[Job]) -> Iterator[int]:
            for future in as_completed([pool.submit(function, *given) for function, *given in jobs]):
                yield future.result()

        try:
            yield run
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)  # nobody waits for the rest
            raise


def _start_worker() -> None:
    Thread(target=_end_with_parent, daemon=True).start()
    cv2.setNumThreads(1)
    # By default glibc returns every large array to the kernel, which clears the same memory again for the
    # next one: a quarter of all the time. Other C libraries have no mallopt, and are only slower.
    with suppress(OSError, AttributeError):
        mallopt = ctypes.CDLL(None).mallopt
        for parameter, size in MALLOC_HABITS.items():
            mallopt(parameter, size)


def _end_with_parent() -> None:
    """A worker waits for work for ever, also for that of a parent that was killed."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@lru_cache(maxsize=1)
def _place(scene: Scene) -> Place:
    return Place(scene)


@lru_cache(maxsize=1)
def _cast(scene: Scene) -> Cast:
    return Cast.of(scene)


@lru_cache(maxsize=32)
def _view(folder: Path) -> View:
    """Mapped into memory, so that all workers share one copy."""
    return View.load(folder)


def _prepare_view(scene: Scene, camera: Camera, folder: Path) -> int:
    View.of(scene, camera, _place(scene).backdrop(camera)).save(folder)
    return 1


def _paint_frame(scene: Scene, cameras: Sequence[Camera], views: list[Path], frame: int, folder: Path) -> int:
    place, cast = _place(scene), _cast(scene)
    now = moment(cast, frame, (place.sun_map, place.shade))
    for camera, view in zip(cameras, views, strict=True):
        picture = photograph(scene, camera, _view(view), cast, now, frame)
        target = folder / f"C{camera.index + 1}" / f"{scene.frame_numbers[frame]:08d}.jpg"
        _write_jpeg(picture, target)
    return len(cameras)


def _write_jpeg(picture: Bytes, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    bgr = cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)
    written, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    if not written:
        raise OSError(f"{target}: the picture could not be encoded")
    unfinished = target.with_suffix(".part")
    unfinished.write_bytes(data.tobytes())
    unfinished.replace(target)
