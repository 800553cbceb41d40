"""New datasets through the browser: who may, what is checked, what is started."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from gtm_hit.models import Dataset, Job
from gtm_hit.ops.files import sources
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.archives import made, zipped
from tests.dataset_folder import VALUES, make_folder
from tests.video_files import make_videos

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_folders(settings: Any, tmp_path: Path) -> None:
    settings.DATA_DIR = tmp_path / "data"
    settings.MEDIA_ROOT = tmp_path / "media"
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.INCOMING_ROOT = tmp_path / "incoming"
    settings.UPLOADS_ROOT = tmp_path / "uploads"


@pytest.fixture
def staff(client: Client) -> Client:
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    return client


@pytest.fixture
def archive(tmp_path: Path) -> bytes:
    return zipped(make_folder(tmp_path / "square"), tmp_path / "square.zip").read_bytes()


def form(**changes: Any) -> dict[str, Any]:
    return {"slug": "square", "layer": "imported", **VALUES, **changes}


def text(response: Any) -> str:
    return response.content.decode()


def run(job: Job) -> Job:
    queue.run(job.pk, OPERATIONS)
    return Job.objects.get(pk=job.pk)


@pytest.mark.parametrize("path", ["/imports/", "/imports/videos/"])
def test_only_who_has_a_role_comes_here(client: Client, path: str) -> None:
    assert client.get(path)["Location"] == f"/login/?next={path}"
    assert client.post(path, {})["Location"].startswith("/login/")
    client.force_login(User.objects.create_user("worker"))
    assert client.get(path).status_code == client.post(path, {}).status_code == 403
    assert not Job.objects.exists()


def test_the_page_offers_what_lies_on_the_server(staff: Client, tmp_path: Path) -> None:
    (tmp_path / "incoming" / "plaza").mkdir(parents=True)
    assert 'value="incoming/plaza"' in text(staff.get("/imports/"))


def test_an_archive_is_imported_and_the_job_tells(staff: Client, archive: bytes) -> None:
    response = staff.post("/imports/", form(archive=SimpleUploadedFile("square.zip", archive)))
    job = Job.objects.get()
    assert response["Location"] == f"/jobs/{job.pk}/"
    waiting = text(staff.get(f"/jobs/{job.pk}/"))
    assert "uploads/square-" in waiting and "Cancel" in waiting
    run(job)
    page = text(staff.get(f"/jobs/{job.pk}/"))
    assert "What was added" in page and 'href="/datasets/square/"' in page
    assert "files are no longer on this server" not in page
    assert Dataset.objects.get().slug == "square"


def test_a_failed_import_shows_every_problem_in_a_line_of_its_own(
    staff: Client, tmp_path: Path, archive: bytes
) -> None:
    for camera in ("C1", "C2"):
        (tmp_path / "square" / "calibrations" / "extrinsic" / f"extr_{camera}.xml").write_text("nothing")
    broken = zipped(tmp_path / "square", tmp_path / "broken.zip").read_bytes()
    staff.post("/imports/", form(archive=SimpleUploadedFile("square.zip", broken)))
    job = run(Job.objects.get())
    page = text(staff.get(f"/jobs/{job.pk}/"))
    assert job.state == Job.State.FAILED
    assert "extr_C1.xml" in page and "extr_C2.xml" in page and "<br>" in page
    assert not Dataset.objects.exists()


def test_the_list_of_imports_copes_with_datasets_that_never_were(staff: Client) -> None:
    Job.objects.create(
        kind=Job.Kind.IMPORT_DATASET,
        state=Job.State.FAILED,
        message="1 problem",
        parameters={"source": "incoming/plaza", "options": {"slug": "never"}},
    )
    assert "never" in text(staff.get("/imports/"))
    assert staff.get("/exports/").status_code == staff.get("/datasets/").status_code == 200


def test_a_hostile_archive_is_refused_on_the_form(staff: Client, tmp_path: Path) -> None:
    data = made(tmp_path / "evil.zip", ("../evil.txt", b"x"), ("/etc/passwd", b"x")).read_bytes()
    page = text(staff.post("/imports/", form(archive=SimpleUploadedFile("evil.zip", data))))
    assert "../evil.txt: leads out of the archive" in page and "/etc/passwd: an absolute path" in page
    assert not Job.objects.exists() and list((tmp_path / "uploads").iterdir()) == []


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({}, "Choose an archive here"),
        ({"source": "incoming/../etc"}, "Select a valid choice"),
        ({"slug": "!!"}, "Use at least one letter from a to z or a digit"),
        ({"columns": ""}, "Needed where no published dataset is chosen"),
        ({"step": "-1"}, "greater than or equal to 0"),
        ({"columns": "100000", "rows": "100000"}, "--grid has 10,000,000,000 positions; at most"),
        ({"preset": "kitti"}, "Select a valid choice"),
    ],
)
def test_wrong_values_are_told_on_the_form(staff: Client, changes: dict[str, Any], reason: str) -> None:
    response = staff.post("/imports/", form(**changes))
    assert response.status_code == 200 and reason in text(response)
    assert not Job.objects.exists()


def test_an_archive_sent_with_a_wrong_value_is_kept_and_chosen(staff: Client, tmp_path: Path) -> None:
    data = made(tmp_path / "plaza.zip", ("Image_subsets/C1/0.png", b"x")).read_bytes()
    sent = form(slug="!!", archive=SimpleUploadedFile("plaza.zip", data))
    page = text(staff.post("/imports/", sent))
    assert "need not be sent again" in page
    (kept,) = (tmp_path / "uploads").iterdir()
    assert f'<option value="uploads/{kept.name}" selected>' in page
    staff.post("/imports/", form(slug="plaza", source=f"uploads/{kept.name}"))
    assert Job.objects.get().parameters["source"] == f"uploads/{kept.name}"


def test_an_archive_that_is_wrong_itself_is_not_kept(staff: Client, tmp_path: Path) -> None:
    data = made(tmp_path / "evil.zip", ("../evil.txt", b"x")).read_bytes()
    page = text(staff.post("/imports/", form(slug="!!", archive=SimpleUploadedFile("evil.zip", data))))
    assert "leads out of the archive" in page and "need not be sent again" not in page
    assert list((tmp_path / "uploads").iterdir()) == []


@pytest.mark.parametrize(("typed", "made"), [("Our plaza, 2", "our-plaza-2"), ("Plaza_2", "Plaza_2")])
def test_a_name_in_addresses_is_made_of_what_was_typed(
    staff: Client, tmp_path: Path, typed: str, made: str
) -> None:
    (tmp_path / "incoming" / "plaza").mkdir(parents=True)
    sent = {"slug": typed, "layer": "imported", "preset": "wildtrack", "source": "incoming/plaza"}
    staff.post("/imports/", sent)
    assert Job.objects.get().parameters["options"]["slug"] == made


def test_a_preset_needs_nothing_else(staff: Client, tmp_path: Path) -> None:
    (tmp_path / "incoming" / "plaza").mkdir(parents=True)
    staff.post(
        "/imports/",
        {"slug": "plaza", "layer": "imported", "preset": "wildtrack", "source": "incoming/plaza"},
    )
    assert Job.objects.get().parameters["options"]["preset"] == "wildtrack"


def test_a_body_that_is_too_large_is_refused_before_it_is_read(staff: Client, settings: Any) -> None:
    settings.MAX_UPLOAD_MB = 1
    response = staff.generic(
        "POST", "/imports/", b"x", content_type="multipart/form-data; boundary=b", CONTENT_LENGTH="3000000"
    )
    assert response["Location"] == "/imports/"
    assert "larger than 1 MB" in text(staff.get("/imports/"))


def test_the_form_is_guarded_against_forgery(archive: bytes) -> None:
    client = Client(enforce_csrf_checks=True)
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    response = client.post("/imports/", form(archive=SimpleUploadedFile("square.zip", archive)))
    assert response.status_code == 403
    assert sources.sources() == []


# Videos


def test_without_folders_the_page_says_where_to_put_them(staff: Client, tmp_path: Path) -> None:
    assert str(tmp_path / "incoming") in text(staff.get("/imports/videos/"))


def test_the_videos_of_a_folder_are_suggested(staff: Client, tmp_path: Path) -> None:
    make_videos(tmp_path / "incoming" / "walk", 30)
    assert "C1 = C1.mp4 @ 0\nC2 = C2.mp4 @ 0" in text(staff.get("/imports/videos/?source=incoming/walk"))


def test_videos_are_imported(staff: Client, tmp_path: Path) -> None:
    make_videos(tmp_path / "incoming" / "walk", 60)
    lines = "C1 = C1.mp4 @ 0\n\nC2=C2.mp4@0.1\nC3 = C3.mp4 @ 0"
    staff.post("/imports/videos/", form(source="incoming/walk", videos=lines))
    job = run(Job.objects.get())
    assert (job.state, job.result["frames"]) == (Job.State.DONE, 4)
    page = text(staff.get(f"/jobs/{job.pk}/"))
    assert "What was added" in page and "ms from the time of their frame" in page


@pytest.mark.parametrize(
    ("lines", "reason"),
    [
        ("C1", "does not read CAMERA=FILE@SECONDS"),
        ("C1=C1.mp4@soon", "is no number of seconds"),
        ("C1=../other.mp4", "does not lie in this folder"),
        ("C1=/etc/passwd", "does not lie in this folder"),
        ("C1=none.mp4", "does not lie in this folder"),
    ],
)
def test_wrong_lines_are_told(staff: Client, tmp_path: Path, lines: str, reason: str) -> None:
    make_videos(tmp_path / "incoming" / "walk", 30)
    (tmp_path / "incoming" / "other.mp4").touch()
    page = text(staff.post("/imports/videos/", form(source="incoming/walk", videos=lines)))
    assert reason in page
    assert not Job.objects.exists()


def test_an_archive_is_no_folder_of_videos(staff: Client, tmp_path: Path) -> None:
    (tmp_path / "incoming" / "walk").mkdir(parents=True)
    made(tmp_path / "incoming" / "a.zip", ("C1.mp4", b"x"))
    page = text(staff.post("/imports/videos/", form(source="incoming/a.zip", videos="C1=C1.mp4")))
    assert "Select a valid choice" in page
