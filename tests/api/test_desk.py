from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.uploadedfile import SimpleUploadedFile
from PIL import Image as Picture

from gtm_hit.models import Dataset, Desk, DeskCamera
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import desks
from tests.access.scene import somebody
from tests.api.conftest import Caller, bearer
from tests.desk_scene import make_desk, seen

DESKS = "/api/v1/calibration-desks/"
AT = f"{DESKS}plaza/"


@pytest.fixture
def desk(dataset: Dataset) -> Desk:
    return make_desk(dataset)


@pytest.fixture
def maintainer(dataset: Dataset) -> Caller:
    return Caller(user=somebody("mia", Role.MAINTAINER, dataset))


def click(caller: Caller, point: str, place: Any, camera: str = "C1") -> Any:
    x, y = place
    return caller.put(f"{AT}cameras/{camera}/clicks/{point}/", {"x": x, "y": y})


def test_a_click_answers_with_the_pose_and_what_is_expected_where(desk: Desk, maintainer: Caller) -> None:
    places = seen(desk)
    for name in ("A1", "E1", "E3"):
        assert click(maintainer, name, places[name]).json()["camera"]["placed"] is None
    found = click(maintainer, "A3", places["A3"]).json()
    assert found["camera"]["placed"]["name"] == "C1"
    assert len(found["camera"]["report"]["ghosts"]) == 15
    assert (found["undo"], found["redo"]) == ("A3 in C1", "")


def test_what_was_clicked_is_there_after_the_page_is_loaded_again(desk: Desk, maintainer: Caller) -> None:
    click(maintainer, "A1", (10.5, 20))
    found = maintainer.get(f"{AT}ground/").json()
    assert found["cameras"][0]["clicks"] == {"A1": [10.5, 20.0]}
    assert [point["name"] for point in found["points"]][:2] == ["A1", "B1"]


def test_undo_and_redo_over_rest(desk: Desk, maintainer: Caller) -> None:
    click(maintainer, "A1", (10.5, 20))
    assert maintainer.post(f"{AT}undo/").json() == {"undo": "grid of 5 × 3 points", "redo": "A1 in C1"}
    assert maintainer.get(f"{AT}ground/").json()["cameras"][0]["clicks"] == {}
    maintainer.post(f"{AT}redo/")
    assert maintainer.get(f"{AT}ground/").json()["cameras"][0]["clicks"] == {"A1": [10.5, 20.0]}


@pytest.mark.parametrize(
    "body",
    [{}, {"x": 1}, {"x": "left", "y": 1}, {"x": 1e30, "y": 1}, {"x": 5000, "y": 5}, {"x": -9, "y": 5}],
)
def test_a_click_that_is_none_is_refused_with_reasons(desk: Desk, maintainer: Caller, body: Any) -> None:
    answer = maintainer.put(f"{AT}cameras/C1/clicks/A1/", body)
    assert answer.status_code == 400 and answer.json()["details"]
    assert maintainer.get(f"{AT}ground/").json()["cameras"][0]["clicks"] == {}


def test_a_reviewer_sees_no_desk_and_a_stranger_is_asked_to_sign_in(desk: Desk, stranger: Caller) -> None:
    reviewer = Caller(user=somebody("vera", Role.REVIEWER, desk.dataset))
    assert reviewer.get(AT).status_code == 403
    assert click(reviewer, "A1", (1, 1)).status_code == 403
    assert stranger.get(AT).status_code == 401


def test_a_desk_without_a_dataset_takes_the_role_for_all_datasets(desk: Desk, maintainer: Caller) -> None:
    everywhere = Caller(user=somebody("max", Role.MAINTAINER))
    body = {"slug": "new-square", "cameras": ["C1", "C2"]}
    assert maintainer.post(DESKS, body).status_code == 400
    assert everywhere.post(DESKS, body).status_code == 201
    assert maintainer.get(f"{DESKS}new-square/").status_code == 404
    assert maintainer.put(f"{DESKS}new-square/cameras/C1/clicks/A/", {"x": 1, "y": 1}).status_code == 404
    assert everywhere.get(f"{DESKS}new-square/").json()["next_step"] == "Find the lens of C1."
    assert [each["slug"] for each in maintainer.get(DESKS).json()["results"]] == ["plaza"]
    assert {each["slug"] for each in everywhere.get(DESKS).json()["results"]} == {"plaza", "new-square"}


