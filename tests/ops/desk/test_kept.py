"""Points kept with their clicks: what is refused, what undoing brings back, what they tell."""

from __future__ import annotations

import math
from typing import Any

import pytest

from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Desk, KeptPoint
from gtm_hit.ops.desk import checks, desks, edits, kept
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.ops.desk.kept import SeenAt
from gtm_hit.ops.desk.overview import Verdict
from tests.check_scene import BENCH, LAMP, Place, beside, calibrated_desk, true_clicks
from tests.desk_scene import click, make_desk, seen

pytestmark = pytest.mark.django_db

C1, C3 = true_clicks(LAMP, "C1", "C3")


@pytest.fixture
def desk() -> Desk:
    return calibrated_desk()


def there(desk: Desk) -> list[tuple[str, str, list[SeenAt]]]:
    return [(row.name, row.use, kept.clicks_of(row)) for row in kept.all_kept(desk)]


def test_points_get_the_next_free_name_and_are_listed_as_one_counts(desk: Desk) -> None:
    kept.keep(desk, [C1, C3], "test", "P2")
    names = [kept.keep(desk, [C1, C3], "test").name for _ in range(10)]
    assert names[:2] == ["P3", "P4"] and len(set(names)) == 10
    assert [name for name, *_ in there(desk)] == ["P2", *names]


@pytest.mark.parametrize(
    ("clicks", "name", "use", "reason"),
    [
        ([C1, SeenAt("C9", 1, 1)], "", "test", "no camera C9; there are: C1, C2"),
        ([C1, SeenAt("C3", math.nan, 1)], "", "test", "two finite numbers"),
        ([C1, SeenAt("C3", 1920, 1)], "", "test", "outside the picture of C3"),
        ([C1, C3, beside(C3, 5)], "", "test", "twice in C3"),
        ([C1], "", "test", "one view only"),
        ([C1, C3], "taken", "test", "a kept point taken already"),
        ([C1, C3], "a,b", "test", "none of them a slash, a comma"),
        ([C1, C3], "", "measured", "correspondence or as test"),
    ],
)
def test_what_cannot_be_kept_is_refused_with_a_sentence(
    desk: Desk, clicks: list[SeenAt], name: str, use: str, reason: str
) -> None:
    kept.keep(desk, [C1, C3], "test", "taken")
    before = there(desk)
    with pytest.raises(DeskError, match=reason):
        kept.keep(desk, clicks, use, name)
    assert there(desk) == before


def test_every_change_of_a_kept_point_is_one_step_back(desk: Desk) -> None:
    states: list[Any] = [there(desk)]

    def done() -> None:
        states.append(there(desk))

    kept.keep(desk, true_clicks(LAMP, "C1", "C3", "C7"), "test", "lamp"), done()
    kept.change(desk, "lamp", use="correspondence"), done()
    kept.change(desk, "lamp", "lantern"), done()
    kept.put_click(desk, "lantern", beside(C1, 3)), done()
    kept.remove_click(desk, "lantern", "C7"), done()
    kept.remove(desk, "lantern"), done()
    for state in states[-2::-1]:
        assert edits.undo(desk, kept.PAGE)
        assert there(desk) == state
    for state in states[1:]:
        assert edits.redo(desk, kept.PAGE)
        assert there(desk) == state


def test_a_kept_point_never_has_fewer_than_two_clicks(desk: Desk) -> None:
    kept.keep(desk, [C1, C3], "test", "lamp")
    with pytest.raises(DeskError, match="Remove the point as a whole"):
        kept.remove_click(desk, "lamp", "C1")
    assert len(kept.clicks_of(kept.kept_of(desk, "lamp"))) == 2
    with pytest.raises(NotThere):
        kept.remove(desk, "post")


