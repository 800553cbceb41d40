"""What every answer carries, what a full disk says, and what is read of a body before its sender is known."""

from __future__ import annotations

import errno
import io
import logging
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.uploadedfile import TemporaryUploadedFile
from django.db import OperationalError
from django.test import Client
from django.urls import set_script_prefix

from annotator.masked_log import MaskingFormatter
from gtm_hit.ops.files import sources
from gtm_hit.ops.work import assignments, links
from gtm_hit.ops.work.batches import make_batches
from tests.conftest import REPOSITORY
from tests.work_scene import make_dataset, make_layer, make_worker

pytestmark = pytest.mark.django_db


@pytest.fixture
def staff(client: Client) -> Client:
    client.force_login(User.objects.create_user("staff", is_superuser=True))
    return client


@pytest.mark.parametrize("path", ["/", "/login/", "/datasets/", "/admin/", "/nowhere/", "/api/v1/docs/"])
def test_a_page_loads_and_runs_only_what_comes_from_this_server(staff: Client, path: str) -> None:
    policy = staff.get(path).headers["Content-Security-Policy"]
    assert "default-src 'self'" in policy
    assert "unsafe" not in policy
    assert "frame-ancestors 'none'" in policy


def test_no_page_has_script_or_style_in_itself(staff: Client) -> None:
    for path in ("/", "/login/", "/datasets/", "/admin/", "/api/v1/docs/"):
        page = staff.get(path, follow=True).content.decode()
        assert re.findall(r"<style|\sstyle=|\son[a-z]+=|<script(?![^>]*\bsrc=)", page) == [], path


def test_options_of_the_description_page_are_answered(staff: Client) -> None:
    answer = staff.options("/api/v1/docs/")
    assert answer.status_code == 200
    assert answer.headers["Content-Type"] == "application/json"


def test_a_stranger_at_the_description_page_is_told_as_everywhere(client: Client) -> None:
    answer = client.get("/api/v1/docs/")
    assert answer.status_code == 401
    assert answer.json()["code"] == "not_signed_in"


def test_a_scene_travels_compressed(staff: Client) -> None:
    layer = make_layer(make_dataset(frames=50, images=True))
    plain = staff.get(f"/api/v1/layers/{layer.pk}/scene/")
    packed = staff.get(f"/api/v1/layers/{layer.pk}/scene/", headers={"Accept-Encoding": "gzip"})
    assert packed.headers["Content-Encoding"] == "gzip"
    assert len(packed.content) * 2 < len(plain.content)  # half of it are digests, which do not shrink


@pytest.fixture
def full_database(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_given: Any, **_named: Any) -> None:
        raise OperationalError("database or disk is full")

    monkeypatch.setattr("gtm_hit.api.common.staff.dataset_or_404", fail)
    monkeypatch.setattr("gtm_hit.api.datasets.listing.dataset_or_404", fail)


def test_a_full_disk_is_called_so_by_rest(
    staff: Client, full_database: None, caplog: pytest.LogCaptureFixture
) -> None:
    make_dataset()
    answer = staff.get("/api/v1/datasets/square/frames/")
    assert answer.status_code == 507
    assert answer.json()["code"] == "disk_full"
    assert "disk is full" in answer.json()["message"]
    assert [record.levelname for record in caplog.records if "full" in record.getMessage()] == ["ERROR"]


@pytest.fixture
def full_upload_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_given: Any, **_named: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(TemporaryUploadedFile, "__init__", fail)


def large_file() -> io.BytesIO:
    file = io.BytesIO(b"x" * 3_000_000)
    file.name = "data.zip"
    return file


@pytest.mark.parametrize("path", ["/api/v1/uploads/", "/imports/"])
def test_an_upload_on_a_full_disk_is_told_so(
    staff: Client, full_upload_folder: None, path: str, caplog: pytest.LogCaptureFixture
) -> None:
    staff.raise_request_exception = False
    answer = staff.post(path, {"file": large_file(), "archive": large_file()})
    assert answer.status_code == 507
    assert "disk is full" in answer.content.decode()
    assert "ERROR" in {record.levelname for record in caplog.records}


class Body(io.BytesIO):
    """A body that notices when it is read."""

    touched = False

    def read(self, *given: Any) -> bytes:
        Body.touched = True
        return super().read(*given)

    readline = read  # type: ignore[assignment]


@pytest.fixture
def body() -> Iterator[dict[str, Any]]:
    Body.touched = False
    content = b'--b\r\nContent-Disposition: form-data; name="file"; filename="a.zip"\r\n\r\nx\r\n--b--\r\n'
    yield {"wsgi.input": Body(content), "CONTENT_LENGTH": len(content)}