def test_a_desk_for_a_dataset_of_others_is_refused(dataset: Dataset, stranger: Caller) -> None:
    other = Caller(user=somebody("olga", Role.MAINTAINER, Dataset.objects.create(slug="mine", name="Mine")))
    assert other.post(DESKS, {"slug": "x", "dataset": dataset.slug}).status_code == 400
    assert not Desk.objects.exists()


def test_a_token_needs_the_scope(desk: Desk) -> None:
    assert click(bearer("read"), "A1", (1, 1)).status_code == 403
    assert click(bearer("read", "import"), "A1", (1, 1)).status_code == 200


def test_points_come_as_a_file_with_its_unit_and_a_broken_one_says_where(
    desk: Desk, maintainer: Caller
) -> None:
    def send(content: bytes) -> Any:
        form = {"file": SimpleUploadedFile("p.csv", content), "unit": "cm"}
        return maintainer.client.post(f"{AT}points/file/", form)

    assert "line 2" in str(send(b"name,x,y\nP1,zero,0\n").json()["details"])
    found = send(b"name,x,y\nP1,0,0\nP2,250,0\nP3,250,400\nP4,0,400\n").json()
    assert [(each["name"], each["x"]) for each in found["points"]][:2] == [("P1", 0.0), ("P2", 2.5)]


def test_a_lens_is_put_there_by_its_numbers(desk: Desk, maintainer: Caller) -> None:
    matrix = [[1100, 0, 960], [0, 1100, 540], [0, 0, 1]]
    body = {
        "width": 1920,
        "height": 1080,
        "matrix": matrix,
        "distortion": [0.1, 0, 0, 0, 0],
        "source": "bench",
    }
    assert maintainer.put(f"{AT}cameras/C1/lens/", body).json()["lens"]["source"] == "bench"
    wrong = maintainer.put(f"{AT}cameras/C1/lens/", {**body, "distortion": [1, 2, 3]})
    assert wrong.status_code == 400 and "3 numbers" in str(wrong.json()["details"])
    assert DeskCamera.objects.get(name="C1").lens["source"] == "bench"
    again = maintainer.post(f"{AT}cameras/C1/lens/in-place/").json()
    assert again["lens"]["matrix"][0][0] == 1000


def test_a_picture_of_the_ground_is_served_to_who_may_see_the_desk_only(
    db: None, settings: Any, tmp_path: Path
) -> None:
    settings.MEDIA_ROOT, settings.DATA_DIR = tmp_path / "media", tmp_path
    everywhere = Caller(user=somebody("max", Role.MAINTAINER))
    desks.make("yard", cameras=["C1"], user=User.objects.get())
    stream = io.BytesIO()
    Picture.new("RGB", (640, 360), (90, 120, 90)).save(stream, "PNG")
    form = {"file": SimpleUploadedFile("yard.png", stream.getvalue())}
    found = everywhere.client.post(f"{DESKS}yard/cameras/C1/picture/", form).json()["camera"]
    assert (found["width"], found["height"]) == (640, 360)
    address = f"{DESKS}yard/pictures/{found['full']}.jpg"
    assert everywhere.get(address)["Content-Type"] == "image/jpeg"
    other = Caller(user=somebody("olga", Role.MAINTAINER, Dataset.objects.create(slug="mine", name="Mine")))
    assert other.get(address).status_code == 404
    broken = {"file": SimpleUploadedFile("yard.png", stream.getvalue()[:200])}
    refused = everywhere.client.post(f"{DESKS}yard/cameras/C1/picture/", broken)
    assert refused.status_code == 400 and DeskCamera.objects.get().full_digest == found["full"]
