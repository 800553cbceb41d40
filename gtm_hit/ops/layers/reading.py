"""Annotation files of every format into tables."""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gtm_hit.formats.annotations import frame_column_row
from gtm_hit.formats.annotations.coco import CocoFile, CocoImage, read_coco
from gtm_hit.formats.annotations.csv_metres import read_csv
from gtm_hit.formats.annotations.mot import MotTable, read_mot
from gtm_hit.formats.annotations.wildtrack_json import MOST_ID, FrameAnnotations, read_frame
from gtm_hit.formats.dataset_folder import DatasetFolder
from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.geometry.grid import Grid
from gtm_hit.models import Dataset
from gtm_hit.ops.datasets.annotations import cylinder_of
from gtm_hit.ops.jobs.progress import Progress
from gtm_hit.ops.layers.tables import NOBODY, Boxes, Ids, People, Sources, people

READING = "reading annotations"
GROUND = "ground"  # the folder of a MOTChallenge export that says where people stand
ANY_FRAME = range(1, 2**31)  # frames the dataset does not have are told later, line by line

_NUMBER = re.compile(r"([0-9]{1,9})$")


@dataclass(frozen=True, eq=False)
class Scene:
    """What files are read against."""

    dataset: Dataset
    cameras: Sequence[str]  # names, by index
    numbers: Sequence[int]  # of all frames, ascending

    @property
    def grid(self) -> Grid:
        return self.dataset.grid


def read_wildtrack(path: Path, scene: Scene, report: Progress) -> People:
    """A folder of per-frame JSON."""
    problems = ProblemList(path)
    if not path.is_dir():
        problems.add("", "no such folder of JSON files")
        problems.raise_if_any()
    files = DatasetFolder(path, problems).by_number(path, {".json"})
    if not files and not problems:
        problems.add("", "no JSON files in this folder")
    # Positions off the grid are told later, person by person.
    anywhere = Grid(MOST_ID, 1, 1.0, 0.0, 0.0)
    found = _Rows(scene)
    for done, file in enumerate(files.values(), start=1):
        try:
            frame = read_frame(file, anywhere, len(scene.cameras), repeated=True)
            found.add(done - 1, frame)
        except FormatError as error:
            problems.extend(error.problems)
        report(READING, done, len(files))
    problems.raise_if_any()
    return found.people(list(files.values()))


def read_csv_metres(path: Path, scene: Scene, report: Progress) -> People:
    path = _only(path, ".csv")
    table = read_csv(path)
    report(READING, 1, 1)
    sources = _lines(path, table.lines)
    found = people(table.frames, table.persons, scene.grid.position(table.xy), sources)
    if table.heights is None:
        return found
    usual = scene.dataset.cylinder_height
    heights = np.where(table.heights == usual, np.nan, table.heights)
    return People(found.frames, found.persons, found.positions, heights, found.radii, sources)


def read_text(path: Path, scene: Scene, report: Progress) -> People:
    """`frame column row`, and the person where all lines have one."""
    path = _only(path, ".txt")
    table = frame_column_row.read(path, persons=None, repeated=True)
    report(READING, 1, 1)
    grid = scene.grid
    inside = (table.columns < grid.columns) & (table.rows < grid.rows)
    positions = np.where(inside, table.rows * grid.columns + table.columns, NOBODY)
    return people(table.frames, table.persons, positions, _lines(path, table.lines))


def read_mot_files(path: Path, scene: Scene, report: Progress) -> People | Boxes:
    """A file of people on the ground, or a folder with a file per view.

    A folder's ground file says exactly where people stand, so it is taken alone.
    """
    views = {GROUND: path} if path.is_file() else _mot_views(path)
    if GROUND in views and GROUND not in scene.cameras:
        file = views[GROUND]
        return _ground(file, read_mot(file, ANY_FRAME), scene)
    tables: list[tuple[Path, str, MotTable]] = []
    problems = ProblemList(path)
    if not views:
        problems.add("", "no MOTChallenge files: VIEW.txt or VIEW/gt/gt.txt")
    for done, (name, file) in enumerate(views.items(), start=1):
        try:
            tables.append((file, name, read_mot(file, ANY_FRAME)))
        except FormatError as error:
            problems.extend(error.problems)
        report(READING, done, len(views))
    for file, _name, table in tables:
        if table.boxes is None:
            problems.add("", "has people on the ground: import this file alone", file)
    problems.raise_if_any()
    return _boxes_of_mot(tables, scene)


