"""From the desk to the dataset: compared, put in place under a number with its report, or taken as files."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.models import Desk, Job
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration.reading import read_replacement
from gtm_hit.ops.desk import clicks, desks, lenses, placing
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.desk_scene import click, make_desk, seen

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, settings: Any) -> None:
    settings.TABLES_ROOT, settings.UPLOADS_ROOT = tmp_path / "tables", tmp_path / "uploads"


@pytest.fixture
def desk() -> Desk:
    """Both cameras clicked."""
    made = make_desk()
    for camera in ("C1", "C2"):
        click(made, " ".join(seen(made, camera)), camera)
    return made


def compared(desk: Desk) -> Job:
    job = placing.compare(desk)
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    assert job.state == Job.State.DONE, job.message
    return job


def test_a_desk_is_put_in_place_under_a_number_with_what_went_in(desk: Desk) -> None:
    dataset = desk.dataset
    assert dataset is not None
    calibration_job.confirm(compared(desk))
    dataset.refresh_from_db()
    placed = dataset.calibration
    assert placed is not None and (placed.number, placed.source) == (2, "desk plaza")
    assert placed.report["points"]["count"] == 15
    told = {each["name"]: each["ground"]["used"] for each in placed.report["cameras"]}
    assert told == {"C1": 15, "C2": 15}
    centres = [camera.centre for camera in dataset.calibrated_cameras()]
    assert np.allclose(centres, [camera.centre for camera in placing.cameras(desk)])


def test_nothing_changes_before_it_is_confirmed(desk: Desk) -> None:
    assert desk.dataset is not None
    before = [camera.as_json() for camera in desk.dataset.calibrated_cameras()]
    compared(desk)
    assert [camera.as_json() for camera in desk.dataset.calibrated_cameras()] == before


def test_what_is_compared_is_what_is_put_in_place_whatever_is_clicked_meanwhile(desk: Desk) -> None:
    assert desk.dataset is not None
    job = compared(desk)
    expected = placing.cameras(desk)[0].centre
    for name in ("A1", "B1", "C1", "D1"):
        clicks.remove(desk, "C1", name)
    calibration_job.confirm(job)
    assert np.allclose(desk.dataset.calibrated_cameras()[0].centre, expected)


def test_a_camera_without_a_place_is_named_and_nothing_is_compared(desk: Desk) -> None:
    for name in seen(desk, "C2"):
        clicks.remove(desk, "C2", name)
    with pytest.raises(DeskError, match=r"^No place on the ground yet: C2\.$"):
        placing.compare(desk)
    assert not Job.objects.exists()


def test_a_lens_is_refused_where_the_pictures_have_none_any_more(desk: Desk) -> None:
    assert desk.dataset is not None
    matrix = [[1000.0, 0, 960], [0, 1000.0, 540], [0, 0, 1]]
    lenses.put(desk, "C1", (1920, 1080), matrix, [-0.01, 0, 0, 0, 0], "a guess")
    desk.dataset.undistorted = True
    desk.dataset.save()
    desk.refresh_from_db()
    with pytest.raises(DeskError, match="C1 would get one"):
        placing.compare(desk)


def test_both_kinds_of_files_read_back_the_same_cameras(desk: Desk, tmp_path: Path) -> None:
    assert desk.dataset is not None
    expected = placing.cameras(desk)
    (tmp_path / "cameras.json").write_bytes(placing.cameras_json(desk))
    again = load_cameras(tmp_path / "cameras.json")
    with zipfile.ZipFile(io.BytesIO(placing.folder_zip(desk))) as archive:
        archive.extractall(tmp_path)
    folder = read_replacement(desk.dataset, tmp_path / "calibrations", "cm")
    for one, two, three in zip(expected, again, folder, strict=True):
        assert np.abs(one.tvec - two.tvec).max() <= 1e-9
        assert np.abs(one.tvec - three.tvec).max() <= 1e-6
        assert np.abs(one.matrix - three.matrix).max() <= 1e-6


def test_the_same_desk_gives_the_same_bytes(desk: Desk) -> None:
    assert placing.folder_zip(desk) == placing.folder_zip(desk)
    assert placing.cameras_file(desk) == placing.cameras_file(desk)


def test_a_desk_without_a_dataset_has_nothing_to_compare_with() -> None:
    with pytest.raises(DeskError, match="no dataset"):
        placing.compare(desks.make("yard", cameras=["C1"]))
