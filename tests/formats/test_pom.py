from __future__ import annotations

import re
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.formats import pom
from gtm_hit.formats.pom import PomHeader, header_text, write_pom
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.cylinder import Cylinder
from gtm_hit.geometry.grid import Grid
from tests.formats import pom_reader
from tests.formats.pom_reader import read_pom

WILDTRACK = PomHeader(Grid(480, 1440, 0.025, -3.0, -9.0), Cylinder(0.16, 1.8), 7)
SMALL = PomHeader(Grid(3, 2, 0.5, -1.0, 2.25), Cylinder(0.16, 1.8), 2)
HEAD = header_text(SMALL)


class Table:
    """Rectangles as `pom` takes them, from plain arrays."""

    def __init__(self, boxes: np.ndarray, visible: np.ndarray) -> None:
        self._boxes, self._visible = boxes, visible

    def boxes(self, camera_index: int) -> np.ndarray:
        return self._boxes[camera_index]

    def visible(self, camera_index: int) -> np.ndarray:
        return self._visible[camera_index]


def some_table(header: PomHeader, seed: int = 0) -> Table:
    rng = np.random.default_rng(seed)
    shape = (header.cameras, header.grid.count)
    boxes = rng.integers(-50, 1900, (*shape, 4)).astype(np.int16)
    boxes[..., 2:] = boxes[..., :2] + rng.integers(2, 100, (*shape, 2)).astype(np.int16)
    return Table(boxes, rng.random(shape) < 0.6)


def put(folder: Path, text: str | bytes) -> Path:
    path = folder / "rectangles.pom"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def problems_of(folder: Path, text: str | bytes, **options: object) -> list[str]:
    with pytest.raises(FormatError) as caught:
        read_pom(put(folder, text), **options)  # type: ignore[arg-type]
    return [str(problem) for problem in caught.value.relative_to(folder).problems]


# Writing


def test_the_header_is_the_one_published_for_wildtrack() -> None:
    assert header_text(WILDTRACK) == (
        "WIDTH 12\nHEIGHT 36\nNB_WIDTH 480\nNB_HEIGHT 1440\nMAN_RAY 0.16\nMAN_HEIGHT 1.8\n"
        "REDUCTION 1\nORIGINE_X -3.0\nORIGINE_Y -9.0\nNB_CAMERA 7\n"
    )


def test_every_pair_of_camera_and_position_has_its_line(tmp_path: Path) -> None:
    boxes = np.array([[[1, 2, 30, 40], [-5, 0, 10, 99]]], dtype=np.int16)
    header = PomHeader(Grid(2, 1, 0.5, 0, 0), Cylinder(0.16, 1.8), 1)
    write_pom(tmp_path / "a.pom", header, Table(boxes, np.array([[False, True]])))
    lines = (tmp_path / "a.pom").read_text().splitlines()
    assert lines[10:] == ["RECTANGLE 0 0 notvisible", "RECTANGLE 0 1 -5 0 10 99"]


def test_the_same_table_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_pom(tmp_path / name, SMALL, some_table(SMALL))
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_progress_is_told_up_to_the_last_position(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pom, "BLOCK_LINES", 4)
    told: list[tuple[int, int]] = []
    write_pom(tmp_path / "a", SMALL, some_table(SMALL), lambda done, total: told.append((done, total)))
    assert told == [(4, 12), (6, 12), (10, 12), (12, 12)]


def test_a_table_of_another_size_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="camera 0 has boxes"):
        write_pom(tmp_path / "a", WILDTRACK, some_table(SMALL))
    assert list(tmp_path.iterdir()) == []


def test_readers_of_the_field_take_a_written_file(tmp_path: Path) -> None:
    # The patterns with which MVDet and the tools after it read rectangles.pom.
    table = some_table(SMALL)
    write_pom(tmp_path / "a", SMALL, table)
    for line in (tmp_path / "a").read_text().splitlines()[10:]:
        camera, position = map(int, re.search(r"(\d+) (\d+)", line).groups())  # type: ignore[union-attr]
        match = re.search(r"(\d+) (\d+) ([-\d]+) ([-\d]+) ([-\d]+) ([-\d]+)", line)
        assert bool(match) == bool(table.visible(camera)[position]) == ("notvisible" not in line)
        if match:
            assert list(map(int, match.groups()[2:])) == table.boxes(camera)[position].tolist()


# Reading


