"""What imports hold in memory at a time."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time
import tracemalloc
from pathlib import Path
from typing import Any

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from gtm_hit.formats.problems import ProblemList
from gtm_hit.models import Dataset
from gtm_hit.ops.datasets import pictures
from gtm_hit.ops.datasets.annotations import read_annotations
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.datasets.options import tell_too_many
from gtm_hit.ops.datasets.pictures import Picture, make_pictures
from tests.conftest import REPOSITORY
from tests.dataset_folder import make_folder, options

LONG_GRID = """
import resource, sys
from pathlib import Path
from gtm_hit.geometry.cylinder import Cylinder, FootRule
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.table import RectangleTable
from tests.geometry.scenes import wildtrack_cameras
resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

def peak():
    # Not getrusage: what it tells begins with the memory of the process that started this one.
    status = Path("/proc/self/status").read_text()
    return int(status.partition("VmHWM:")[2].split()[0])

before = peak()
grid = Grid(2_000_000, 1, 0.1, -4.0, -3.0)
RectangleTable.build(Path(sys.argv[1]), wildtrack_cameras()[:1], grid, Cylinder(0.16, 1.8), FootRule.CORNERS)
print((peak() - before) // 1024)
"""


def test_a_grid_of_one_long_row_takes_the_memory_of_its_table_alone(tmp_path: Path) -> None:
    command = [sys.executable, "-c", LONG_GRID, str(tmp_path)]
    told = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, timeout=120, check=True)
    assert int(told.stdout) < 100  # megabytes; the table has 16


def test_a_table_of_too_many_cameras_is_refused_with_what_is_sensible() -> None:
    problems = ProblemList("")
    tell_too_many(Dataset(columns=4000, rows=4000), 20, problems)
    assert [problem.reason for problem in problems.found] == [
        "--grid has 16,000,000 positions, which 20 cameras make 320,000,000 rectangles; "
        "at most 160,000,000 are sensible: 8,000,000 positions"
    ]


class Watched:
    """Stands in for decoding; remembers how much was decoded at once."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.now = self.most = self.count = 0

    def make(self, picture: Picture, only_check: bool) -> None:
        with self.lock:
            self.now += picture.pixels
            self.count += 1
            self.most = max(self.most, self.now)
        time.sleep(0.005)
        with self.lock:
            self.now -= picture.pixels


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> Watched:
    watched = Watched()
    monkeypatch.setattr(pictures, "_make", watched.make)
    monkeypatch.setattr("os.sched_getaffinity", lambda _process: range(8))
    return watched


def of(pixels: int, count: int) -> list[Picture]:
    return [Picture((0, number), Path(f"{number}.png"), pixels) for number in range(count)]


def test_the_largest_pictures_are_decoded_one_at_a_time(watched: Watched) -> None:
    make_pictures(of(100_000_000, 6), lambda *_: None, ProblemList(""))
    assert (watched.count, watched.most) == (6, 100_000_000)


def test_usual_pictures_are_decoded_by_all_threads(watched: Watched) -> None:
    make_pictures(of(2_000_000, 60), lambda *_: None, ProblemList(""))
    assert (watched.count, watched.most > 2_000_000) == (60, True)


def test_pictures_are_not_all_queued_at_once(watched: Watched) -> None:
    taken: list[tuple[int, int]] = []

    class Counted(list[Picture]):
        def __iter__(self):  # type: ignore[no-untyped-def]
            for number, picture in enumerate(list.__iter__(self)):
                taken.append((number, watched.count))
                yield picture

    make_pictures(Counted(of(100, 200)), lambda *_: None, ProblemList(""))
    assert max(number - begun for number, begun in taken if number < 200) <= 2 * 8


@pytest.mark.django_db
def test_only_images_of_the_frames_at_hand_are_compared(tmp_path: Path, settings: Any) -> None:
    settings.MEDIA_ROOT, settings.TABLES_ROOT = tmp_path / "media", tmp_path / "tables"
    import_dataset(options(make_folder(tmp_path / "first", (0, 5, 10))))
    with CaptureQueriesContext(connection) as captured:
        import_dataset(options(make_folder(tmp_path / "second", (10, 15))))
    (asked,) = [
        query["sql"]
        for query in captured
        if query["sql"].startswith("SELECT") and "source_digest" in query["sql"]
    ]
    assert "IN (10, 15)" in asked


def test_a_person_to_be_imported_takes_a_few_numbers(tmp_path: Path) -> None:
    views = [{"viewNum": 0, "xmin": 1000, "ymin": 1000, "xmax": 2000, "ymax": 2000}]
    people = [{"personID": each + 1000, "positionID": each + 1000, "views": views} for each in range(500)]
    paths = {number: tmp_path / f"{number:08d}.json" for number in range(20)}
    for path in paths.values():
        path.write_text(json.dumps(people))
    tracemalloc.start()
    read = read_annotations(paths, Dataset(), 1, lambda *_: None, ProblemList(""))
    held, _most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert sum(map(len, read.frames)) == 10_000
    assert held / 10_000 < 150  # bytes
