from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from gtm_hit.models import Dataset, Job, Layer
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.exports.formats.registry import FORMATS
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.ops.square_layer import content, export, fill, make_square
from tests.work_scene import make_layer

pytestmark = pytest.mark.django_db

PAGE = "/datasets/square/import-annotations/"


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.EXPORTS_ROOT = tmp_path / "exports"
    settings.UPLOADS_ROOT = tmp_path / "uploads"
    settings.INCOMING_ROOT = tmp_path / "incoming"


@pytest.fixture
def dataset() -> Dataset:
    return make_square()


@pytest.fixture
def staff(client: Client) -> Client:
    client.force_login(User.objects.create_user("ada", password="x", is_superuser=True))
    return client


def run_job() -> Job:
    job = Job.objects.get(kind=Job.Kind.IMPORT_ANNOTATIONS)
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    return job


def csv(text: str) -> SimpleUploadedFile:
    return SimpleUploadedFile("Some people.csv", text.encode())


def test_an_uploaded_file_becomes_a_layer(staff: Client, dataset: Dataset, tmp_path: Path) -> None:
    file = csv("frame,person,x,y\n5,3,0.5,-1.2\n")
    answer = staff.post(PAGE, {"file": file, "format": "csv", "layer": "theirs"})
    job = run_job()
    assert answer["Location"] == f"/jobs/{job.pk}/"
    assert (job.state, job.result["annotations"]) == (Job.State.DONE, 1)
    position = int(dataset.grid.position([[0.5, -1.2]])[0])
    assert content(Layer.objects.get(name="theirs")) == {(5, 3, position)}
    assert not list((tmp_path / "uploads").iterdir())
    assert "theirs" in staff.get(f"/jobs/{job.pk}/").content.decode()
    assert "theirs" in staff.get(PAGE).content.decode()


def test_a_folder_on_the_server_becomes_a_layer(staff: Client, dataset: Dataset, tmp_path: Path) -> None:
    layer = make_layer(dataset, "truth")
    fill(layer)
    shutil.move(export(layer, tmp_path / "out", "coco") / "coco", tmp_path / "incoming" / "boxes")
    staff.post(PAGE, {"source": "incoming/boxes", "format": "coco", "layer": "back"})
    assert run_job().state == Job.State.DONE
    assert content(Layer.objects.get(name="back")) == content(layer)


def test_what_does_not_fit_is_listed_on_the_jobs_page_and_nothing_imported(
    staff: Client, dataset: Dataset
) -> None:
    file = csv("frame,person,x,y\n5,3,0.5,-1.2\n7,3,0.5,-1.2\n5,4,99,0\n")
    staff.post(PAGE, {"file": file, "format": "csv", "layer": "theirs"})
    job = run_job()
    page = staff.get(f"/jobs/{job.pk}/").content.decode()
    assert "some-people.csv: line 3: frame 7 is not in the dataset" in page
    assert "line 4: person 4 in frame 5 stands outside the grid" in page
    assert not Layer.objects.exists()


def test_findings_can_be_dropped_by_ticking_them(staff: Client, dataset: Dataset) -> None:
    file = csv("frame,person,x,y\n5,3,0.5,-1.2\n7,3,0.5,-1.2\n5,4,99,0\n")
    drop = ["outside", "unknown-frames"]
    staff.post(PAGE, {"file": file, "format": "csv", "layer": "theirs", "drop": drop})
    job = run_job()
    assert job.result["dropped"] == {"outside": 1, "unknown-frames": 1}
    assert len(content(Layer.objects.get())) == 1


def test_a_job_taken_up_again_makes_no_second_layer(staff: Client, dataset: Dataset) -> None:
    staff.post(PAGE, {"file": csv("frame,person,x,y\n5,3,0.5,-1.2\n"), "format": "csv", "layer": "theirs"})
    first = run_job()
    Job.objects.update(state=Job.State.QUEUED)
    again = run_job()
    assert (again.state, again.result) == (Job.State.DONE, first.result)
    assert Layer.objects.count() == 1


@pytest.mark.parametrize(
    "change", [{"format": "xml"}, {"layer": "../x"}, {"layer": "there"}, {"source": "/etc"}, {"file": ""}]
)
def test_a_form_with_an_error_starts_nothing(staff: Client, dataset: Dataset, change: dict[str, Any]) -> None:
    make_layer(dataset, "there")
    values = {"file": csv("frame,x,y\n"), "format": "csv", "layer": "theirs", **change}
    answer = staff.post(PAGE, values)
    assert answer.status_code == 200
    assert "errorlist" in answer.content.decode()
    assert not Job.objects.exists()


def test_an_account_without_a_role_may_not_import(client: Client, dataset: Dataset) -> None:
    client.force_login(User.objects.create_user("guest", password="x"))
    values = {"file": csv("frame,x,y\n5,0,0\n"), "format": "csv", "layer": "theirs"}
    assert client.get(PAGE).status_code == client.post(PAGE, values).status_code == 403
    assert not Job.objects.exists()


def test_the_layers_page_offers_all_formats_and_exports_the_ticked_ones(
    staff: Client, dataset: Dataset
) -> None:
    layer = make_layer(dataset, "truth")
    fill(layer)
    page = staff.get("/datasets/square/layers/").content.decode()
    assert all(f'value="{name}"' in page for name in FORMATS)
    staff.post("/datasets/square/layers/truth/export/", {"format": ["csv", "mot"]})
    job = Job.objects.get()
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    found = exporting.finished(job)
    assert found is not None
    names = [name for name, _ in found.files]
    assert "people.csv" in names and "mot/C1/gt/gt.txt" in names
    assert not [name for name in names if name.startswith("annotations_positions")]


def test_an_unknown_format_is_told_and_exports_nothing(staff: Client, dataset: Dataset) -> None:
    fill(make_layer(dataset, "truth"))
    answer = staff.post("/datasets/square/layers/truth/export/", {"format": "pdf"}, follow=True)
    assert "not formats: pdf" in answer.content.decode()
    assert not Job.objects.exists()