@pytest.mark.parametrize("block", [1, 100, 1 << 20])
def test_a_written_table_comes_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, block: int) -> None:
    monkeypatch.setattr(pom_reader, "BLOCK_BYTES", block)
    header = PomHeader(Grid(30, 20, 0.1, 0.0, -0.3), Cylinder(0.2, 1.7), 3, reduction=0.5)
    table = some_table(header)
    write_pom(tmp_path / "a", header, table)
    again = read_pom(tmp_path / "a")
    assert again.header == header
    for camera in range(3):
        seen = table.visible(camera)
        assert np.array_equal(again.visible[camera], seen)
        assert np.array_equal(again.boxes[camera][seen], table.boxes(camera)[seen])
        assert not again.boxes[camera][~seen].any()


def test_a_file_without_header_is_read_with_what_the_caller_knows(tmp_path: Path) -> None:
    path = put(tmp_path, "RECTANGLE 0 0 notvisible\nRECTANGLE 1 5 1 2 3 4\n")
    table = read_pom(path, SMALL.grid, 2)
    assert table.header is None
    assert table.boxes[1, 5].tolist() == [1, 2, 3, 4]


def test_pairs_that_are_not_named_are_not_visible(tmp_path: Path) -> None:
    assert read_pom(put(tmp_path, HEAD + "RECTANGLE 1 5 1 2 3 4\n")).visible.sum() == 1


@pytest.mark.parametrize(
    "text",
    [
        "# made elsewhere\n" + HEAD + "\nRECTANGLE 1 5 1 2 3 4",
        HEAD.replace("\n", "\r\n") + "RECTANGLE 1 5 1 2 3 4\r\n",
        HEAD + "RECTANGLE\t1  5   1 2 3 4  \n# the end\n\n",
        HEAD.replace("NB_CAMERA", "CAMERAS") + "RECTANGLE 1 5 1 2 3 4\n",
        HEAD.replace(" ", ": ") + "RECTANGLE 1 5 1 2 3 4\n",
        "ROOM 1920 1080 2 6\nPRIOR 0.01\n" + HEAD + "RECTANGLE 1 5 1 2 3 4\n",
        HEAD + "RECTANGLE 0 0 -1 -1 -1 -1\nRECTANGLE 1 5 1 2 3 4\n",
    ],
    ids=["comment", "windows", "spaces", "other name", "colons", "pom's words", "minus ones"],
)
def test_small_differences_in_writing_do_not_matter(tmp_path: Path, text: str) -> None:
    table = read_pom(put(tmp_path, text))
    assert table.header == SMALL
    assert np.argwhere(table.visible).tolist() == [[1, 5]]
    assert table.boxes[1, 5].tolist() == [1, 2, 3, 4]


def test_progress_ends_with_the_size_of_the_file(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    path = put(tmp_path, HEAD + "RECTANGLE 0 0 notvisible\n" * 1)
    read_pom(path, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (path.stat().st_size, path.stat().st_size)


# What is wrong with a file


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("RECTANGLE 2 0 notvisible", "camera is not one of 0 to 1"),
        ("RECTANGLE 0 6 notvisible", "position is not one of 0 to 5"),
        ("RECTANGLE 0 0 9 2 3 4", "corners are exchanged"),
        ("RECTANGLE 0 0 1 2 3", "not RECTANGLE, camera, position and a box"),
        ("RECTANGLE 0 0 1 2 3 4 5", "not RECTANGLE, camera, position and a box"),
        ("RECTANGLE 0 0 hidden", "not RECTANGLE, camera, position and a box"),
        ("RECTANGLE -1 0 notvisible", "not RECTANGLE, camera, position and a box"),
        ("RECTANGLE 0 0 1.5 2 3 4", "not RECTANGLE, camera, position and a box"),
        ("RECTANGLE 0 0 1 2 3 9999999999", "not RECTANGLE, camera, position and a box"),
        ("WIDTH 12", "not RECTANGLE, camera, position and a box"),
    ],
)
def test_a_wrong_line_is_told_with_its_number(tmp_path: Path, line: str, reason: str) -> None:
    (problem,) = problems_of(tmp_path, f"{HEAD}RECTANGLE 1 0 notvisible\n{line}\n")
    assert problem.startswith("rectangles.pom: line 12: ")
    assert reason in problem


def test_a_pair_named_twice_in_one_block_is_told(tmp_path: Path) -> None:
    text = HEAD + "RECTANGLE 0 1 1 2 3 4\nRECTANGLE 0 0 notvisible\nRECTANGLE 0 1 notvisible\n"
    assert "line 13: camera 0, position 1: is named twice" in problems_of(tmp_path, text)[0]


