"""Everything about an import of videos that can be wrong, found before the first picture is taken."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from gtm_hit.formats.calibration.files import find_calibrations
from gtm_hit.formats.dataset_folder import DatasetFolder, natural_key
from gtm_hit.formats.problems import ProblemList
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Dataset, Frame
from gtm_hit.ops.calibration.cameras import read_views, tell_differences, tell_wrong_unit
from gtm_hit.ops.datasets.options import ImportOptions, SceneValues, scene, tell_too_many
from gtm_hit.ops.datasets.videos.options import VideoOptions, VideoSource
from gtm_hit.ops.datasets.videos.video import Facts, VideoError, probe

USUAL = SceneValues(frame_rate=10.0, frame_step=5)
MOST_OFF_CENTRE = 0.2  # of the image's size; a calibration made at another resolution is farther off


@dataclass(frozen=True)
class Plan:
    """`numbers`: frames to take that lie in the videos by what their headers say; the videos may end earlier.

    `known`: those among them the dataset has. `sources` are in the order of the cameras.
    """

    sources: tuple[VideoSource, ...]
    facts: Mapping[str, Facts]
    rate: float
    numbers: range
    known: frozenset[int]

    def time(self, source: VideoSource, number: int) -> float:
        """When a frame is in a video, seconds."""
        return source.time(number / self.rate)


def with_usual_values(options: VideoOptions) -> VideoOptions:
    """WILDTRACK's frames, unless something else was said or is known."""
    if options.dataset.preset or existing_dataset(options):
        return options
    values = SceneValues(**{**USUAL, **options.dataset.values})
    return replace(options, dataset=replace(options.dataset, values=values))


def existing_dataset(options: VideoOptions) -> Dataset | None:
    return Dataset.objects.filter(slug=options.dataset.slug).first()


def make_plan(options: VideoOptions, problems: ProblemList) -> Plan:
    """Raises FormatError with everything that is wrong."""
    existing = existing_dataset(options)
    dataset = scene(options.dataset, existing, problems)
    problems.raise_if_any()
    sources = tuple(sorted(options.sources, key=lambda source: natural_key(source.camera)))
    _tell_twice(sources, problems)
    tell_too_many(dataset, len(sources), problems)
    facts = _probe(sources, problems)
    _check_calibration(options.dataset, dataset, existing, sources, facts, problems)
    numbers = _numbers(options, dataset, sources, facts, problems) if len(facts) == len(sources) else range(0)
    problems.raise_if_any()
    known = Frame.objects.filter(dataset=existing).values_list("number", flat=True) if existing else ()
    return Plan(sources, facts, dataset.frame_rate, numbers, frozenset(known) & frozenset(numbers))


def _tell_twice(sources: Sequence[VideoSource], problems: ProblemList) -> None:
    if not sources:
        problems.add("options", "no video is named")
    for name, times in Counter(source.camera for source in sources).items():
        if times > 1:
            problems.add("options", f"camera {name} has {times} videos")
    for path, times in Counter(source.path.resolve() for source in sources).items():
        if times > 1:
            problems.add("", f"is the video of {times} cameras", path)


def _probe(sources: Sequence[VideoSource], problems: ProblemList) -> dict[str, Facts]:
    facts = {}
    for source in sources:
        try:
            facts[source.camera] = probe(source.path)
        except VideoError as error:
            problems.add(f"camera {source.camera}", str(error), source.path)
    return facts


def _check_calibration(
    options: ImportOptions,
    dataset: Dataset,
    existing: Dataset | None,
    sources: Sequence[VideoSource],
    facts: Mapping[str, Facts],
    problems: ProblemList,
) -> None:
    names = list(dict.fromkeys(source.camera for source in sources))
    files = find_calibrations(DatasetFolder(options.folder, problems), names, options.calibrations)
    sizes = {name: (each.width, each.height) for name, each in facts.items()}
    views = read_views(files, names, sizes, options.unit, options.undistort, problems, options.alpha)
    cameras = [view.camera for view in views]
    for camera in cameras:
        _tell_other_size(camera, problems)
    if len(cameras) == len(names):
        if existing is not None:
            tell_differences(cameras, list(existing.cameras.all()), options.unit, problems)
        else:
            tell_wrong_unit(cameras, dataset.grid, options.unit, problems)


def _tell_other_size(camera: Camera, problems: ProblemList) -> None:
    """OpenCV's calibration files do not state a size, but their middle of the image gives it away."""
    x, y = camera.matrix[0, 2], camera.matrix[1, 2]
    if max(abs(x / camera.width - 0.5), abs(y / camera.height - 0.5)) > MOST_OFF_CENTRE:
        problems.add(
            f"camera {camera.name}",
            f"the calibration has the middle of the image at ({x:.0f}, {y:.0f}), "
            f"but the video has {camera.width}×{camera.height} pixels",
        )


def _numbers(
    options: VideoOptions,
    dataset: Dataset,
    sources: Sequence[VideoSource],
    facts: Mapping[str, Facts],
    problems: ProblemList,
) -> range:
    """Frame numbers that lie in all videos, half an interval of tolerance at both ends."""
    spans = {
        source.camera: (
            (-source.offset - facts[source.camera].interval / 2) / source.pace,
            (facts[source.camera].duration - source.offset - facts[source.camera].interval / 2) / source.pace,
        )
        for source in sources
    }
    start = max([options.start, 0.0, *(first for first, _last in spans.values())])
    end = min([options.until, *(last for _first, last in spans.values())])
    step = dataset.frame_step
    # A nanosecond: 0.3 × 10 is not quite 3.
    first = step * math.ceil((start - 1e-9) * dataset.frame_rate / step)
    stop = math.floor((end + 1e-9) * dataset.frame_rate) + 1
    if not range(first, stop, step):
        told = "; ".join(f"{name} {low:.2f} to {high:.2f} s" for name, (low, high) in spans.items())
        reason = "no frame lies in all videos and in the time asked for: in the time they share, there is"
        problems.add("options", f"{reason} {told}")
    return range(first, stop, step)
