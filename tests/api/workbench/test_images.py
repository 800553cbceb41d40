from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.core.files.base import ContentFile
from django.core.files.storage import default_storage

from gtm_hit.models import Assignment, Dataset, Image
from gtm_hit.ops.work import links
from tests.api.conftest import Caller
from tests.work_scene import digest, finish

PICTURE = b"\xff\xd8 a picture"
FOREVER = "private, max-age=31536000, immutable"


@pytest.fixture(autouse=True)
def media(settings: Any, tmp_path: Path) -> Path:
    settings.MEDIA_ROOT = tmp_path / "media"
    return tmp_path / "media"


@pytest.fixture
def path(dataset: Dataset) -> str:
    """A picture of frame 5, in the first batch."""
    return stored(Image.objects.filter(frame__number=5).first())


def stored(image: Image | None) -> str:
    assert image
    name = digest(PICTURE + str(image.pk).encode())
    default_storage.save(f"images/{name[:2]}/{name}.jpg", ContentFile(PICTURE))
    Image.objects.filter(pk=image.pk).update(light_digest=name)
    return f"/api/v1/images/{name}.jpg"


def test_the_holder_of_the_batch_sees_its_pictures_and_keeps_them(alice: Caller, path: str) -> None:
    response = alice.get(path)
    assert response.status_code == 200
    assert b"".join(response.streaming_content) == PICTURE
    assert response["Content-Type"] == "image/jpeg"
    assert response["Content-Length"] == str(len(PICTURE))
    assert response["Cache-Control"] == FOREVER
    assert response["ETag"] == f'"{path[-68:-4]}"'
    assert "Cookie" not in response.get("Vary", "")


def test_a_picture_the_browser_has_is_not_sent_again(alice: Caller, path: str) -> None:
    response = alice.get(path, **{"If-None-Match": f'"{path[-68:-4]}"'})
    assert (response.status_code, response.content) == (304, b"")
    assert response["Cache-Control"] == FOREVER


def test_a_client_that_accepts_pictures_only_gets_one(alice: Caller, path: str) -> None:
    assert alice.get(path, Accept="image/jpeg").status_code == 200


def test_head_tells_the_size_only(alice: Caller, path: str) -> None:
    response = alice.head(path)
    assert (response.status_code, response["Content-Length"]) == (200, str(len(PICTURE)))
    assert response.getvalue() == b""


def test_the_full_picture_is_reached_the_same_way(alice: Caller, dataset: Dataset, path: str) -> None:
    Image.objects.filter(light_digest=path[-68:-4]).update(light_digest="0" * 64, full_digest=path[-68:-4])
    assert alice.get(path).status_code == 200


def test_staff_see_every_picture(staff: Caller, path: str) -> None:
    assert staff.get(path).status_code == 200


def test_after_submission_the_worker_still_sees_what_he_did(
    alice: Caller, path: str, assignment: Assignment
) -> None:
    finish(assignment)
    assert alice.get(path).status_code == 200


def test_a_worker_of_another_batch_does_not(bob: Caller, path: str) -> None:
    assert bob.get(path).json()["code"] == "not_found"


def test_a_workers_token_opens_no_pictures_of_batches(path: str, assignment: Assignment) -> None:
    token = links.worker_token(assignment.worker, assignment.batch.dataset)
    assert Caller(f"Worker {token}").get(path).status_code == 404


@pytest.mark.parametrize(("caller", "status"), [("stranger", 401), ("user", 403)])
def test_others_do_not(caller: str, status: int, path: str, request: pytest.FixtureRequest) -> None:
    assert request.getfixturevalue(caller).get(path).status_code == status


def test_a_revoked_link_opens_no_pictures(alice: Caller, path: str, assignment: Assignment) -> None:
    Assignment.objects.update(nonce="another")
    assert alice.get(path).status_code == 401


@pytest.mark.parametrize(
    "name",
    [
        "../settings.py",
        "..%2f..%2fsettings.py",
        "a" * 64,
        "a" * 64 + ".jpg",
        "A" * 64 + ".jpg",
        "a" * 63 + ".jpg",
        "%00" + "a" * 64 + ".jpg",
        "a" * 64 + ".jpg%0a",
    ],
)
def test_no_name_leads_anywhere_else(staff: Caller, db: None, name: str) -> None:
    response = staff.get(f"/api/v1/images/{name}")
    assert (response.status_code, response.json()["code"]) == (404, "not_found")


def test_a_picture_whose_file_is_gone_is_not_found(staff: Caller, dataset: Dataset, media: Path) -> None:
    image = Image.objects.first()
    assert image
    assert staff.get(f"/api/v1/images/{image.light_digest}.jpg").status_code == 404