def read_coco_files(path: Path, scene: Scene, report: Progress) -> Boxes:
    """One JSON file with the images of all views, or a folder with a file per view."""
    problems = ProblemList(path)
    files = [path]
    if path.is_dir():
        files = DatasetFolder(path, problems).files(path, {".json"})
        files = [file for file in files if file.name != "manifest.json"]
    if not files:
        problems.add("", "no JSON files in this folder")
    found: list[tuple[Path, CocoFile]] = []
    for done, file in enumerate(files, start=1):
        try:
            found.append((file, read_coco(file)))
        except FormatError as error:
            problems.extend(error.problems)
        report(READING, done, len(files))
    problems.raise_if_any()
    return _boxes_of_coco(found, scene, problems)


READERS: Mapping[str, Callable[[Path, Scene, Progress], People | Boxes]] = {
    "wildtrack": read_wildtrack,
    "text": read_text,
    "mot": read_mot_files,
    "coco": read_coco_files,
    "csv": read_csv_metres,
}


class _Rows:
    """People of file after file, in a few dozen bytes each: a long dataset has a million."""

    def __init__(self, scene: Scene) -> None:
        self.offset, self.usual = scene.dataset.annotation_offset, scene.dataset.cylinder
        self.ids = array("q")  # frame, person, position, file, entry
        self.sizes = array("d")  # height, radius
        self.empty: list[int] = []

    def add(self, file: int, frame: FrameAnnotations) -> None:
        number = frame.number - self.offset
        if not frame.people:
            self.empty.append(number)
        for entry, person in enumerate(frame.people):
            own = "height" in person.extra or "radius" in person.extra
            size = cylinder_of(person, self.usual) if own else self.usual
            self.ids.extend((number, person.person, person.position, file, entry))
            self.sizes.extend((size.height, size.radius))

    def people(self, paths: list[Path]) -> People:
        ids = np.frombuffer(self.ids, dtype=np.int64).reshape(-1, 5)
        heights, radii = np.frombuffer(self.sizes, dtype=np.float64).reshape(-1, 2).T
        return People(
            frames=ids[:, 0],
            persons=ids[:, 1],
            positions=ids[:, 2],
            heights=np.where(heights == self.usual.height, np.nan, heights),
            radii=np.where(radii == self.usual.radius, np.nan, radii),
            sources=Sources(paths, ids[:, 3], ids[:, 4], "entry {}"),
            empty=self.empty,
        )


def _only(path: Path, suffix: str) -> Path:
    """The file itself, or the only one of its kind in a folder."""
    if not path.is_dir():
        return path
    problems = ProblemList(path)
    files = DatasetFolder(path, problems).files(path, {suffix})
    if len(files) != 1:
        problems.add("", f"holds {len(files)} {suffix} files instead of one")
    problems.raise_if_any()
    return files[0]


def _lines(path: Path, lines: Ids | None) -> Sources:
    assert lines is not None  # tables that were read know their lines
    return Sources([path], np.zeros(len(lines), np.int64), lines, "line {}")


def _mot_views(folder: Path) -> dict[str, Path]:
    """Files by the name of their view: VIEW/gt/gt.txt, VIEW/det/det.txt, or VIEW.txt."""
    found: dict[str, Path] = {}
    for entry in DatasetFolder(folder, ProblemList(folder)).entries(folder):
        candidates = [entry / "gt" / "gt.txt", entry / "det" / "det.txt"] if entry.is_dir() else [entry]
        file = next((each for each in candidates if each.is_file() and each.suffix == ".txt"), None)
        if file is not None:
            found.setdefault(entry.name.removesuffix(".txt"), file)
    return found


