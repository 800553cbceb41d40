"""The import itself: everything is read and checked before one row is written."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from django.core.exceptions import ValidationError
from django.db import IntegrityError, transaction

from gtm_hit.formats.problems import FormatError, Problem
from gtm_hit.models import Dataset, Frame, Layer
from gtm_hit.ops.datasets import rows
from gtm_hit.ops.datasets.annotations import ImportedFrame
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.frames.rules import HEIGHTS, RADII
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.jobs.progress import WRITING, Progress
from gtm_hit.ops.layers import findings as sieve
from gtm_hit.ops.layers import unfinished
from gtm_hit.ops.layers.exported import part_of
from gtm_hit.ops.layers.findings import Findings, Kind
from gtm_hit.ops.layers.placing import place
from gtm_hit.ops.layers.reading import READERS, Scene
from gtm_hit.ops.layers.tables import Boxes, People

TABLE = "computing the rectangle table"


@dataclass(frozen=True)
class AnnotationSource:
    """What to import, as what, and which findings to drop."""

    path: Path
    format: str
    layer: str = "imported"
    hidden: bool = False
    drop: Collection[Kind] = ()


@dataclass(frozen=True)
class LayerReport:
    layer: Layer
    frames: int
    people: int
    annotations: int
    dropped: dict[Kind, int]


def no_confirmation() -> None:
    pass


def import_annotations(
    dataset: Dataset,
    source: AnnotationSource,
    report: Progress,
    confirm: Callable[[], None] = no_confirmation,
    remember: Callable[[LayerReport], None] | None = None,
) -> LayerReport:
    """Make a layer of annotation files.

    Raises ImportFailed with everything that is wrong or does not fit and is not to be dropped; then nothing
    is imported. `confirm` is asked once before the layer appears, `remember` told in that transaction.
    """
    findings = Findings(frozenset(source.drop))
    try:
        _check_layer(dataset, source.layer)
        people = read_people(dataset, source, report, findings)
        findings.standing.raise_if_any()
    except FormatError as error:
        raise ImportFailed(_seen_from(source.path, error.problems)) from error
    if not len(people) and not people.empty:
        raise ImportFailed((Problem(source.path.name, "", "holds no annotation of this dataset"),))
    frames = len(np.union1d(people.frames, np.array(people.empty, dtype=np.int64)))
    with unfinished.layer(dataset, hidden=source.hidden) as layer:
        rows.add_annotations(layer, _told(_frames(people), frames, report))
        confirm()
        done = LayerReport(layer, frames, len(np.unique(people.persons)), len(people), findings.dropped)
        try:
            with transaction.atomic():
                unfinished.appear(layer, source.layer)
                if remember:
                    remember(done)
        except IntegrityError as error:
            reason = "was made by somebody else in the meantime; choose another name"
            raise ImportFailed((Problem(source.layer, "", reason),)) from error
    return done


def read_people(dataset: Dataset, source: AnnotationSource, report: Progress, findings: Findings) -> People:
    """Everybody the files tell of, on the dataset's grid; raises FormatError."""
    cameras = dataset.calibrated_cameras()
    numbers = list(Frame.objects.filter(dataset=dataset).order_by("number").values_list("number", flat=True))
    scene = Scene(dataset, [camera.name for camera in cameras], numbers)
    found = READERS[source.format](part_of(source.path, source.format), scene, report)
    known = frozenset(numbers)
    if isinstance(found, Boxes):
        boxes = sieve.of_known_frames(found, known, findings)
        boxes = sieve.each_box_once(sieve.of_known_cameras(boxes, findings), findings)
        rectangles = table(dataset, lambda done, total: report(TABLE, done, total))
        people = place(boxes, rectangles, cameras, report)
        empty = sorted(set(boxes.empty) - set(people.frames.tolist()))
        people = People(**{**vars(people), "empty": empty})
    else:
        people = sieve.each_person_once(sieve.of_known_frames(found, known, findings), findings)
    _check_sizes(people)
    return sieve.on_the_grid(people, dataset.grid, findings)


def _check_layer(dataset: Dataset, name: str) -> None:
    problem = ""
    try:
        Layer(name=name, kind=Layer.Kind.IMPORTED).clean_fields(exclude=["dataset"])
    except ValidationError as error:
        problem = " ".join(error.messages)
    if Layer.objects.filter(dataset=dataset, name=name).exists():
        problem = "is there already: choose another name"
    if problem:
        raise FormatError([Problem("", "", f"layer {name} {problem}")])


def _check_sizes(people: People) -> None:
    problems = []
    for name, values, limits in (("height", people.heights, HEIGHTS), ("radius", people.radii, RADII)):
        for row in np.flatnonzero((values < limits[0]) | (values > limits[1])).tolist():
            reason = f"{name} {values[row]} is not one from {limits[0]} to {limits[1]} m"
            problems.append(people.sources.problem(row, reason))
    if problems:
        raise FormatError(problems)


def _frames(people: People) -> Iterator[ImportedFrame]:
    """By number, also frames with nobody."""
    order = np.lexsort((people.persons, people.frames))
    numbers, starts = np.unique(people.frames[order], return_index=True)
    ends = np.append(starts, len(order))[1:]
    found = {
        number: order[start:end]
        for number, start, end in zip(numbers.tolist(), starts.tolist(), ends.tolist(), strict=True)
    }
    for number in sorted({*found, *people.empty}):
        rows = found.get(number, np.zeros(0, np.int64))
        yield ImportedFrame(
            number, people.persons[rows], people.positions[rows], people.heights[rows], people.radii[rows]
        )


def _told(frames: Iterator[ImportedFrame], total: int, report: Progress) -> Iterator[ImportedFrame]:
    for done, frame in enumerate(frames, start=1):
        report(WRITING, done, total)
        yield frame


def _seen_from(path: Path, problems: Sequence[Problem]) -> tuple[Problem, ...]:
    folder = path if path.is_dir() else path.parent
    return FormatError(problems).relative_to(folder).problems
