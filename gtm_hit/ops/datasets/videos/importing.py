"""The import of videos: pictures are taken some instants at a time and go the way of any folder of images.

Every such part is imported in one transaction of its own, so that hour-long videos need the disk of one part
only, and a run that was killed is continued by the next one.
"""

from __future__ import annotations

import fcntl
import shutil
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from threading import Event

import cv2
from django.conf import settings

from gtm_hit.formats.problems import FormatError, Problem, ProblemList
from gtm_hit.models import Dataset
from gtm_hit.ops.datasets.importing import ImportFailed, ImportReport, import_dataset
from gtm_hit.ops.datasets.videos.nearest import Taken
from gtm_hit.ops.datasets.videos.options import VideoOptions
from gtm_hit.ops.datasets.videos.plan import Plan, make_plan, with_usual_values
from gtm_hit.ops.datasets.videos.video import VideoError, pictures
from gtm_hit.ops.jobs.progress import Progress, no_progress

INSTANTS_TOGETHER = 32  # seven views of 1920×1080 as PNG: about a gigabyte on the disk
SECONDS_BETWEEN_REPORTS = 0.5
SYNCHRONOUS = 0.050  # seconds; what the makers of WILDTRACK reach
EARLY_END = 1.0  # seconds missing at the end of a video that are worth a word
PHASE = "taking frames"
IMAGES = "Image_subsets"


@dataclass
class VideoReport:
    """What a run added; `deviations`: by camera the largest distance of a picture from its frame, seconds."""

    dataset: Dataset | None = None
    frames_added: int = 0
    images_added: int = 0
    frames_known: int = 0
    deviations: dict[str, float] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


def import_videos(
    options: VideoOptions,
    progress: Progress = no_progress,
    remember: Callable[[ImportReport], object] | None = None,
) -> VideoReport:
    """Take the frames a dataset does not have yet. Run again, it continues; a finished one adds nothing.

    Raises ImportFailed with all that is wrong before anything is taken. What fails later (a video damaged in
    its middle, a full disk) leaves the parts before it imported. `remember` is told of every part, in the
    part's transaction.
    """
    problems = ProblemList("")
    options = with_usual_values(options)
    try:
        plan = make_plan(options, problems)
        with _own_folder(options.dataset.slug) as folder:
            return _Run(options, plan, folder, progress, remember).run()
    except FormatError as error:
        raise ImportFailed(error.relative_to(options.dataset.folder).problems) from error
    except OSError as error:
        raise ImportFailed((Problem("", "", error.strerror or str(error)),)) from error