def test_a_file_of_clicks_is_kept_in_one_step_and_comes_out_as_it_went_in(desk: Desk) -> None:
    lines = ["lamp,C1,749,302", "lamp,C3,808.25,211", "bench,C1,858,293,test", "bench,C7,907,264,test"]
    data = "\n".join(["thing,camera,x,y", *lines]).encode()
    assert kept.put_file(desk, data, "clicks.csv", "correspondence") == 2
    assert {name: use for name, use, _ in there(desk)} == {"lamp": "correspondence", "bench": "test"}
    out, before = kept.as_csv(desk), there(desk)
    edits.undo(desk, kept.PAGE)
    assert there(desk) == []
    kept.put_file(desk, out, "kept.csv", "test")
    assert there(desk) == before


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("post,C1,1,1", "one view only"),
        ("post,C1,1,one", "line 4"),
        ("lamp,C1,1,1", "already"),
        ("lamp,C7,1,1,test", "test point and a correspondence"),
        ("lamp,C7,1,1,both", "use is 'both'"),
    ],
)
def test_a_file_with_one_wrong_line_keeps_nothing(desk: Desk, line: str, reason: str) -> None:
    data = f"thing,camera,x,y\nlamp,C1,749,302,correspondence\nlamp,C3,808,211\n{line}\n".encode()
    with pytest.raises((DeskError, FormatError), match=reason):
        kept.put_file(desk, data, "clicks.csv", "correspondence")
    assert there(desk) == []


def test_a_true_point_is_found_to_the_millimetre_and_a_false_click_is_told(desk: Desk) -> None:
    clicks = true_clicks(LAMP)
    kept.keep(desk, clicks, "test", "right")
    kept.keep(desk, [*clicks[:-1], beside(clicks[-1], 30)], "correspondence", "wrong")
    right, wrong = checks.whole(desk)["kept"]
    assert right["place"] == pytest.approx(LAMP, abs=1e-3)
    assert max(each["residual"] for each in right["clicks"]) < 0.01
    assert [each["camera"] for each in wrong["clicks"] if each["doubtful"]] == [clicks[-1].camera]
    summaries = checks.whole(desk)["summaries"]
    assert summaries["test"]["off"] == 0 and summaries["correspondence"]["off"] == 1
    assert summaries["test"]["clicks"] == 7


def test_a_click_in_a_camera_without_a_pose_tells_nothing_and_is_kept(desk: Desk) -> None:
    kept.keep(desk, true_clicks(LAMP, "C1", "C3"), "test", "lamp")
    desk.cameras.filter(name="C3").update(pose=None)
    (found,) = checks.whole(desk)["kept"]
    assert found["place"] is None and found["reason"].startswith("clicked in fewer than two views")
    assert len(found["clicks"]) == 2
    (lack,) = [each["lacks"] for each in checks.whole(desk)["cameras"] if each["lacks"]]
    assert lack == {"page": "ground", "words": "No point clicked yet."}


def places(count: int) -> list[Place]:
    return [(2.0 + 0.3 * number, 4.0 + 0.4 * number, 0.2 * number) for number in range(count)]


def test_the_verdict_is_that_of_the_test_points_alone(desk: Desk) -> None:
    assert checks.step(desk).words == "No point checked yet."
    lies = [beside(each, 60 * (-1) ** number) for number, each in enumerate(true_clicks(BENCH))]
    kept.keep(desk, lies, "correspondence", "lies")
    assert checks.step(desk).verdict is Verdict.MISSING
    for place in places(4):
        kept.keep(desk, true_clicks(place), "test")
    assert checks.step(desk).verdict is Verdict.USABLE and "5 or more" in checks.step(desk).words
    kept.keep(desk, true_clicks(BENCH), "test")
    assert checks.step(desk).verdict is Verdict.GOOD
    kept.change(desk, "lies", use="test")
    for number in range(5):
        kept.keep(desk, lies, "test", f"L{number}")
    assert checks.step(desk).verdict is Verdict.DO_NOT_USE


def test_keeping_points_moves_no_camera() -> None:
    desk = make_desk()
    click(desk, " ".join(seen(desk)))
    before = desk.cameras.get(name="C1").pose
    places = [SeenAt("C1", 10.0, 10.0), SeenAt("C2", 10.0, 10.0)]
    for use in KeptPoint.Use.values:
        kept.keep(desk, places, use)
    assert desk.cameras.get(name="C1").pose == before is not None


def test_the_calibration_in_place_is_checked_where_the_desk_has_none_yet() -> None:
    desk = make_desk()
    assert checks.cameras_of(desk) == {}
    assert list(checks.cameras_of(desk, checks.Against.IN_PLACE)) == ["C1", "C2"]


def test_a_camera_that_a_kept_point_is_clicked_in_stays_and_a_point_of_its_name_holds_no_camera() -> None:
    desk = calibrated_desk()
    kept.keep(desk, [C1, C3], "test", "C2")
    with pytest.raises(DeskError, match="Work has been done for C3"):
        desks.remove_camera(desk, "C3")
    desks.remove_camera(desk, "C2")
    assert not desk.cameras.filter(name="C2").exists()
