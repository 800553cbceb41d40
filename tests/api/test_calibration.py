from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.models import Dataset, Job
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.api.conftest import Caller, bearer
from tests.dataset_folder import make_folder, options
from tests.ops.calibration.test_replace_calibration import calibrations, shifted


@pytest.fixture
def square(db: None, settings: Any, tmp_path: Path) -> Dataset:
    for name in ("MEDIA", "TABLES", "UPLOADS"):
        setattr(settings, f"{name}_ROOT", tmp_path / name.lower())
    return import_dataset(options(make_folder(tmp_path / "square"))).dataset


@pytest.fixture
def file(tmp_path: Path) -> bytes:
    """The dataset's own, but for the second camera: its boxes go 7 pixels to the right."""
    save_cameras(tmp_path / "cameras.json", shifted(7.0))
    return (tmp_path / "cameras.json").read_bytes()


def address(dataset: Dataset) -> str:
    return f"/api/v1/datasets/{dataset.slug}/calibrations/"


def send(caller: Caller, dataset: Dataset, content: bytes, name: str = "cameras.json") -> Any:
    form = {"file": SimpleUploadedFile(name, content)}
    return caller.client.post(address(dataset), form, headers=caller.headers)


def compared(caller: Caller, dataset: Dataset, content: bytes) -> str:
    """The address of what a finished comparison found."""
    response = send(caller, dataset, content)
    assert response.status_code == 202, response.json()
    queue.run(response.json()["id"], OPERATIONS)
    return f"{address(dataset)}{response.json()['id']}/"


def test_the_boxes_that_would_move_are_told_before_anything_changes(square: Dataset, file: bytes) -> None:
    before = calibrations(square)
    script = bearer("read", "import")
    found = script.get(compared(script, square, file)).json()
    moved = [(each["moved"] > 0, each["max"]) for each in found["cameras"]]
    assert moved == [(False, 0), (True, 7), (False, 0)]
    assert (found["annotations"], found["worst"][0]["shift"], found["confirmed_at"]) == (5, 7, None)
    assert calibrations(square) == before


def test_what_was_seen_is_put_in_place_once(square: Dataset, file: bytes) -> None:
    script = bearer("read", "import")
    place = compared(script, square, file)
    confirmed = script.post(place + "confirm/")
    assert confirmed.status_code == 200 and confirmed.json()["confirmed_at"]
    matrix = square.cameras.get(index=1).matrix
    assert matrix == shifted(7.0)[1].matrix.tolist()
    again = script.post(place + "confirm/")
    assert (again.status_code, again.json()["code"]) == (409, "conflict")


def test_an_unfinished_comparison_cannot_be_seen_or_confirmed(square: Dataset, file: bytes) -> None:
    before = calibrations(square)
    script = bearer("read", "import")
    place = f"{address(square)}{send(script, square, file).json()['id']}/"
    assert script.get(place).status_code == 404
    assert script.post(place + "confirm/").status_code == 409
    assert calibrations(square) == before


def test_a_job_of_another_kind_or_dataset_is_not_found(square: Dataset, file: bytes) -> None:
    script = bearer("read", "import")
    place = compared(script, square, file)
    assert script.post(place.replace(square.slug, "other") + "confirm/").status_code == 404
    other = queue.create(Job.Kind.EXPORT_LAYER, square, {})
    assert script.post(f"{address(square)}{other.pk}/confirm/").status_code == 404


def test_only_who_may_import_replaces_a_calibration(
    square: Dataset, file: bytes, stranger: Caller, user: Caller
) -> None:
    before = calibrations(square)
    place = compared(bearer("import"), square, file)
    for caller, status in [(stranger, 401), (user, 403), (bearer("read", "work", "release"), 403)]:
        assert send(caller, square, file).status_code == status
        assert caller.post(place + "confirm/").status_code == status
    assert bearer("import").get(place).status_code == 403
    assert Job.objects.count() == 1
    assert calibrations(square) == before


def test_staff_at_the_browser_may_too(square: Dataset, file: bytes, staff: Caller) -> None:
    assert staff.post(compared(staff, square, file) + "confirm/").status_code == 200


@pytest.mark.parametrize("content", [b"", b"{", b'{"format": "gtm-cameras", "version": 1, "cameras": []}'])
def test_what_is_no_calibration_is_refused_with_its_place(square: Dataset, content: bytes) -> None:
    response = send(bearer("import"), square, content)
    assert (response.status_code, response.json()["details"][0]["place"]) == (400, "file")
    assert not Job.objects.exists()


def test_a_file_too_large_is_not_read(square: Dataset) -> None:
    response = send(bearer("import"), square, b" " * 12_000_000)
    assert (response.status_code, response.json()["code"]) == (413, "too_large")


def test_versions_are_listed_with_the_one_in_place(square: Dataset, file: bytes) -> None:
    script = bearer("read", "import")
    confirmed = script.post(compared(script, square, file) + "confirm/").json()
    assert confirmed["calibration"] == 2
    found = script.get(address(square) + "versions/").json()["results"]
    told = [(each["number"], each["in_place"], each["source"]) for each in found]
    assert told == [(2, True, "cameras.json"), (1, False, "import")]


def test_a_version_is_read_with_its_cameras(square: Dataset) -> None:
    found = bearer("read").get(address(square) + "versions/1/").json()
    assert found["number"] == 1 and found["cameras"]["format"] == "gtm-cameras"
    assert found["cameras"]["cameras"][1]["matrix"] == square.cameras.get(index=1).matrix
    assert bearer("read").get(address(square) + "versions/2/").status_code == 404


def test_an_earlier_version_is_compared_and_put_in_place_again(square: Dataset, file: bytes) -> None:
    before = calibrations(square)
    script = bearer("read", "import")
    script.post(compared(script, square, file) + "confirm/")
    started = script.client.post(address(square), {"version": 1}, headers=script.headers)
    assert started.status_code == 202 and calibrations(square) != before
    queue.run(started.json()["id"], OPERATIONS)
    confirmed = script.post(f"{address(square)}{started.json()['id']}/confirm/").json()
    assert confirmed["calibration"] == 1 and calibrations(square) == before


@pytest.mark.parametrize("given", [{}, {"version": 7}, {"version": 0}, {"version": "one"}])
def test_a_comparison_wants_a_file_or_a_version_there_is(square: Dataset, given: dict[str, Any]) -> None:
    script = bearer("import")
    response = script.client.post(address(square), given, headers=script.headers)
    assert (response.status_code, response.json()["code"]) == (400, "invalid")
    assert not Job.objects.exists()
