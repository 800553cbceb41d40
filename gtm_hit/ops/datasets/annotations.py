"""Annotation files into rows of a layer, and their boxes compared with the rectangle table."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gtm_hit.formats.annotations.wildtrack_json import PersonPosition, read_frame
from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Annotation, Dataset
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.frames.rules import HEIGHTS, MAX_PEOPLE, RADII, is_number
from gtm_hit.ops.jobs.progress import Steps

MISSING = -(2**31)  # files have no number as low


@dataclass(frozen=True, eq=False, slots=True)
class ImportedFrame:
    """The people of one frame by person, in a fraction of what rows take: an hour has a million.

    heights, radii : (N,) metres, NaN for the dataset's cylinder
    boxes : (N, C, 4) int32 as they stand in the file, `MISSING` for those without; or None
    """

    number: int
    persons: NDArray[np.int64]
    positions: NDArray[np.int64]
    heights: NDArray[np.float64]
    radii: NDArray[np.float64]
    boxes: NDArray[np.int32] | None = None
    origin: str = Annotation.Origin.IMPORTED.value

    def __len__(self) -> int:
        return len(self.persons)

    def rows(self) -> list[Row]:
        columns: Sequence[list] = [
            self.persons.tolist(),
            self.positions.tolist(),
            _or_none(self.heights),
            _or_none(self.radii),
        ]
        state = Annotation.State.VALIDATED.value
        return [
            Row(person, position, state, self.origin, height, radius)
            for person, position, height, radius in zip(*columns, strict=True)
        ]


@dataclass
class ReadAnnotations:
    """`ignored_sizes`: people with a height or radius in their file that nobody can have in metres."""

    frames: list[ImportedFrame] = field(default_factory=list)
    ignored_sizes: int = 0


def read_annotations(
    paths: Mapping[int, Path],
    dataset: Dataset,
    cameras: int,
    progress: Steps,
    problems: ProblemList,
) -> ReadAnnotations:
    """The frames of files by frame number; bad files are problems, with all that is wrong in them."""
    grid, cylinder = dataset.grid, dataset.cylinder
    found = ReadAnnotations()
    for done, (number, path) in enumerate(sorted(paths.items()), start=1):
        try:
            # Positions are the truth; a file without boxes loses nothing.
            people = read_frame(path, grid, cameras).people
        except FormatError as error:
            problems.extend(error.problems)
        else:
            if len(people) > MAX_PEOPLE:
                problems.add("", f"{len(people)} people; at most {MAX_PEOPLE} fit in a frame", path)
            # The reader has refused what `frames.rules.checked` would, and is several times as fast.
            found.frames.append(frame_of(number, people, cylinder))
            found.ignored_sizes += sum(map(_has_foreign_size, people))
        progress(done, len(paths))
    return found


def frame_of(number: int, people: Sequence[PersonPosition], usual: Cylinder) -> ImportedFrame:
    people = sorted(people, key=lambda person: person.person)
    sizes = [cylinder_of(person, usual) for person in people]
    return ImportedFrame(
        number,
        np.array([person.person for person in people], dtype=np.int64),
        np.array([person.position for person in people], dtype=np.int64),
        _unusual([size.height for size in sizes], usual.height),
        _unusual([size.radius for size in sizes], usual.radius),
        _boxes([person.boxes for person in people]),
    )


def compare_boxes(
    frames: Iterable[ImportedFrame],
    table: RectangleTable,
    cameras: Sequence[Camera],
    rule: FootRule,
    cylinder: Cylinder,
) -> tuple[int, int]:
    """Boxes in the files that are not the table's, of how many; -1 everywhere means not visible."""
    groups: dict[Cylinder, list[tuple[int, NDArray[np.int32]]]] = defaultdict(list)
    different = total = 0
    for frame in frames:
        if frame.boxes is None:
            continue
        given = frame.boxes[:, 0, 0] != MISSING
        usual = given & np.isnan(frame.heights) & np.isnan(frame.radii)
        different += _different(frame.boxes[usual], *table.rectangles(frame.positions[usual]))
        total += int(given.sum()) * frame.boxes.shape[1]
        for row in np.flatnonzero(given & ~usual).tolist():
            size = Cylinder(_or(frame.radii[row], cylinder.radius), _or(frame.heights[row], cylinder.height))
            groups[size].append((int(frame.positions[row]), frame.boxes[row]))
    for size, people in groups.items():
        positions = np.array([position for position, _boxes in people])
        pairs = [rectangles(camera, table.grid, size, rule, positions) for camera in cameras]
        boxes, visible = (np.stack([pair[side] for pair in pairs], axis=1) for side in (0, 1))
        different += _different(np.stack([given for _position, given in people]), boxes, visible)
    return different, total


def _different(given: np.ndarray, boxes: np.ndarray, visible: np.ndarray) -> int:
    return int((given != np.where(visible[..., None], boxes, -1)).any(axis=2).sum())


def cylinder_of(person: PersonPosition, usual: Cylinder) -> Cylinder:
    height, radius = person.extra.get("height"), person.extra.get("radius")
    return Cylinder(
        float(radius) if is_number(radius, *RADII) else usual.radius,  # type: ignore[arg-type]
        float(height) if is_number(height, *HEIGHTS) else usual.height,  # type: ignore[arg-type]
    )


def _boxes(given: list[np.ndarray | None]) -> NDArray[np.int32] | None:
    shape = next((boxes.shape for boxes in given if boxes is not None), None)
    if shape is None:
        return None
    return np.stack([np.full(shape, MISSING, np.int32) if boxes is None else boxes for boxes in given])


def _unusual(values: list[float], usual: float) -> NDArray[np.float64]:
    return np.array([np.nan if value == usual else value for value in values], dtype=np.float64)


def _or(value: float, usual: float) -> float:
    return usual if np.isnan(value) else float(value)


def _or_none(values: NDArray[np.float64]) -> list[float | None]:
    # NaN is the only number that differs from itself.
    return [value if value == value else None for value in values.tolist()]


def _has_foreign_size(person: PersonPosition) -> bool:
    return any(
        _foreign(person.extra, key, limits) for key, limits in (("height", HEIGHTS), ("radius", RADII))
    )


def _foreign(extra: Mapping[str, Any], key: str, limits: tuple[float, float]) -> bool:
    value = extra.get(key)
    return value is not None and not is_number(value, *limits)
