"""Whole pictures, with every view a sixth of its real size."""

from __future__ import annotations

from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import cv2
import numpy as np
import pytest

from gtm_hit.demo.backdrop import Place
from gtm_hit.demo.people import Cast
from gtm_hit.demo.render import Truth, make_demo_frame, render_scene, truth
from gtm_hit.demo.scene import Scene
from gtm_hit.geometry.camera import Camera

FRAMES = 2


@pytest.fixture(scope="module")
def short(scene: Scene) -> Scene:
    return replace(scene, frame_count=FRAMES)


@pytest.fixture(scope="module")
def rendered(
    short: Scene, small_cameras: list[Camera], tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, list[Truth], list[tuple[int, int]]]:
    folder, told = tmp_path_factory.mktemp("demo"), []
    rows = render_scene(short, small_cameras, folder, lambda done, total: told.append((done, total)))
    return folder, rows, told


def digests(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_pictures_lie_where_wildtrack_has_them(rendered: tuple[Path, list[Truth], object]) -> None:
    expected = {f"Image_subsets/C{camera}/{number:08d}.jpg" for camera in range(1, 8) for number in (0, 5)}
    assert set(digests(rendered[0])) == expected


def test_pictures_are_of_the_cameras_size(rendered: tuple[Path, list[Truth], object]) -> None:
    for path in rendered[0].rglob("*.jpg"):
        assert cv2.imread(str(path)).shape == (180, 320, 3)


def test_one_process_makes_the_same_bytes_as_two(
    short: Scene, small_cameras: list[Camera], rendered: tuple[Path, list[Truth], object], tmp_path: Path
) -> None:
    render_scene(short, small_cameras, tmp_path, workers=1)
    assert digests(tmp_path) == digests(rendered[0])


def test_another_seed_makes_other_pictures(
    short: Scene, small_cameras: list[Camera], rendered: tuple[Path, list[Truth], object]
) -> None:
    first = cv2.imread(str(rendered[0] / "Image_subsets" / "C5" / "00000000.jpg"))[..., ::-1]
    other = make_demo_frame(replace(short, seed=99), small_cameras[4], 0)
    assert (np.abs(first.astype(int) - other) > 30).mean() > 0.02


def test_one_frame_alone_is_the_frame_of_the_whole_scene(
    short: Scene, small_cameras: list[Camera], rendered: tuple[Path, list[Truth], object]
) -> None:
    whole = cv2.imread(str(rendered[0] / "Image_subsets" / "C7" / "00000005.jpg"))[..., ::-1]
    alone = make_demo_frame(short, small_cameras[6], 1)
    assert np.abs(whole.astype(int) - alone).mean() < 4  # what JPEG loses


def test_progress_runs_from_the_first_view_to_the_last_picture(
    rendered: tuple[Path, list[Truth], list[tuple[int, int]]],
) -> None:
    told = rendered[2]
    total = 7 * (1 + FRAMES)
    assert told[0] == (1, total)
    assert told[-1] == (total, total)
    assert [done for done, _ in told] == sorted({done for done, _ in told})


def test_the_truth_is_everybody_on_the_grid(short: Scene, rendered: tuple[Path, list[Truth], object]) -> None:
    walks = Cast.of(short).walks
    rows = rendered[1]
    assert rows == truth(short)
    assert len(rows) == walks.present.sum()
    assert {row.number for row in rows} == {0, 5}
    for row in rows:
        place = short.grid.metres(row.position)[0]
        assert np.hypot(*(place - (row.x, row.y))) <= short.grid.step * 0.71
        assert row.height == walks.height[row.person]


def test_nothing_unfinished_is_left_behind(rendered: tuple[Path, list[Truth], object]) -> None:
    assert not list(rendered[0].rglob("*.part"))


def test_every_view_shows_its_people_as_something_other_than_the_place(
    short: Scene, small_cameras: list[Camera]
) -> None:
    place, camera = Place(short), small_cameras[0]
    backdrop = place.backdrop(camera)
    assert np.isfinite(backdrop.sunny).all()
    assert np.isfinite(backdrop.shaded).all()
    # Taking the sun away darkens the ground and nothing gets lighter.
    assert (backdrop.shaded <= backdrop.sunny + 1e-4).all()
    ground = np.isfinite(backdrop.beams[..., 0])
    assert ground[60:].all()
    assert backdrop.sunny[120:].mean() > 2 * backdrop.shaded[120:].mean()
