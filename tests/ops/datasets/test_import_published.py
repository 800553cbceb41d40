"""Published datasets come in as they are. They are kept beside the repository; see `shared_data`."""

from __future__ import annotations

import hashlib
import io
import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from django.core.management import CommandError, call_command
from PIL import Image as Picture

from gtm_hit.formats.calibration.wildtrack_xml import read_intrinsic
from gtm_hit.formats.layout import find_layout
from gtm_hit.formats.problems import ProblemList
from gtm_hit.geometry.camera import back_project
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Annotation, Dataset, Frame, Image
from gtm_hit.ops.calibration.cameras import View, read_views
from gtm_hit.ops.files.images import derive
from gtm_hit.ops.ground.coverage import table as table_of
from tests.dataset_folder import make_folder

HIS_POSITION = 265189  # of the man in green, whose feet are at (855, 429) in C1's picture as taken


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"
    settings.TABLES_ROOT = tmp_path / "tables"


def run(*words: object) -> str:
    out = io.StringIO()
    call_command("importdataset", *map(str, words), stdout=out, stderr=out)
    return out.getvalue()


@pytest.mark.django_db
def test_multiviewx_comes_in_with_every_published_person_and_box(shared_data: Path) -> None:
    answer = run("mvx", shared_data / "multiviewx", "--preset", "multiviewx")
    assert "differ" not in answer
    found = Annotation.objects.values_list("frame__number", "person", "position")
    published = {
        (int(path.stem) - 1, entry["personID"], entry["positionID"])
        for path in (shared_data / "multiviewx/annotations_positions").iterdir()
        for entry in json.loads(path.read_text())
    }
    assert set(found) == published
    assert (Frame.objects.count(), Image.objects.count()) == (10, 60)
    assert Dataset.objects.get().annotation_name(0) == "00001.json"


@pytest.mark.django_db
def test_multiviewx_jpegs_are_kept_byte_for_byte(shared_data: Path) -> None:
    run("mvx", shared_data / "multiviewx", "--preset", "multiviewx")
    source = (shared_data / "multiviewx/Image_subsets/C3/0004.jpg").read_bytes()
    image = Image.objects.get(camera__name="C3", frame__number=4)
    assert image.full_digest == image.source_digest == hashlib.sha256(source).hexdigest()


@pytest.fixture
def wildtrack(db: None, shared_data: Path) -> Dataset:
    folder = shared_data / "wildtrack"
    run("wt", folder, "--preset", "wildtrack", "--images", folder / "original_frames", "--undistort")
    return Dataset.objects.get(slug="wt")


def test_wildtrack_comes_in_undistorted(wildtrack: Dataset, tmp_path: Path) -> None:
    assert wildtrack.undistorted
    assert all(not camera.has_lens for camera in wildtrack.calibrated_cameras())
    assert [camera.name for camera in wildtrack.cameras.all()] == [f"C{index}" for index in range(1, 8)]
    # Visible rectangles of the published table.
    table = RectangleTable.open(tmp_path / "tables" / f"rectangles-{table_of(wildtrack).digest}.bin")
    assert int(table.visible(0).sum()) == 559_488
    assert sum(int(table.visible(index).sum()) for index in range(7)) == 2_722_248


def test_a_real_frame_of_seven_views_costs_less_than_two_and_a_half_megabytes(wildtrack: Dataset) -> None:
    sizes = Image.objects.filter(frame__dataset=wildtrack).values_list("light_bytes", flat=True)
    assert len(sizes) == 7
    assert sum(sizes) < 2_500_000


@pytest.fixture
def first_view(shared_data: Path) -> View:
    """WILDTRACK's C1 with the undistortion an import uses."""
    problems = ProblemList("")
    layout = find_layout(shared_data / "wildtrack", problems, images=Path("original_frames"))
    sizes = dict.fromkeys(layout.cameras, (1920, 1080))
    views = read_views(layout.calibrations, layout.cameras, sizes, "cm", True, problems)
    problems.raise_if_any()
    return views[0]


def undistorted_mark(view: View, x: int, y: int) -> np.ndarray:
    """Where a white square around a pixel of the picture as taken is in the full derivative."""
    pixels = np.zeros((1080, 1920, 3), np.uint8)
    pixels[y - 3 : y + 4, x - 3 : x + 4] = 255
    stream = io.BytesIO()
    Picture.fromarray(pixels).save(stream, "PNG")
    _light, full = derive(stream.getvalue(), view.undistort)
    found = np.asarray(Picture.open(io.BytesIO(full)).convert("L"))
    return np.argwhere(found > 128).mean(axis=0)[::-1]


def test_the_man_in_green_stands_where_picture_and_camera_say(first_view: View) -> None:
    grid = Grid(480, 1440, 0.025, -3.0, -9.0)
    ground = back_project(first_view.camera, undistorted_mark(first_view, 855, 429)[None])
    assert np.linalg.norm(ground - grid.metres([HIS_POSITION])) < 0.15


def test_a_corner_of_the_picture_moves_as_opencv_says(first_view: View, shared_data: Path) -> None:
    folder = shared_data / "wildtrack/calibrations"
    taken = read_intrinsic(folder / "intrinsic_original/intr_CVLab1.xml")
    ideal = read_intrinsic(folder / "intrinsic_zero/intr_CVLab1.xml")
    corner = np.array([[[300.0, 200.0]]])
    # Left to itself OpenCV gives up after five steps.
    patience = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-9)
    expected = cv2.undistortPoints(
        corner, taken.matrix, taken.distortion, None, None, ideal.matrix, criteria=patience
    )
    assert np.linalg.norm(expected - corner) > 5
    assert undistorted_mark(first_view, 300, 200) == pytest.approx(expected.ravel(), abs=1)


# The command


@pytest.mark.django_db
def test_the_command_tells_every_problem_and_fails(tmp_path: Path) -> None:
    folder = make_folder(tmp_path / "square")
    (folder / "annotations_positions/00000005.json").write_bytes(b"")
    (folder / "Image_subsets/C1/00000000.png").write_bytes(b"")
    errors = io.StringIO()
    words = [
        "square",
        str(folder),
        "--grid",
        "80x60",
        "--step",
        "0.1",
        "--origin=-4,-3",
        "--frame-rate",
        "10",
    ]
    with pytest.raises(CommandError, match="2 problems; nothing was imported"):
        call_command("importdataset", *words, stdout=io.StringIO(), stderr=errors)
    assert "annotations_positions/00000005.json: the file is empty" in errors.getvalue()
    assert "Image_subsets/C1/00000000.png: the file is empty" in errors.getvalue()
    assert not Dataset.objects.exists()


@pytest.mark.django_db
def test_the_command_says_what_it_added(tmp_path: Path) -> None:
    folder = make_folder(tmp_path / "square")
    answer = run(
        *("square", folder, "--grid", "80x60", "--step", "0.1", "--origin=-4,-3", "--frame-rate", "10"),
        *("--frame-step", "5", "--cylinder", "0.2,1.7", "--foot-rule", "centre", "--name", "The square"),
    )
    assert "square: 2 frames with 6 images added, 2 frames in all." in answer
    assert "Layer imported: 5 people in 2 frames added." in answer
    dataset = Dataset.objects.get()
    assert (dataset.name, dataset.cylinder_radius, dataset.foot_rule) == ("The square", 0.2, "centre")
    assert (dataset.origin_x, dataset.origin_y, dataset.columns, dataset.rows) == (-4.0, -3.0, 80, 60)
