from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from gtm_hit.models import Batch, Dataset, Job, Layer, Release
from gtm_hit.ops.exports.sources import SOURCES
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.releases.releasing import PARTS
from gtm_hit.tasks import OPERATIONS
from tests.api.conftest import Caller, bearer
from tests.ops.square_layer import fill, make_square
from tests.work_scene import make_layer

BASE = "/api/v1/datasets/square/"
IMPORT = {"source": "incoming/there", "slug": "new", "preset": "wildtrack"}
ANNOTATIONS = {"source": "incoming/there", "format": "csv", "layer": "found"}
VIDEOS = {
    **IMPORT,
    "videos": [{"camera": "C1", "file": "one.mp4", "offset": 12.4}, {"camera": "C2", "file": "two.mp4"}],
}
RELEASE = {"layer": "truth", "licence": "Use it as you like."}


def video(**values: Any) -> dict[str, Any]:
    return {"camera": "C1", "file": "two.mp4", **values}


WRITES = [
    ("work", BASE + "batches/", {"size": 5}),
    ("release", BASE + "layers/truth/exports/", {"formats": ["csv"]}),
    ("release", BASE + "releases/", RELEASE),
    ("import", "/api/v1/imports/", IMPORT),
    ("import", BASE + "annotation-imports/", ANNOTATIONS),
    ("import", "/api/v1/video-imports/", VIDEOS),
]


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    for name in ("TABLES", "EXPORTS", "RELEASES", "UPLOADS", "INCOMING"):
        setattr(settings, f"{name}_ROOT", tmp_path / name.lower())
    (settings.INCOMING_ROOT / "there").mkdir(parents=True)
    for name in ("one.mp4", "two.mp4"):
        (settings.INCOMING_ROOT / "there" / name).touch()
    (settings.INCOMING_ROOT / "outside.mp4").touch()


@pytest.fixture(autouse=True)
def truth(db: None) -> Layer:
    layer = make_layer(make_square(), "truth")
    fill(layer)
    return layer


def run(response: Any) -> Job:
    assert response.status_code == 202, response.json()
    queue.run(response.json()["id"], OPERATIONS)
    return Job.objects.get(pk=response.json()["id"])


def archive(**files: str) -> SimpleUploadedFile:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as written:
        for name, text in files.items():
            written.writestr(name, text)
    return SimpleUploadedFile("found.zip", content.getvalue())


def upload(caller: Caller, file: Any) -> Any:
    return caller.client.post("/api/v1/uploads/", {"file": file}, headers=caller.headers)


@pytest.mark.parametrize(("scope", "path", "body"), WRITES)
def test_the_right_scope_starts_it(scope: str, path: str, body: Any) -> None:
    assert bearer(scope).post(path, body).status_code in {200, 202}
    assert Batch.objects.exists() or Job.objects.get().created_by.username == "script"


@pytest.mark.parametrize(("scope", "path", "body"), WRITES)
def test_nobody_else_starts_it(stranger: Caller, user: Caller, scope: str, path: str, body: Any) -> None:
    others = {"read", "import", "work", "release"} - {scope}
    assert stranger.post(path, body).status_code == 401
    assert user.post(path, body).status_code == 403
    assert bearer(*others).post(path, body).status_code == 403
    assert not Job.objects.exists() and not Batch.objects.exists()


def test_batches_are_made_once() -> None:
    script = bearer("work")
    count = Dataset.objects.get().frames.count()
    assert script.post(BASE + "batches/", {"size": 1}).json() == {"made": count}
    assert script.post(BASE + "batches/", {"size": 1}).json() == {"made": 0}


@pytest.mark.parametrize(
    ("path", "body", "place"),
    [
        (BASE + "batches/", {"size": 0}, "size"),
        (BASE + "layers/truth/exports/", {"formats": []}, "formats"),
        (BASE + "layers/truth/exports/", {"formats": ["pdf"]}, "formats.0"),
        (BASE + "releases/", {**RELEASE, "layer": "none"}, "layer"),
        (BASE + "releases/", {**RELEASE, "licence": ""}, "licence"),
        ("/api/v1/imports/", {**IMPORT, "source": "incoming/../there"}, "source"),
        ("/api/v1/imports/", {**IMPORT, "preset": None}, "values"),
        ("/api/v1/imports/", {**IMPORT, "values": {"step": "nan"}}, "values.step"),
        ("/api/v1/imports/", {**IMPORT, "values": {"step": 10**400}}, "values.step"),
        ("/api/v1/video-imports/", {**VIDEOS, "preset": None}, "values"),
        ("/api/v1/video-imports/", {**VIDEOS, "videos": []}, "videos"),
        ("/api/v1/video-imports/", {**VIDEOS, "source": "uploads/x.zip"}, "source"),
        ("/api/v1/video-imports/", {**VIDEOS, "start": -1}, "start"),
        *(
            ("/api/v1/video-imports/", {**VIDEOS, "videos": [video(file="one.mp4"), video(**wrong)]}, place)
            for wrong, place in [
                ({"file": "../outside.mp4"}, "videos.1.file"),
                ({"file": "three.mp4"}, "videos.1.file"),
                ({"file": "a\x00b"}, "videos.1.file"),
                ({"offset": "nan"}, "videos.1.offset"),
            ]
        ),
        (BASE + "annotation-imports/", {**ANNOTATIONS, "layer": "truth"}, "layer"),
        (BASE + "annotation-imports/", {**ANNOTATIONS, "drop": ["all"]}, "drop.0"),
    ],
)
def test_a_senseless_request_is_refused_with_its_place(path: str, body: Any, place: str) -> None:
    response = bearer("import", "work", "release").post(path, body)
    assert (response.status_code, response.json()["code"]) == (400, "invalid")
    assert place in {each["place"] for each in response.json()["details"]}
    assert not Job.objects.exists()


