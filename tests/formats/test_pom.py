from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from gtm_hit.formats import pom
from gtm_hit.formats.pom import PomHeader, header_text, write_pom
from gtm_hit.geometry.cylinder import Cylinder
from gtm_hit.geometry.grid import Grid
from tests.formats.pom_reader import read_pom

WILDTRACK = PomHeader(Grid(480, 1440, 0.025, -3.0, -9.0), Cylinder(0.16, 1.8), 7)
SMALL = PomHeader(Grid(3, 2, 0.5, -1.0, 2.25), Cylinder(0.16, 1.8), 2)


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


@pytest.mark.parametrize("block", [1, 100, 65_536])
def test_a_written_table_comes_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, block: int) -> None:
    monkeypatch.setattr(pom, "BLOCK_LINES", block)
    header = PomHeader(Grid(30, 20, 0.1, 0.0, -0.3), Cylinder(0.2, 1.7), 3, reduction=0.5)
    table = some_table(header)
    write_pom(tmp_path / "a", header, table)
    again = read_pom(tmp_path / "a")
    assert again.header == header
    for camera in range(3):
        seen = table.visible(camera)
        assert np.array_equal(again.visible[camera], seen)
        assert np.array_equal(again.boxes[camera][seen], table.boxes(camera)[seen])
