"""Points and clicks out of files, and what is said about them."""

from __future__ import annotations

import json

import pytest

from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Desk
from gtm_hit.ops.desk import desks, edits, ground, overview
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.overview import Verdict
from tests.desk_scene import click, make_desk, seen
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db


@pytest.fixture
def desk() -> Desk:
    return make_desk()


def test_points_of_a_file_in_centimetres_are_kept_in_metres(desk: Desk) -> None:
    ground.put_file(desk, b"name,x,y\nA1,0,0\nB1,259,0\nC1,0,207\nD1,259,207\n", "points.csv", "cm")
    assert list(desk.points.values_list("name", "x", "y", "z"))[1] == ("B1", 2.59, 0.0, 0.0)


def test_a_broken_file_changes_nothing(desk: Desk) -> None:
    before = ground.whole(desk)
    with pytest.raises(FormatError, match="line 3"):
        ground.put_file(desk, b"name,x,y\nA1,0,0\nA1,1,nonsense\n", "points.csv", "m")
    assert ground.whole(desk) == before


def test_clicks_of_a_file_give_the_pose_at_once_and_go_in_one_step(desk: Desk) -> None:
    pairs = [{"name": name, "pixel": list(place)} for name, place in seen(desk).items()]
    assert ground.put_pairs(desk, "C1", json.dumps({"pairs": pairs}).encode(), "clicks.json") == 15
    assert desk.cameras.get(name="C1").pose_report["rms"] < 0.5
    edits.undo(desk, edits.GROUND)
    assert desk.cameras.get(name="C1").pose is None


def test_clicks_bring_the_points_along_that_the_desk_lacks() -> None:
    bare = desks.make("bare", dataset=make_dataset())
    pairs = [
        {"name": "P", "point": [0, 0, 0], "pixel": [5, 5]},
        {"name": "Q", "point": [100, 0, 0], "pixel": [9, 5]},
    ]
    ground.put_pairs(bare, "C1", json.dumps({"unit": "cm", "pairs": pairs}).encode(), "clicks.json")
    assert list(bare.points.values_list("name", "x")) == [("P", 0.0), ("Q", 1.0)]


def test_clicks_that_place_a_known_point_elsewhere_are_refused(desk: Desk) -> None:
    before = ground.whole(desk)
    pairs = [{"name": "A1", "point": [7, 7, 0], "pixel": [5, 5]}]
    with pytest.raises((DeskError, FormatError)):
        ground.put_pairs(desk, "C1", json.dumps({"unit": "m", "pairs": pairs}).encode(), "clicks.json")
    assert ground.whole(desk) == before


def test_swapped_clicks_are_named(desk: Desk) -> None:
    places = seen(desk)
    places["A1"], places["E3"] = places["E3"], places["A1"]
    pairs = [{"name": name, "pixel": list(place)} for name, place in places.items()]
    ground.put_pairs(desk, "C1", json.dumps({"pairs": pairs}).encode(), "clicks.json")
    found = desk.cameras.get(name="C1").pose_report["findings"]
    assert found[0]["text"] == "Pairs A1 and E3 look swapped."
    step = overview.overview(desk).cameras[0].ground
    assert step.verdict is Verdict.USABLE and "A1 and E3 look swapped" in step.words


def test_the_overview_names_one_next_step_after_the_other() -> None:
    empty = desks.make("nothing")
    assert overview.overview(empty).next_step.words == "Add the cameras."
    desks.add_camera(empty, "C1")
    assert overview.overview(empty).next_step.words == "Find the lens of C1."
    desk = make_desk()
    assert overview.overview(desk).next_step.words == "Click points in C1."
    click(desk, " ".join(seen(desk)))
    assert overview.overview(desk).cameras[0].ground.verdict is Verdict.GOOD
    assert overview.overview(desk).next_step.words == "Click points in C2."
    click(desk, " ".join(seen(desk, "C2")), "C2")
    assert overview.overview(desk).next_step.words == "Put the calibration in place."


def test_a_desk_without_a_dataset_gets_cameras_of_ones_own_and_a_name_once() -> None:
    desk = desks.make("square-2", cameras=["C1", "C2"])
    with pytest.raises(DeskError, match="already"):
        desks.make("square-2")
    with pytest.raises(DeskError, match="already"):
        desks.add_camera(desk, "C1")
    with pytest.raises(DeskError):
        desks.add_camera(desk, "../C3")
    desks.remove_camera(desk, "C1")
    assert list(desk.cameras.values_list("index", "name")) == [(0, "C2")]


def test_a_camera_that_work_was_done_for_stays(desk: Desk) -> None:
    with pytest.raises(DeskError):
        desks.remove_camera(desk, "C1")
    assert desk.cameras.count() == 2
