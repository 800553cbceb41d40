from __future__ import annotations

import gzip
from pathlib import Path
from typing import Any

import pytest

from gtm_hit.geometry.grid_file import encode
from gtm_hit.models import Assignment, Camera, Dataset
from gtm_hit.ops.ground import coverage, grid_files
from gtm_hit.ops.work import links
from tests.api.conftest import Caller
from tests.work_scene import finish, make_dataset

FOREVER = "private, max-age=31536000, immutable"


@pytest.fixture(autouse=True)
def tables(settings: Any, tmp_path: Path) -> Path:
    settings.TABLES_ROOT = tmp_path / "tables"
    return tmp_path / "tables"


@pytest.fixture
def scene(alice: Caller) -> dict[str, Any]:
    return alice.get("/api/v1/assignment/scene/").json()


@pytest.fixture
def path(scene: dict[str, Any]) -> str:
    return scene["cameras"][1]["grid"]


def test_the_scene_says_each_cameras_model_and_where_its_rectangles_are(scene: dict[str, Any]) -> None:
    assert [camera["model"] for camera in scene["cameras"]] == ["pinhole", "pinhole"]
    assert len({camera["grid"] for camera in scene["cameras"]}) == 2


def test_the_holder_of_a_batch_gets_the_table_of_its_cameras_and_keeps_it(
    alice: Caller, path: str, dataset: Dataset
) -> None:
    response = alice.get(path)
    data = b"".join(response.streaming_content)
    camera = dataset.calibrated_cameras()[1]
    assert data == encode(coverage.table(dataset).boxes(1), camera, dataset.grid)
    assert gzip.decompress(data).startswith(b"GTMGRID1")
    assert response["Content-Length"] == str(len(data))
    assert response["Cache-Control"] == FOREVER
    assert "Content-Encoding" not in response


def test_the_file_is_made_once_and_whole(alice: Caller, path: str, tables: Path) -> None:
    alice.get(path).getvalue()
    made = {file.name: file.stat().st_mtime_ns for file in tables.iterdir()}
    assert sorted(name.split("-")[0] for name in made) == ["grid", "rectangles"]
    alice.get(path).getvalue()
    assert {file.name: file.stat().st_mtime_ns for file in tables.iterdir()} == made


def test_a_table_the_browser_has_is_not_sent_again(alice: Caller, path: str) -> None:
    response = alice.get(path, **{"If-None-Match": f'"{path[-67:-3]}"'})
    assert (response.status_code, response["Cache-Control"]) == (304, FOREVER)


def test_after_submission_and_for_staff_it_is_there_as_well(
    alice: Caller, staff: Caller, path: str, assignment: Assignment
) -> None:
    finish(assignment)
    assert [alice.get(path).status_code, staff.get(path).status_code] == [200, 200]


def test_a_batch_opens_no_tables_of_other_datasets(alice: Caller, staff: Caller, dataset: Dataset) -> None:
    other = make_dataset(slug="other")
    Camera.objects.filter(dataset=other).update(tvec=[0.0, 1.0, 9.0])
    row = Camera.objects.filter(dataset=other).select_related("dataset").first()
    assert row
    path = f"/api/v1/grids/{grid_files.digest_of(other, row.calibrated)}.gz"
    assert [alice.get(path).status_code, staff.get(path).status_code] == [404, 200]


def test_a_workers_token_opens_no_tables_of_batches(path: str, assignment: Assignment) -> None:
    token = links.worker_token(assignment.worker, assignment.batch.dataset)
    assert Caller(f"Worker {token}").get(path).status_code == 404


@pytest.mark.parametrize(("caller", "status"), [("stranger", 401), ("user", 403)])
def test_others_get_no_table(caller: str, status: int, path: str, request: pytest.FixtureRequest) -> None:
    assert request.getfixturevalue(caller).get(path).status_code == status


def test_another_calibration_has_another_address(alice: Caller, path: str, dataset: Dataset) -> None:
    Camera.objects.filter(dataset=dataset, index=1).update(tvec=[0.0, 1.0, 9.0])
    now = alice.get("/api/v1/assignment/scene/").json()["cameras"][1]["grid"]
    assert now != path
    assert [alice.get(path).status_code, alice.get(now).status_code] == [404, 200]
