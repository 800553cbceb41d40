from __future__ import annotations

import hashlib
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid, GridError
from gtm_hit.geometry.table import RectangleTable, TableError, table_digest
from tests.geometry.reference_rule import reference_rectangles
from tests.geometry.scenes import PERSON, WILDTRACK_GRID, mirrored, wildtrack_cameras

CAMERAS = wildtrack_cameras()
SMALL_GRID = Grid(columns=48, rows=144, step=0.25, origin_x=-3.0, origin_y=-9.0)
INGREDIENTS = (CAMERAS[:2], SMALL_GRID, PERSON, FootRule.CORNERS)


def build(folder: Path) -> RectangleTable:
    return RectangleTable.build(folder, *INGREDIENTS)


def test_the_wildtrack_table_has_the_known_numbers_of_visible_rectangles(
    wildtrack_table: RectangleTable,
) -> None:
    visible = [int(wildtrack_table.visible(index).sum()) for index in range(7)]
    assert visible[0] == 559_488
    assert sum(visible) == 2_722_248


def test_the_wildtrack_table_is_the_one_compared_with_opencv_entry_by_entry(
    wildtrack_table: RectangleTable,
) -> None:
    # All 4,838,400 entries of the table with this hash were compared with the reference rule.
    content = hashlib.sha256(np.stack([wildtrack_table.boxes(index) for index in range(7)]).tobytes())
    assert content.hexdigest() == "71685e902a040522b46a2374d6b7df5bc91d9e6d70531289364b9e08b32c9c27"


def test_random_entries_of_the_wildtrack_table_follow_the_rule_word_by_word(
    wildtrack_table: RectangleTable,
) -> None:
    positions = np.random.default_rng(11).integers(0, WILDTRACK_GRID.count, 5000)
    boxes, visible = wildtrack_table.rectangles(positions)
    for camera in CAMERAS:
        expected = reference_rectangles(camera, WILDTRACK_GRID, PERSON, FootRule.CORNERS, positions)
        np.testing.assert_array_equal(boxes[:, camera.index], expected)
        np.testing.assert_array_equal(visible[:, camera.index], expected.any(axis=1))


@pytest.mark.parametrize("rule", FootRule)
def test_a_table_holds_what_rectangles_computes(tmp_path: Path, rule: FootRule) -> None:
    cameras = [*CAMERAS[:2], *map(mirrored, CAMERAS[2:3]), *wildtrack_cameras(original=True)[3:5]]
    grid = Grid(columns=61, rows=149, step=0.21, origin_x=-3.0, origin_y=-9.0)
    table = RectangleTable.build(tmp_path, cameras, grid, PERSON, rule)
    for number, camera in enumerate(cameras):
        boxes, visible = rectangles(camera, grid, PERSON, rule, np.arange(grid.count))
        np.testing.assert_array_equal(table.boxes(number), boxes)
        np.testing.assert_array_equal(table.visible(number), visible)


def test_a_grid_wider_than_a_block_is_filled(tmp_path: Path) -> None:
    grid = Grid(columns=20_000, rows=2, step=0.0006, origin_x=-3.0, origin_y=5.0)
    table = RectangleTable.build(tmp_path, CAMERAS[:1], grid, PERSON, FootRule.CORNERS)
    boxes, _ = rectangles(CAMERAS[0], grid, PERSON, FootRule.CORNERS, np.arange(grid.count))
    np.testing.assert_array_equal(table.boxes(0), boxes)


def test_looking_up_positions_gives_one_box_per_camera(tmp_path: Path) -> None:
    table = build(tmp_path)
    boxes, visible = table.rectangles([7, 3000, 7])
    assert (boxes.shape, visible.shape) == ((3, 2, 4), (3, 2))
    np.testing.assert_array_equal(boxes[1], [table.boxes(0)[3000], table.boxes(1)[3000]])


def test_looking_up_a_position_off_the_grid_is_refused(tmp_path: Path) -> None:
    with pytest.raises(GridError, match="6912"):
        build(tmp_path).rectangles([0, SMALL_GRID.count])


def test_a_table_cannot_be_written_to(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="read-only"):
        build(tmp_path).boxes(0)[0, 0] = 1