WRONG = {"HTTP_X_CSRFTOKEN": "x" * 32}


@pytest.mark.parametrize("path", ["/api/v1/uploads/", "/api/v1/evaluations/"])
@pytest.mark.parametrize(
    ("has_role", "header"), [(False, {}), (True, {}), (True, {"HTTP_X_CSRFTOKEN": "x" * 32})]
)
def test_a_body_is_not_read_before_its_sender_is_known(
    body: dict[str, Any], path: str, has_role: bool, header: dict[str, str]
) -> None:
    client = Client(enforce_csrf_checks=True)
    client.force_login(User.objects.create_user("somebody", is_superuser=has_role))
    client.cookies["csrftoken"] = "y" * 32
    kind = "multipart/form-data; boundary=b"
    answer = client.generic("POST", path, content_type=kind, **{**body, **header})  # type: ignore[arg-type]
    assert answer.status_code == 403
    assert not Body.touched


def test_staff_with_the_token_in_the_header_may_upload() -> None:
    client = Client(enforce_csrf_checks=True)
    client.force_login(User.objects.create_user("staff", is_superuser=True))
    client.cookies["csrftoken"] = "y" * 32
    answer = client.post("/api/v1/uploads/", {"file": large_file()}, headers={"X-CSRFToken": "y" * 32})
    assert answer.status_code == 400  # no zip, but taken in and looked at


def test_a_large_upload_is_kept_without_a_second_copy(settings: Any, tmp_path: Path) -> None:
    settings.UPLOADS_ROOT = Path(settings.FILE_UPLOAD_TEMP_DIR).parent / "uploads-of-a-test"
    upload = TemporaryUploadedFile("data.zip", "application/zip", 0, None)
    import zipfile

    with zipfile.ZipFile(upload, "w") as archive:
        archive.writestr("a.json", "[]")
    arrived = Path(upload.temporary_file_path()).stat().st_ino
    kept = sources.keep(upload)
    assert kept.path.stat().st_ino == arrived
    upload.close()
    assert zipfile.is_zipfile(kept.path)
    kept.path.unlink()


def test_the_log_holds_no_key() -> None:
    record = logging.LogRecord(
        "django.request", logging.ERROR, "", 0, "Not Found: %s", ("/gtm/annotate/KEY:x-y/",), None
    )
    line = MaskingFormatter("{message}", style="{").format(record)
    assert line == "Not Found: /gtm/annotate/…/"


@pytest.fixture(autouse=True)
def usual_path() -> Iterator[None]:
    yield
    set_script_prefix("/")


def test_every_address_lies_below_the_path_of_the_server(settings: Any, staff: Client) -> None:
    settings.FORCE_SCRIPT_NAME = "/gtm"
    set_script_prefix("/gtm/")  # as the handler of a server does, but not the tests' client
    layer = make_layer(make_dataset(images=True), name="with space")
    batch = make_batches(layer.dataset)
    worker = make_worker()
    assignment = assignments.claim(worker, layer.dataset)
    token = links.assignment_token(assignment)
    assert batch
    for path in (
        *("/", "/login/", "/datasets/", "/imports/", "/imports/videos/"),
        *("/exports/", "/tokens/", "/nowhere/"),
        *(f"/datasets/square/{part}" for part in ("", "layers/", "batches/", "calibration/", "releases/")),
        *("/datasets/square/layers/with space/", f"/annotate/{token}/"),
    ):
        page = staff.get(path).content.decode()
        found = re.findall(r'(?:href|src|action|data-\w+)="(/[^"]*)"', page)
        wrong = [each for each in found if not each.startswith(("/gtm/", "/static/"))]
        assert wrong == [], path
    frames = staff.get(f"/api/v1/layers/{layer.pk}/scene/").json()["frames"]
    assert frames[0]["images"][0]["light"].startswith("/gtm/api/v1/images/")


def test_neither_script_nor_template_has_an_absolute_address() -> None:
    absolute = re.compile(
        r"""(?:href|src|action)=["']/[a-z"']|["'`]/(?:login|logout|api|static|datasets|admin)/"""
    )
    for folder in ("static/workbench", "static/site", "static/geometry", "templates", "gtm_hit"):
        for file in (REPOSITORY / folder).rglob("*.*"):
            if file.suffix in {".js", ".html", ".py", ".css"}:
                assert not absolute.findall(file.read_text(encoding="utf-8")), file