def test_a_pair_named_twice_far_apart_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pom_reader, "BLOCK_BYTES", 1)
    text = HEAD + "RECTANGLE 0 1 1 2 3 4\nRECTANGLE 0 2 notvisible\nRECTANGLE 0 1 notvisible\n"
    assert "line 13: camera 0, position 1: is named twice" in problems_of(tmp_path, text)[0]


@pytest.mark.parametrize("name", ["WIDTH", "NB_HEIGHT", "MAN_RAY", "ORIGINE_Y", "NB_CAMERA"])
def test_an_incomplete_header_is_told(tmp_path: Path, name: str) -> None:
    head = "".join(line for line in HEAD.splitlines(True) if not line.startswith(f"{name} "))
    assert problems_of(tmp_path, head + "RECTANGLE 0 0 notvisible\n") == [
        f"rectangles.pom: the header lacks {name}"
    ]


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("NB_WIDTH 3", "NB_WIDTH 3.5", "line 3: NB_WIDTH is '3.5' instead of a number"),
        ("NB_WIDTH 3", "NB_WIDTH 0", "no columns, no rows or no cameras"),
        ("NB_WIDTH 3", "NB_WIDTH 4", "m apart along X"),
        ("NB_WIDTH 3", "NB_WIDTH 3\nNB_WIDTH 3", "line 4: NB_WIDTH is given twice"),
        ("MAN_RAY 0.16", "MAN_RAY -1", "impossible header: radius"),
        ("MAN_RAY 0.16", "MAN_RAY nan", "instead of a number"),
        ("WIDTH 1.5\nHEIGHT 1\n", "WIDTH 0\nHEIGHT 0\n", "impossible header: step"),
        ("NB_CAMERA 2", "NB_CAMERA 999999999", "too many to read"),
        ("REDUCTION 1", "SCALE 1", "neither a header line nor a RECTANGLE"),
    ],
)
def test_an_impossible_header_is_told(tmp_path: Path, old: str, new: str, reason: str) -> None:
    assert old in HEAD
    assert reason in problems_of(tmp_path, HEAD.replace(old, new) + "RECTANGLE 0 0 notvisible\n")[0]


def test_a_header_for_another_grid_is_told(tmp_path: Path) -> None:
    problems = problems_of(tmp_path, HEAD + "RECTANGLE 0 0 notvisible\n", grid=WILDTRACK.grid, cameras=7)
    assert len(problems) == 2
    assert "is for 2 cameras instead of 7" in problems[1]


def test_a_file_without_header_needs_help(tmp_path: Path) -> None:
    assert "has no header" in problems_of(tmp_path, "RECTANGLE 0 0 notvisible\n")[0]


@pytest.mark.parametrize("text", [b"", HEAD.encode()], ids=["empty", "header only"])
def test_a_file_without_rectangles_is_refused(tmp_path: Path, text: bytes) -> None:
    assert any("has no RECTANGLE" in each for each in problems_of(tmp_path, text, grid=SMALL.grid, cameras=2))


@pytest.mark.parametrize("text", [b"x" * 10_000, HEAD.encode() + b"RECTANGLE" + b" 1" * 9_000])
def test_endless_lines_are_refused(tmp_path: Path, text: bytes) -> None:
    assert "a line longer than 4096 bytes" in problems_of(tmp_path, text)[0]


def test_a_long_text_without_rectangles_is_refused_early(tmp_path: Path) -> None:
    assert "first 1000 lines" in problems_of(tmp_path, "# nothing\n" * 5000)[0]


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no such file"):
        read_pom(tmp_path / "a")


# Whatever bytes come

WORDS = st.sampled_from(
    [
        *HEAD.encode().split(b"\n"),
        b"RECTANGLE 0 0 notvisible",
        b"RECTANGLE 1 1 1 2 3 4",
        b"RECTANGLE 9 9 9 9 9 9",
    ]
)


@settings(max_examples=200)
@given(st.binary(max_size=300) | st.lists(WORDS | st.binary(max_size=8), max_size=20).map(b"\n".join))
def test_any_bytes_are_either_read_or_refused(data: bytes) -> None:
    with TemporaryDirectory() as folder:
        try:
            read_pom(put(Path(folder), data), SMALL.grid, 2)
        except FormatError as error:
            assert error.problems
