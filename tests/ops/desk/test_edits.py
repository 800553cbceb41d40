"""Every step of the hand at a desk is there at once, is taken back, and is done again."""

from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User

from gtm_hit.models import Click, Desk, DeskEdit, MeasuredPoint
from gtm_hit.ops.desk import clicks, edits, ground, lenses, points
from gtm_hit.ops.desk.errors import DeskError, NotThere
from tests.desk_scene import click, make_desk, seen

pytestmark = pytest.mark.django_db


@pytest.fixture
def desk() -> Desk:
    return make_desk()


def state(desk: Desk) -> Any:
    """All that steps change."""
    return (
        list(MeasuredPoint.objects.values_list("number", "name", "x", "y", "z")),
        list(Click.objects.values_list("camera__name", "point__name", "x", "y")),
        list(desk.cameras.values_list("lens", "pose", "pose_report", "full_digest")),
    )


def test_after_four_clicks_the_camera_stands_and_the_other_points_are_expected(desk: Desk) -> None:
    click(desk, "A1 E1 E3")
    camera = desk.cameras.get(name="C1")
    assert camera.pose is None and "at least 4 pairs" in camera.pose_report["problem"]
    click(desk, "A3")
    camera.refresh_from_db()
    assert camera.pose_report["problem"] == ""
    ghosts = {each["name"]: (each["x"], each["y"]) for each in camera.pose_report["ghosts"]}
    assert ghosts["C2"] == pytest.approx(seen(desk)["C2"], abs=1.0)


def test_undoing_everything_and_doing_it_again_gives_the_same_to_the_last_bit(desk: Desk) -> None:
    states = [state(desk)]
    for name in ["A1", "E1", "E3", "A3", "C2"]:
        click(desk, name)
        states.append(state(desk))
    for before in reversed(states[:-1]):
        assert edits.undo(desk, edits.GROUND) is not None
        assert state(desk) == before
    for after in states[1:]:
        assert edits.redo(desk, edits.GROUND) is not None
        assert state(desk) == after
    assert edits.redo(desk, edits.GROUND) is None


def test_a_new_step_ends_what_could_be_done_again(desk: Desk) -> None:
    click(desk, "A1 B1")
    edits.undo(desk, edits.GROUND)
    click(desk, "C1")
    assert edits.steps(desk, edits.GROUND) == edits.Steps("C1 in C1", "")
    assert edits.redo(desk, edits.GROUND) is None
    edits.undo(desk, edits.GROUND)
    edits.redo(desk, edits.GROUND)
    assert set(Click.objects.values_list("point__name", flat=True)) == {"A1", "C1"}


def test_clicking_the_same_place_again_is_no_step(desk: Desk) -> None:
    click(desk, "A1")
    count = DeskEdit.objects.count()
    assert clicks.put(desk, "C1", "A1", *seen(desk)["A1"]) is None
    assert DeskEdit.objects.count() == count


def test_other_points_take_the_clicks_of_the_old_ones_along_and_undoing_brings_them_back(desk: Desk) -> None:
    click(desk, "A1 E1 E3 A3 C2")
    before = state(desk)
    ground.put_grid(desk, 2, 2, (6.0, 4.0), (-3.0, -2.0))
    assert set(Click.objects.values_list("point__name", flat=True)) == {"A1"}
    assert desk.cameras.get(name="C1").pose is None
    edits.undo(desk, edits.GROUND)
    assert state(desk) == before


def test_a_corrected_coordinate_moves_the_camera(desk: Desk) -> None:
    click(desk, "A1 E1 E3 A3")
    before = desk.cameras.get(name="C1").pose
    points.put(desk, "A1", -3.5, -2.0)
    assert desk.cameras.get(name="C1").pose != before
    edits.undo(desk, edits.GROUND)
    assert desk.cameras.get(name="C1").pose == before


def test_pages_are_undone_apart(desk: Desk) -> None:
    click(desk, "A1 E1 E3 A3")
    lens = desk.cameras.get(name="C1").lens
    lenses.put(desk, "C1", (1920, 1080), [[900, 0, 960], [0, 900, 540], [0, 0, 1]], [0.0] * 5, "a guess")
    posed = desk.cameras.get(name="C1").pose
    click(desk, "C2")
    edits.undo(desk, edits.lens_page("C1"))
    camera = desk.cameras.get(name="C1")
    assert camera.lens == lens and camera.pose != posed and camera.clicks.count() == 5


def test_the_steps_say_who_did_them(desk: Desk) -> None:
    clicks.put(desk, "C1", "A1", 1.0, 2.0, User.objects.create_user("ada"))
    last = desk.edits.last()
    assert last is not None and (str(last.author), last.what) == ("ada", "A1 in C1")


@pytest.mark.parametrize("place", [(-5.0, 10.0), (2000.0, 10.0), (10.0, 1080.0), (float("nan"), 1.0)])
def test_a_click_outside_the_picture_is_refused_and_changes_nothing(
    desk: Desk, place: tuple[float, float]
) -> None:
    before = state(desk)
    with pytest.raises(DeskError):
        clicks.put(desk, "C1", "A1", *place)
    assert state(desk) == before


def test_a_click_of_what_is_not_there_is_refused(desk: Desk) -> None:
    for camera, point in (("C9", "A1"), ("C1", "Z9")):
        with pytest.raises(NotThere):
            clicks.put(desk, camera, point, 1.0, 1.0)


def test_a_lens_for_pictures_of_another_size_is_refused(desk: Desk) -> None:
    before = state(desk)
    with pytest.raises(DeskError, match="1280×720"):
        lenses.put(desk, "C1", (1280, 720), [[900, 0, 640], [0, 900, 360], [0, 0, 1]], [0.0] * 5, "x")
    assert state(desk) == before


def test_the_same_steps_give_the_same_bytes() -> None:
    first = make_desk()
    assert first.dataset is not None
    second = make_desk(first.dataset, slug="again")
    for desk, order in ((first, "A1 E1 E3 A3 C2"), (second, "C2 A3 E3 E1 A1")):
        click(desk, order)
    one, other = (desk.cameras.get(name="C1") for desk in (first, second))
    assert (one.pose, one.pose_report) == (other.pose, other.pose_report)
