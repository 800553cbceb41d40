"""Kept points over REST: kept, changed, read with figures, refused in words."""

from __future__ import annotations

from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from gtm_hit.models import Desk
from gtm_hit.ops.access.roles import Role
from tests.access.scene import somebody
from tests.api.conftest import Caller
from tests.check_scene import LAMP, calibrated_desk, true_clicks

AT = "/api/v1/calibration-desks/plaza/"
CLICKS = [{"camera": each.camera, "x": each.x, "y": each.y} for each in true_clicks(LAMP, "C1", "C3", "C7")]


@pytest.fixture
def desk(db: None) -> Desk:
    return calibrated_desk()


@pytest.fixture
def maintainer(desk: Desk) -> Caller:
    return Caller(user=somebody("mia", Role.MAINTAINER))


def keep(caller: Caller, **values: Any) -> Any:
    return caller.post(f"{AT}kept/", {"use": "test", "clicks": CLICKS, **values})


def test_a_kept_point_answers_with_where_it_is_and_can_be_undone(maintainer: Caller) -> None:
    answer = keep(maintainer)
    assert answer.status_code == 201
    found = answer.json()
    assert found["point"]["place"] == pytest.approx(LAMP, abs=1e-3)
    assert (found["was"], found["point"]["name"], found["undo"]) == ("", "P1", "point P1 kept")
    assert maintainer.post(f"{AT}undo/", {"page": "check"}).json()["redo"] == "point P1 kept"
    assert maintainer.get(f"{AT}check/").json()["kept"] == []


def test_name_use_and_clicks_are_changed_one_by_one(maintainer: Caller) -> None:
    keep(maintainer)
    changed = maintainer.client.patch(
        f"{AT}kept/named/P1/", {"name": "lamp", "use": "correspondence"}, content_type="application/json"
    ).json()
    assert (changed["was"], changed["point"]["name"], changed["point"]["use"]) == (
        "P1",
        "lamp",
        "correspondence",
    )
    moved = maintainer.put(f"{AT}kept/named/lamp/clicks/C7/", {"x": 700, "y": 300}).json()
    assert [each["camera"] for each in moved["point"]["clicks"] if each["doubtful"]] == ["C7"]
    left = maintainer.client.delete(f"{AT}kept/named/lamp/clicks/C7/").json()
    assert [each["camera"] for each in left["point"]["clicks"]] == ["C1", "C3"]
    refused = maintainer.client.delete(f"{AT}kept/named/lamp/clicks/C1/")
    assert refused.status_code == 400 and "two views" in refused.json()["details"][0]["reason"]
    assert maintainer.client.delete(f"{AT}kept/named/lamp/").json()["point"] is None
    assert maintainer.get(f"{AT}kept/").json()["kept"] == []


@pytest.mark.parametrize(
    "values",
    [
        {"clicks": CLICKS[:1]},
        {"clicks": [CLICKS[0], CLICKS[0]]},
        {"clicks": [CLICKS[0], {"camera": "C9", "x": 1, "y": 1}]},
        {"clicks": [CLICKS[0], {"camera": "C3", "x": -9, "y": 1}]},
        {"clicks": [CLICKS[0], {"camera": "C3", "x": "NaN", "y": 1}]},
        {"clicks": "two"},
        {"use": "both"},
        {"name": "a/b"},
    ],
)
def test_what_cannot_be_kept_is_refused_with_reasons(maintainer: Caller, values: dict[str, Any]) -> None:
    answer = keep(maintainer, **values)
    assert answer.status_code == 400 and answer.json()["details"]
    assert maintainer.get(f"{AT}kept/").json()["kept"] == []


def test_the_desk_tells_what_its_test_points_say(maintainer: Caller) -> None:
    assert maintainer.get(AT).json()["check"] == {"verdict": "missing", "words": "No point checked yet."}
    keep(maintainer)
    assert maintainer.get(AT).json()["check"]["words"].startswith("1 test point: median 0.0 px")
    assert maintainer.get(f"{AT}check/").json()["summaries"]["test"]["clicks"] == 3
    assert maintainer.get(f"{AT}check/?against=elsewhere").status_code == 400


def test_a_file_goes_in_and_out(maintainer: Caller) -> None:
    lines = [f"lamp,{each['camera']},{each['x']},{each['y']}" for each in CLICKS]
    file = SimpleUploadedFile("clicks.csv", "\n".join(lines).encode())
    answer = maintainer.client.post(f"{AT}kept/file/", {"file": file, "use": "correspondence"})
    assert answer.status_code == 200
    assert [(each["name"], each["use"]) for each in answer.json()["kept"]] == [("lamp", "correspondence")]
    out = maintainer.get(f"{AT}kept.csv").content.decode().splitlines()
    assert out[0] == "thing,camera,x,y,use" and len(out) == 4
