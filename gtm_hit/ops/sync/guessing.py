"""A first guess of how far apart the clocks of videos are: by sound, else by motion on the shared ground."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from gtm_hit.calibration.sync.align import Found, align
from gtm_hit.calibration.sync.ground import ground_meters
from gtm_hit.calibration.sync.motion import Meter, MotionReader, WholePicture, small
from gtm_hit.calibration.sync.series import Series, SyncError
from gtm_hit.calibration.sync.sound import read_sound
from gtm_hit.formats.problems import FormatError
from gtm_hit.ops.datasets.videos.video import Facts, VideoError, VideoReader, opened, probe
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.jobs.progress import Progress, no_progress
from gtm_hit.ops.sync.cameras import cameras_as_taken, why_none

SECONDS = 120.0  # of every video that are looked at
COMPARING = "comparing videos"
SURELY = 12.0  # deviations of chance


class SyncRefused(OperationError, ValueError):
    """Nothing could be guessed; says why."""


@dataclass(frozen=True)
class Video:
    camera: str
    path: Path


@dataclass(frozen=True)
class Place:
    """`offset`: the second in the video at which the shared time is 0, as for imports; None: not found."""

    camera: str
    offset: float | None
    confidence: str  # "sure", "likely" or "none"
    alike: float  # correlation with the others, 0 … 1


@dataclass(frozen=True)
class Guess:
    basis: str  # "sound", "ground" or "picture"
    told: str  # what it was guessed from, a sentence
    places: tuple[Place, ...]

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


def guess(
    videos: Sequence[Video],
    calibrations: Path | None = None,
    seconds: float = SECONDS,
    progress: Progress = no_progress,
) -> Guess:
    """Raises SyncRefused where nothing in the videos tells."""
    if len(videos) < 2:
        raise SyncRefused("Two videos at least are needed.")
    facts = {video.camera: _probed(video) for video in videos}
    if len(facts) < len(videos):
        raise SyncRefused("Two videos have the same camera.")
    by_sound, unheard = _by_sound(videos, progress)
    if by_sound is not None:
        return by_sound
    basis, meters, told = _meters(facts, calibrations)
    series = _read(videos, meters, facts, seconds, progress)
    try:
        found = align(series, partial(progress, COMPARING))
    except SyncError as error:
        raise SyncRefused(f"{_capital(str(error))}: nothing was guessed. {unheard} {told}") from error
    return _guess(videos, found, basis, f"{told} {unheard}")


def _probed(video: Video) -> Facts:
    try:
        return probe(video.path)
    except VideoError as error:
        raise SyncRefused(f"{video.path.name}: {error}.") from error


def _by_sound(videos: Sequence[Video], progress: Progress) -> tuple[Guess | None, str]:
    """From WAV files beside the videos; else None, and why not."""
    paths = [sound_of(video.path) for video in videos]
    missing = [video.path.name for video, path in zip(videos, paths, strict=True) if path is None]
    if missing:
        which = "any video" if len(missing) == len(videos) else ", ".join(missing)
        return None, f"There is no sound: no WAV file lies beside {which}."
    try:
        series = []
        for done, path in enumerate(paths):
            progress("listening", done, len(paths))
            assert path is not None
            series.append(read_sound(path))
        found = align(series, partial(progress, COMPARING))
    except SyncError as error:
        return None, f"The sound told nothing: {error}."
    if None in found:
        return None, "The sound of some videos is not that of the others."
    told = (
        "By sound, from the WAV files beside the videos. Sound travels 17 m in 50 ms: "
        "check by eye what is far from a camera."
    )
    return _guess(videos, found, "sound", told), ""


def sound_of(video: Path) -> Path | None:
    """The WAV file of the same name, in whatever capitals its suffix is."""
    return next((path for suffix in (".wav", ".WAV") if (path := video.with_suffix(suffix)).is_file()), None)


def _meters(facts: dict[str, Facts], calibrations: Path | None) -> tuple[str, Sequence[Meter], str]:
    """Where motion is measured, and the sentence that says so."""
    by_picture = "By how much moves in the whole pictures, which is a weak hint"
    if calibrations is None:
        return "picture", [WholePicture() for _ in facts], f"{by_picture}: no calibration was given."
    try:
        sizes = {name: (each.width, each.height) for name, each in facts.items()}
        meters = ground_meters(cameras_as_taken(calibrations, sizes))
    except FormatError as error:
        reason = f"no calibration ({why_none(error)})"
    except SyncError as error:
        reason = str(error)
    else:
        return "ground", meters, "By who walks where on the ground that the cameras see together."
    return "picture", [WholePicture() for _ in facts], f"{by_picture}: {reason}."


def _read(
    videos: Sequence[Video],
    meters: Sequence[Meter],
    facts: dict[str, Facts],
    seconds: float,
    progress: Progress,
) -> list[Series]:
    lengths = [min(facts[video.camera].duration, seconds) for video in videos]
    before, found = 0.0, []
    for video, meter, length in zip(videos, meters, lengths, strict=True):
        tell = partial(_tell, progress, f"watching {video.camera}", before, sum(lengths))
        reader = MotionReader(meter)
        for time, picture in _pictures(video, facts[video.camera].interval, seconds, reader.wants, tell):
            reader.add(time, picture)
        try:
            found.append(reader.series())
        except SyncError as error:
            raise SyncRefused(f"{video.path.name}: {error}.") from error
        before += length
    return found


def _tell(progress: Progress, phase: str, before: float, total: float, time: float) -> None:
    progress(phase, min(round(before + time), round(total)), round(total))


def _pictures(
    video: Video,
    interval: float,
    seconds: float,
    wanted: Callable[[float], bool],
    tell: Callable[[float], object],
) -> Iterator[tuple[float, Any]]:
    reader = VideoReader(opened(video.path), interval)
    while (time := reader.grab()) is not None and time < seconds:
        if wanted(time):
            tell(time)
            yield time, small(reader.pixels())


def _guess(videos: Sequence[Video], found: Sequence[Found | None], basis: str, told: str) -> Guess:
    """Time 0 of all is the first instant that every video placed has: no offset is negative."""
    # A place says how much later in this video something is; the video that began last has the smallest.
    least = min(each.offset for each in found if each is not None)
    places = []
    for video, each in zip(videos, found, strict=True):
        if each is None:
            places.append(Place(video.camera, None, "none", 0.0))
            continue
        confidence = "sure" if each.lag.outstanding >= SURELY else "likely"
        offset = round(each.offset - least, 3)
        places.append(Place(video.camera, offset, confidence, round(max(each.lag.alike, 0.0), 3)))
    lost = [place.camera for place in places if place.offset is None]
    if lost:
        told += f" Nothing was found for {', '.join(lost)}: set by hand."
    return Guess(basis, told.strip(), tuple(places))


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
