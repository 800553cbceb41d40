"""What reading a file takes, in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.conftest import REPOSITORY

MEASURE = """
import resource, sys
from pathlib import Path
from gtm_hit.formats.annotations import frame_column_row
from gtm_hit.formats.annotations.coco import read_coco
from gtm_hit.formats.annotations.csv_metres import read_csv
from gtm_hit.formats.annotations.mot import read_mot
from gtm_hit.formats.problems import FormatError
resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
path = Path(sys.argv[1])

def peak():
    # Not getrusage: what it tells begins with the memory of the process that started this one.
    status = Path("/proc/self/status").read_text()
    return int(status.partition("VmHWM:")[2].split()[0])

reader = {
    "coco": lambda: read_coco(path),
    "csv": lambda: read_csv(path),
    "mot": lambda: read_mot(path, range(1, 2**31)),
    "text": lambda: frame_column_row.read(path, persons=None, repeated=True),
}[sys.argv[2]]
before = peak()
try:
    reader()
except FormatError:
    pass
print((peak() - before) // 1024)
"""


def empty_boxes(size: int) -> str:
    return '{"images": [], "annotations": [' + "{}," * (size // 3) + "{}]}"


def csv_rows(size: int) -> str:
    return "frame,person,x,y\n" + "".join(f"{n // 30},{n % 30},1.25,2.125\n" for n in range(size // 21))


def mot_rows(size: int) -> str:
    return "".join(f"{n // 30 + 1},{n % 30 + 1},10,20,30,40.5,1,1,1\n" for n in range(size // 29))


def text_rows(size: int) -> str:
    return "".join(f"{n // 30} {n % 80} {n % 60} {n % 30}\n" for n in range(size // 15))


@pytest.mark.parametrize(
    ("kind", "text"), [("coco", empty_boxes), ("csv", csv_rows), ("mot", mot_rows), ("text", text_rows)]
)
def test_a_file_takes_a_few_times_its_size(tmp_path: Path, kind: str, text: Callable[[int], str]) -> None:
    path = tmp_path / "file"
    path.write_text(text(6_000_000))
    command = [sys.executable, "-c", MEASURE, str(path), kind]
    told = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, timeout=120, check=True)
    assert int(told.stdout) < 6 * 8  # megabytes
