from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gtm_hit.geometry.cylinder import Cylinder, rectangles
from gtm_hit.models import Dataset, Layer
from tests.api.conftest import Caller

PATH = "/api/v1/assignment/rectangles/"
MIDDLE = 200 * 400 + 200


@pytest.fixture(autouse=True)
def tables(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


def person(position: Any = MIDDLE, height: Any = None, radius: Any = None) -> dict[str, Any]:
    return {"position": position, "height": height, "radius": radius}


def test_boxes_are_those_of_the_rule_by_person_and_camera(alice: Caller, dataset: Dataset) -> None:
    people = [person(height=2.1), person(), person(0, radius=0.3)]
    found = alice.post(PATH, {"people": people}).json()["rectangles"]
    for one, row in zip(people, found, strict=True):
        size = Cylinder(one["radius"] or 0.16, one["height"] or 1.8)
        for camera, box in zip(dataset.calibrated_cameras(), row, strict=True):
            boxes, visible = rectangles(camera, dataset.grid, size, dataset.rule, [one["position"]])
            assert box == (boxes[0].tolist() if visible[0] else None)
    assert found[0] != found[1]


def test_staff_ask_by_layer(staff: Caller, layer: Layer) -> None:
    response = staff.post(f"/api/v1/layers/{layer.pk}/rectangles/", {"people": [person()]})
    assert (response.status_code, len(response.json()["rectangles"])) == (200, 1)


@pytest.mark.parametrize(
    "people", [[person(-1)], [person(400 * 400)], [person(height=99)], [person(radius="x")], "all", None]
)
def test_people_who_cannot_be_are_refused(alice: Caller, people: Any) -> None:
    response = alice.post(PATH, {"people": people})
    assert (response.status_code, response.json()["code"]) == (400, "invalid")


def test_nobody_has_no_boxes(alice: Caller) -> None:
    assert alice.post(PATH, {"people": []}).json() == {"rectangles": []}


def test_strangers_ask_in_vain(stranger: Caller, alice: Caller) -> None:
    assert stranger.post(PATH, {"people": []}).status_code == 401