class _Run:
    def __init__(
        self,
        options: VideoOptions,
        plan: Plan,
        folder: Path,
        progress: Progress,
        remember: Callable[[ImportReport], object] | None,
    ) -> None:
        self.options = options
        self.plan = plan
        self.folder = folder
        self.progress = progress
        self.remember = remember
        self.report = VideoReport(
            frames_known=len(plan.known), deviations={source.camera: 0.0 for source in plan.sources}
        )
        self.done = 0
        self.stop = Event()
        self.numbers = _numbers_to_take(plan)

    def run(self) -> VideoReport:
        parts = [
            self.numbers[start : start + INSTANTS_TOGETHER]
            for start in range(0, len(self.numbers), INSTANTS_TOGETHER)
        ]
        streams = {
            source.camera: pictures(
                source.path,
                self.plan.facts[source.camera].interval,
                [self.plan.time(source, number) for number in self.numbers],
                self.stop,
            )
            for source in self.plan.sources
        }
        with ThreadPoolExecutor(len(streams)) as pool:
            try:
                for part in parts:
                    taken = self._take(pool, streams, part)
                    if taken:
                        self._import()
                        self.done += taken
                    if taken < len(part):
                        break
            finally:
                self.stop.set()
        self._tell_deviations()
        return self.report

    def _take(self, pool: ThreadPoolExecutor, streams: dict[str, Iterator[Taken]], part: list[int]) -> int:
        """Write one part's pictures; how many of its instants all videos had."""
        shutil.rmtree(self.folder / IMAGES, ignore_errors=True)
        tasks = {camera: pool.submit(self._write, camera, stream, part) for camera, stream in streams.items()}
        self._wait(list(tasks.values()))
        counts = {}
        problems = ProblemList("")
        for source in self.plan.sources:
            try:
                counts[source.camera] = tasks[source.camera].result()
            except VideoError as error:
                problems.add(f"camera {source.camera}", str(error), source.path)
        problems.raise_if_any()
        fewest = min(counts.values())
        for camera, count in counts.items():
            for number in part[fewest:count]:
                self._path(camera, number).unlink()
            if count == fewest < len(part):
                self._tell_early_end(camera, part[fewest])
        return fewest

    def _wait(self, tasks: list[Future[int]]) -> None:
        """Report from this thread only: what reports writes to the database."""
        try:
            while wait(tasks, SECONDS_BETWEEN_REPORTS).not_done:
                self.progress(PHASE, self.done, len(self.numbers))
            self.progress(PHASE, self.done, len(self.numbers))
        except BaseException:
            self.stop.set()
            wait(tasks)
            raise

    def _write(self, camera: str, stream: Iterator[Taken], part: list[int]) -> int:
        source = next(source for source in self.plan.sources if source.camera == camera)
        self._path(camera, 0).parent.mkdir(parents=True)
        for count, number in enumerate(part):
            taken = next(stream, None)
            if taken is None:
                return count
            deviation = abs(taken.time - self.plan.time(source, number))
            self.report.deviations[camera] = max(self.report.deviations[camera], deviation)
            path = self._path(camera, number)
            if not cv2.imwrite(str(path), taken.pixels, [cv2.IMWRITE_PNG_COMPRESSION, 1]):
                raise OSError(f"{path} cannot be written")
        return len(part)

    def _import(self) -> None:
        given = self.options.dataset
        calibrations = given.folder / (given.calibrations or "calibrations")
        part = replace(given, folder=self.folder, images=Path(IMAGES), calibrations=calibrations.absolute())
        report = import_dataset(part, self._pass_on, self.remember)
        self.report.dataset = report.dataset
        self.report.frames_added += report.frames_added
        self.report.images_added += report.images_added
        self.report.notes += [note for note in report.notes if note not in self.report.notes]

    def _pass_on(self, phase: str, done: int, total: int, /) -> None:
        if phase == "computing rectangles":
            self.progress(phase, done, total)
        else:
            self.progress(PHASE, self.done, len(self.numbers))

    def _path(self, camera: str, number: int) -> Path:
        return self.folder / IMAGES / camera / f"{number:08d}.png"

    def _tell_early_end(self, camera: str, number: int) -> None:
        source = next(source for source in self.plan.sources if source.camera == camera)
        at, duration = self.plan.time(source, number), self.plan.facts[camera].duration
        if duration - at > EARLY_END:
            self.report.notes.append(
                f"the video of {camera} ends before {at:.2f} s, though its header says {duration:.2f} s"
            )

    def _tell_deviations(self) -> None:
        camera = max(self.report.deviations, key=self.report.deviations.__getitem__)
        worst = self.report.deviations[camera]
        much = f", more than the {1000 * SYNCHRONOUS:.0f} ms of WILDTRACK" if worst > SYNCHRONOUS else ""
        self.report.notes.append(
            f"pictures are at most {1000 * worst:.1f} ms from the time of their frame ({camera}){much}"
        )


def _numbers_to_take(plan: Plan) -> list[int]:
    """Frames the dataset lacks, and two it has.

    The import compares these two with what it had: other videos or offsets than last time would be found.
    """
    lacking = [number for number in plan.numbers if number not in plan.known]
    known = sorted(plan.known)
    before = [number for number in known if lacking and number < lacking[0]]
    return sorted({*lacking, *known[:1], *before[-1:]})


@contextmanager
def _own_folder(slug: str) -> Iterator[Path]:
    """A folder for pictures on their way; what a killed run left in it is removed."""
    root = settings.DATA_DIR / "unfinished"
    root.mkdir(parents=True, exist_ok=True)
    folder = root / f"videos-{slug}"
    with (root / f"videos-{slug}.lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            reason = "another import of videos into this dataset is running"
            raise FormatError([Problem(slug, "", reason)]) from None
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)
