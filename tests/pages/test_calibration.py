from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.models import Annotation, Dataset, Job
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.archives import made, zipped
from tests.dataset_folder import add_calibrations, cameras, make_folder, options

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_folders(settings: Any, tmp_path: Path) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.UPLOADS_ROOT = tmp_path / "uploads"


@pytest.fixture
def dataset(tmp_path: Path) -> Dataset:
    return import_dataset(options(make_folder(tmp_path / "square"))).dataset


@pytest.fixture
def staff(client: Client, dataset: Dataset) -> Client:
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    return client


def text(response: Any) -> str:
    return response.content.decode()


def new_json(folder: Path, pixels: float = 7.0) -> SimpleUploadedFile:
    found = cameras()
    matrix = found[1].matrix.copy()
    matrix[0, 2] += pixels
    found[1] = replace(found[1], matrix=matrix)
    save_cameras(folder / "new.json", found)
    return SimpleUploadedFile("new.json", (folder / "new.json").read_bytes())


def compared(staff: Client, tmp_path: Path) -> Job:
    response = staff.post("/datasets/square/calibration/", {"file": new_json(tmp_path), "tvec_unit": "m"})
    job = Job.objects.get(kind=Job.Kind.REPLACE_CALIBRATION)
    assert response["Location"] == f"/jobs/{job.pk}/"
    queue.run(job.pk, OPERATIONS)
    return Job.objects.get(pk=job.pk)


def middle() -> float:
    return Dataset.objects.get(slug="square").calibrated_cameras()[1].matrix[0, 2]


def test_only_staff_see_and_change_calibrations(client: Client, dataset: Dataset) -> None:
    job = Job.objects.create(dataset=dataset, kind=Job.Kind.REPLACE_CALIBRATION, state=Job.State.DONE)
    for path in ("", f"{job.pk}/"):
        assert client.get(f"/datasets/square/calibration/{path}")["Location"].startswith("/login/")
    assert client.post(f"/datasets/square/calibration/{job.pk}/confirm/")["Location"].startswith("/login/")


def test_the_page_shows_where_cameras_stand(staff: Client) -> None:
    page = text(staff.get("/datasets/square/calibration/"))
    assert "320 × 240" in page and "9.50, -4.50, 3.20" in page


def test_what_would_move_is_shown_before_anything_does(staff: Client, tmp_path: Path) -> None:
    job = compared(staff, tmp_path)
    assert f'href="/datasets/square/calibration/{job.pk}/"' in text(staff.get(f"/jobs/{job.pk}/"))
    page = text(staff.get(f"/datasets/square/calibration/{job.pk}/"))
    assert (
        page.count("<svg") == 3 and "by up to 7 pixels" in page and "Put the new calibration in place" in page
    )
    assert "The boxes that move most" in page
    assert middle() == 160


def test_confirming_puts_it_in_place_and_is_remembered(staff: Client, tmp_path: Path) -> None:
    job = compared(staff, tmp_path)
    staff.post(f"/datasets/square/calibration/{job.pk}/confirm/")
    assert middle() == 167
    page = text(staff.get(f"/datasets/square/calibration/{job.pk}/"))
    assert "by sam" in page and "Put the new calibration in place" not in page


def test_confirming_after_a_change_is_refused(staff: Client, tmp_path: Path) -> None:
    job = compared(staff, tmp_path)
    Annotation.objects.all().delete()
    response = staff.post(f"/datasets/square/calibration/{job.pk}/confirm/", follow=True)
    assert "have changed" in text(response)
    assert middle() == 160


def test_a_job_of_another_dataset_cannot_be_confirmed_here(staff: Client, tmp_path: Path) -> None:
    job = compared(staff, tmp_path)
    Dataset.objects.create(slug="other", name="Other")
    assert staff.post(f"/datasets/other/calibration/{job.pk}/confirm/").status_code == 404
    assert middle() == 160


def test_a_confirmation_by_address_alone_does_nothing(staff: Client, tmp_path: Path) -> None:
    job = compared(staff, tmp_path)
    assert staff.get(f"/datasets/square/calibration/{job.pk}/confirm/").status_code == 405


def test_a_zip_of_opencv_files_is_read(staff: Client, tmp_path: Path) -> None:
    add_calibrations(tmp_path / "new", tvec_unit="cm")
    data = zipped(tmp_path / "new", tmp_path / "new.zip").read_bytes()
    file = SimpleUploadedFile("new.zip", data)
    staff.post("/datasets/square/calibration/", {"file": file, "tvec_unit": "cm"})
    assert Job.objects.filter(kind=Job.Kind.REPLACE_CALIBRATION).count() == 1


def test_everything_wrong_is_told_on_the_form(staff: Client, tmp_path: Path) -> None:
    save_cameras(tmp_path / "new.json", [replace(camera, name=f"X{camera.name}") for camera in cameras()[:2]])
    file = SimpleUploadedFile("new.json", (tmp_path / "new.json").read_bytes())
    page = text(staff.post("/datasets/square/calibration/", {"file": file, "tvec_unit": "m"}))
    assert "none is camera C3" in page
    assert str(tmp_path) not in page
    assert not Job.objects.exists() and list((tmp_path / "uploads").iterdir()) == []


def test_a_hostile_zip_is_refused(staff: Client, tmp_path: Path) -> None:
    data = made(tmp_path / "evil.zip", ("../evil.xml", b"x")).read_bytes()
    file = SimpleUploadedFile("evil.zip", data)
    page = text(staff.post("/datasets/square/calibration/", {"file": file, "tvec_unit": "m"}))
    assert "leads out of the archive" in page


def test_versions_are_listed_and_an_earlier_one_comes_back(staff: Client, tmp_path: Path) -> None:
    staff.post(f"/datasets/square/calibration/{compared(staff, tmp_path).pk}/confirm/")
    page = text(staff.get("/datasets/square/calibration/"))
    assert "new.json" in page and page.count('/compare/"') == 1 + page.count('/datasets/square/compare/"')
    response = staff.post("/datasets/square/calibration/versions/1/compare/")
    job = Job.objects.latest("pk")
    assert response["Location"] == f"/jobs/{job.pk}/" and middle() == 167
    queue.run(job.pk, OPERATIONS)
    staff.post(f"/datasets/square/calibration/{job.pk}/confirm/")
    assert middle() == 160


def test_a_version_that_never_was_is_not_found(staff: Client) -> None:
    assert staff.post("/datasets/square/calibration/versions/9/compare/").status_code == 404
    assert not Job.objects.exists()


def test_only_staff_go_back_to_a_version(client: Client, dataset: Dataset) -> None:
    response = client.post("/datasets/square/calibration/versions/1/compare/")
    assert response["Location"].startswith("/login/") and not Job.objects.exists()