def _ground(path: Path, table: MotTable, scene: Scene) -> People:
    if table.world is None:
        reason = "has boxes, but a file alone must say where people stand; give the folder of all views"
        problems = ProblemList(path)
        problems.add("", reason)
        problems.raise_if_any()
    assert table.world is not None
    positions = scene.grid.position(table.world[:, :2])
    frames = _frame_numbers(table.frames, scene.numbers)
    return people(frames, table.persons, positions, _lines(path, table.lines))


def _frame_numbers(places: Ids, numbers: Sequence[int]) -> Ids:
    """Frame numbers of places counted from 1; less than 0 where the dataset has no such frame."""
    known = np.array([0, *numbers], dtype=np.int64)
    inside = places < len(known)
    return np.where(inside, known[np.where(inside, places, 0)], -places)


def _boxes_of_mot(tables: Sequence[tuple[Path, str, MotTable]], scene: Scene) -> Boxes:
    parts = []
    for file, (_path, name, table) in enumerate(tables):
        assert table.boxes is not None and table.lines is not None
        # A confidence of 0 marks what the benchmark itself leaves out.
        counted = (table.confidences != 0) & ~np.isnan(table.boxes[:, 0])
        count = int(counted.sum())
        persons = np.full(count, NOBODY) if table.persons is None else table.persons[counted]
        frames = _frame_numbers(table.frames[counted], scene.numbers)
        camera = camera_index(name, scene.cameras)
        ids = [frames, np.full(count, camera), persons, np.full(count, file), table.lines[counted]]
        parts.append((np.stack(ids), table.boxes[counted]))
    columns = np.concatenate([each for each, _ in parts], axis=1).astype(np.int64)
    return Boxes(
        frames=columns[0],
        cameras=columns[1],
        persons=columns[2],
        positions=np.full(columns.shape[1], NOBODY),
        boxes=np.concatenate([boxes for _, boxes in parts]),
        sources=Sources([path for path, _, _ in tables], columns[3], columns[4], "line {}"),
    )


def _boxes_of_coco(files: Iterable[tuple[Path, CocoFile]], scene: Scene, problems: ProblemList) -> Boxes:
    # In a few dozen bytes per box: a long dataset has millions.
    rows, sides, paths, seen = array("q"), array("d"), [], set()
    for file, (path, content) in enumerate(files):
        paths.append(path)
        views = {image.id: _view(image, path, scene, problems) for image in content.images}
        seen |= {frame for frame, _ in views.values()}
        for box in content.boxes:
            frame, camera = views[box.image]
            person = NOBODY if box.person is None else box.person
            position = NOBODY if box.position is None else box.position
            rows.extend((frame, camera, person, position, file, box.id))
            sides.extend(box.box)
    problems.raise_if_any()
    columns = np.frombuffer(rows, dtype=np.int64).reshape(-1, 6).T
    return Boxes(
        frames=columns[0],
        cameras=columns[1],
        persons=columns[2],
        positions=columns[3],
        boxes=np.frombuffer(sides, dtype=np.float64).reshape(-1, 4),
        sources=Sources(paths, columns[4], columns[5], "annotation {}"),
        empty=sorted(seen - set(columns[0].tolist())),
    )


def _view(image: CocoImage, path: Path, scene: Scene, problems: ProblemList) -> tuple[int, int]:
    """Frame number and camera of an image: by the project's own keys, else by names of folders and files."""
    name = Path(image.file_name)
    frame = image.frame
    if frame is None:
        match = _NUMBER.search(name.stem)
        if match is None:
            problems.add(f"image {image.id}", "neither frame nor file_name tells the frame's number", path)
        frame = int(match[1]) if match else 0
    if image.camera is not None:
        return frame, image.camera if image.camera < len(scene.cameras) else NOBODY
    indices = (camera_index(each, scene.cameras) for each in (name.parent.name, path.stem))
    return frame, next((index for index in indices if index != NOBODY), NOBODY)


def camera_index(name: str, cameras: Sequence[str]) -> int:
    """By name, also behind the name of a sequence (`street-C1`); NOBODY if there is none."""
    for index, camera in enumerate(cameras):
        if name == camera or re.search(rf"[-_.]{re.escape(camera)}$", name):
            return index
    return NOBODY
