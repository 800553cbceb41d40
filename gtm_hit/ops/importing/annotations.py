"""Annotation files into rows of a layer, and their boxes compared with the rectangle table."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.formats.wildtrack_json import PersonPosition, read_frame
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Annotation, Dataset
from gtm_hit.ops.annotation_rules import HEIGHTS, MAX_PEOPLE, RADII, Row, is_number
from gtm_hit.ops.jobs_progress import Steps


@dataclass(frozen=True)
class ImportedFrame:
    """The people of one file as they go into a layer, and as they stand in the file."""

    number: int
    rows: list[Row]
    people: list[PersonPosition]


def read_annotations(
    paths: Mapping[int, Path],
    dataset: Dataset,
    cameras: int,
    progress: Steps,
    problems: ProblemList,
) -> list[ImportedFrame]:
    """The frames of files by frame number; bad files are problems, with all that is wrong in them."""
    grid, cylinder = dataset.grid, dataset.cylinder
    frames = []
    for done, (number, path) in enumerate(sorted(paths.items()), start=1):
        try:
            # Positions are the truth; a file without boxes loses nothing.
            people = read_frame(path, grid, cameras, views_required=False).people
        except FormatError as error:
            problems.extend(error.problems)
        else:
            if len(people) > MAX_PEOPLE:
                problems.add("", f"{len(people)} people; at most {MAX_PEOPLE} fit in a frame", path)
            # The reader has refused what `annotation_rules.checked` would, and is several times as fast.
            rows = sorted((row_of(person, cylinder) for person in people), key=lambda row: row["person"])
            frames.append(ImportedFrame(number, rows, people))
        progress(done, len(paths))
    return frames


def ignored_sizes(frames: Sequence[ImportedFrame]) -> int:
    """How many people have a height or radius in their file that nobody can have in metres."""
    return sum(
        any(_foreign(person.extra, key, limits) for key, limits in (("height", HEIGHTS), ("radius", RADII)))
        for frame in frames
        for person in frame.people
    )


def compare_boxes(
    frames: Sequence[ImportedFrame],
    table: RectangleTable,
    cameras: Sequence[Camera],
    rule: FootRule,
    cylinder: Cylinder,
) -> tuple[int, int]:
    """Boxes in the files that are not the table's, of how many; -1 everywhere means not visible."""
    groups: dict[Cylinder, list[PersonPosition]] = defaultdict(list)
    for frame in frames:
        for person in frame.people:
            if person.boxes is not None:
                groups[cylinder_of(person, cylinder)].append(person)
    different = total = 0
    for size, people in groups.items():
        positions = np.array([person.position for person in people])
        given = np.stack([person.boxes for person in people if person.boxes is not None])
        if size == cylinder:
            boxes, visible = table.rectangles(positions)
        else:
            pairs = [rectangles(camera, table.grid, size, rule, positions) for camera in cameras]
            boxes = np.stack([pair[0] for pair in pairs], axis=1)
            visible = np.stack([pair[1] for pair in pairs], axis=1)
        expected = np.where(visible[..., None], boxes, -1)
        different += int((given != expected).any(axis=2).sum())
        total += given.shape[0] * given.shape[1]
    return different, total


def row_of(person: PersonPosition, cylinder: Cylinder) -> Row:
    size = cylinder_of(person, cylinder)
    return {
        "person": person.person,
        "position": person.position,
        "state": Annotation.State.VALIDATED.value,
        "origin": Annotation.Origin.IMPORTED.value,
        "height": None if size.height == cylinder.height else size.height,
        "radius": None if size.radius == cylinder.radius else size.radius,
    }


def cylinder_of(person: PersonPosition, usual: Cylinder) -> Cylinder:
    height, radius = person.extra.get("height"), person.extra.get("radius")
    return Cylinder(
        float(radius) if is_number(radius, *RADII) else usual.radius,  # type: ignore[arg-type]
        float(height) if is_number(height, *HEIGHTS) else usual.height,  # type: ignore[arg-type]
    )


def _foreign(extra: Mapping[str, Any], key: str, limits: tuple[float, float]) -> bool:
    value = extra.get(key)
    return value is not None and not is_number(value, *limits)