def test_an_export_is_downloaded_when_it_is_done(truth: Layer) -> None:
    script = bearer("read", "release")
    response = script.post(BASE + "layers/truth/exports/", {"formats": ["csv"]})
    address = f"/api/v1/jobs/{run(response).pk}/"
    download = script.get(script.get(address).json()["download"])
    with zipfile.ZipFile(io.BytesIO(b"".join(download.streaming_content))) as found:
        assert "square-truth/people.csv" in found.namelist()
    assert bearer("release").get(address + "download/").status_code == 403


def test_files_that_were_deleted_are_gone_in_plain_words(truth: Layer) -> None:
    script = bearer("read", "release")
    address = f"/api/v1/jobs/{run(script.post(BASE + 'layers/truth/exports/', {'formats': ['csv']})).pk}/"
    assert script.get(address).json()["expires_at"]
    assert bearer("read", "work").post(address + "delete-files/").status_code == 403
    gone = script.post(address + "delete-files/").json()
    assert (gone["removed"], gone["download"], gone["expires_at"]) == ("deleted", None, None)
    refused = script.get(address + "download/")
    assert (refused.status_code, refused.json()["code"]) == (410, "removed")
    again = script.post(address + "delete-files/")
    assert (again.status_code, again.json()["code"]) == (409, "no_files")
    assert script.post(address + "retry/").status_code == 202


def test_a_release_is_listed_and_downloaded_when_it_is_done() -> None:
    script = bearer("read", "release")
    assert run(script.post(BASE + "releases/", {**RELEASE, "formats": ["csv"]})).result["release"] == 1
    listed = script.get(BASE + "releases/").json()["results"][0]
    assert (listed["number"], listed["layer"]) == (1, "truth")
    assert script.get(BASE + "releases/1/").json() == listed
    download = script.get(BASE + "releases/1/download/")
    assert b"".join(download.streaming_content)[:2] == b"PK"
    parts = {name: script.get(f"{BASE}releases/1/files/{name}") for name in set(PARTS) - {SOURCES}}
    assert all(b"".join(part.streaming_content) for part in parts.values())
    assert script.get(BASE + "releases/1/files/people.csv").status_code == 404
    assert bearer("release").get(BASE + "releases/1/files/README.md").status_code == 403
    assert Release.objects.get().created_by.username == "script"


def test_uploaded_annotations_become_a_layer(truth: Layer) -> None:
    number = truth.dataset.frames.order_by("number").first().number  # type: ignore[union-attr]
    script = bearer("read", "import")
    kept = upload(script, archive(**{"found.csv": f"frame,person,x,y\n{number},1,0,0\n"}))
    assert kept.status_code == 201
    assert kept.json() in script.get("/api/v1/sources/").json()["results"]
    body = {"source": kept.json()["key"], "format": "csv", "layer": "found"}
    assert run(script.post(BASE + "annotation-imports/", body)).result["annotations"] == 1
    assert script.get(BASE + "layers/found/").json()["annotations"] == 1


def test_an_archive_that_leads_out_of_its_folder_is_refused() -> None:
    response = upload(bearer("import"), archive(**{"../evil": "x"}))
    assert (response.status_code, response.json()["details"][0]["place"]) == (400, "file")
    assert upload(bearer("read"), archive(a="x")).status_code == 403


def test_a_body_longer_than_accepted_is_not_read(settings: Any) -> None:
    settings.MAX_UPLOAD_MB = 1
    response = upload(bearer("import"), SimpleUploadedFile("big.zip", b"x" * 2_100_000))
    assert (response.status_code, response.json()["code"]) == (413, "too_large")


def test_what_somebody_may_start_he_may_stop_and_start_again() -> None:
    script = bearer("read", "release")
    address = f"/api/v1/jobs/{script.post(BASE + 'releases/', RELEASE).json()['id']}/"
    assert script.post(address + "retry/").json()["code"] == "under_way"
    assert bearer("read", "import", "work").post(address + "cancel/").status_code == 403
    assert script.post(address + "cancel/").json()["state"] == "cancelled"
    again = script.post(address + "retry/")
    assert (again.status_code, again.json()["state"]) == (202, "queued")


def test_there_is_nothing_to_stop_where_no_job_is() -> None:
    for action in ("cancel", "retry"):
        assert bearer("read", "import").post(f"/api/v1/jobs/1/{action}/").status_code == 404