def test_the_digest_changes_with_every_ingredient() -> None:
    cameras, grid, cylinder, rule = INGREDIENTS
    moved = replace(cameras[0], tvec=cameras[0].tvec + 1e-9)
    digests = {
        table_digest(*INGREDIENTS),
        table_digest(cameras[:1], grid, cylinder, rule),
        table_digest(cameras[::-1], grid, cylinder, rule),
        table_digest([moved, cameras[1]], grid, cylinder, rule),
        table_digest([replace(cameras[0], width=1921), cameras[1]], grid, cylinder, rule),
        table_digest([replace(cameras[0], distortion=np.full(5, 1e-9)), cameras[1]], grid, cylinder, rule),
        table_digest(cameras, replace(grid, origin_x=-2.0), cylinder, rule),
        table_digest(cameras, replace(grid, step=0.2), cylinder, rule),
        table_digest(cameras, grid, Cylinder(0.17, 1.8), rule),
        table_digest(cameras, grid, Cylinder(0.16, 1.81), rule),
        table_digest(cameras, grid, cylinder, FootRule.CENTRE),
    }
    assert len(digests) == 11


def test_the_digest_ignores_what_rectangles_do_not_depend_on() -> None:
    cameras, grid, cylinder, rule = INGREDIENTS
    renamed = [replace(camera, name="other", distortion=-np.zeros(8)) for camera in cameras]
    assert table_digest(renamed, grid, cylinder, rule) == table_digest(*INGREDIENTS)


def test_a_table_that_exists_is_opened_and_not_built_again(tmp_path: Path) -> None:
    first = build(tmp_path)
    before = first.path.stat()
    calls: list[tuple[int, int]] = []
    again = RectangleTable.build(tmp_path, *INGREDIENTS, progress=lambda *parts: calls.append(parts))
    assert again.digest == first.digest == table_digest(*INGREDIENTS)
    assert (again.path.stat().st_ino, calls) == (before.st_ino, [])


def test_building_reports_progress_up_to_the_end(tmp_path: Path) -> None:
    calls: list[tuple[int, int]] = []
    RectangleTable.build(tmp_path, *INGREDIENTS, progress=lambda *parts: calls.append(parts))
    assert [done for done, _ in calls] == list(range(1, len(calls) + 1))
    assert calls[-1][0] == calls[-1][1] > 1


def test_a_build_that_fails_leaves_nothing_behind(tmp_path: Path) -> None:
    def stop(done: int, parts: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        RectangleTable.build(tmp_path, *INGREDIENTS, progress=stop)
    assert list(tmp_path.iterdir()) == []


def test_several_processes_may_build_the_same_table_at_once(tmp_path: Path) -> None:
    # Spawned, not forked: the test process has threads.
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        paths = {table.result() for table in [pool.submit(_build_path, tmp_path) for _ in range(4)]}
    assert [file.name for file in tmp_path.iterdir()] == [path.name for path in paths]
    assert RectangleTable.open(paths.pop()).visible(0).any()


def _build_path(folder: Path) -> Path:
    return build(folder).path


@pytest.mark.parametrize("damage", ["truncate", "magic", "json", "version", "empty", "cameras"])
def test_a_damaged_table_is_not_opened_but_built_again(tmp_path: Path, damage: str) -> None:
    table = build(tmp_path)
    content = table.path.read_bytes()
    expected = table.boxes(1).copy()
    damaged = {
        "truncate": content[:-8],
        "magic": b"X" + content[1:],
        "json": content[:20] + b"}" + content[21:],
        "version": content.replace(b'"version": 1', b'"version": 9'),
        "empty": b"",
        "cameras": content.replace(b'"cameras": 2', b'"cameras": 3'),
    }[damage]
    table.path.unlink()
    table.path.write_bytes(damaged)
    with pytest.raises(TableError, match=table.path.name):
        RectangleTable.open(table.path)
    np.testing.assert_array_equal(build(tmp_path).boxes(1), expected)


def test_opening_a_table_that_is_not_there_says_so(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        RectangleTable.open(tmp_path / "rectangles-0.bin")


def test_an_opened_table_knows_its_grid_and_cameras(tmp_path: Path) -> None:
    table = RectangleTable.open(build(tmp_path).path)
    assert (table.grid, table.cameras_count) == (SMALL_GRID, 2)
