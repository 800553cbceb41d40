"""Adjusting a desk: what goes in, what comes out, what a person makes of it."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from gtm_hit.calibration.adjustment import adjusting
from gtm_hit.models import Desk, DeskAdjustment, Job, KeptClick, KeptPoint
from gtm_hit.ops.desk import (
    adjust_decisions,
    adjust_inputs,
    adjust_job,
    adjust_results,
    adjust_solving,
    adjust_view,
    clicks,
    edits,
    kept,
    overview,
    placing,
    poses,
)
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.adjust_scene import keep_points, misplaced, noisy_desk

pytestmark = pytest.mark.django_db


@pytest.fixture
def desk() -> Desk:
    return noisy_desk()


def adjusted(desk: Desk, choices: Choices | None = None) -> DeskAdjustment:
    return adjust_solving.solve(desk, choices or Choices())


def worst_of(desk: Desk) -> adjust_view.WorstClick:
    return adjust_view.worst(desk, adjust_results.result_of(desk))[0]


def test_a_result_that_is_used_brings_the_cameras_nearer_to_the_truth(desk: Desk) -> None:
    before = misplaced(desk)
    found = adjusted(desk)
    assert misplaced(desk) == before, "nothing moves before somebody says so"
    adjust_results.use(desk, found.number)
    assert misplaced(desk) < 0.6 * before
    assert placing.report(desk)["adjust"]["number"] == found.number
    assert overview.overview(desk).adjust.verdict is overview.Verdict.GOOD


def test_the_report_has_before_and_after_of_every_camera_and_the_worst_clicks_by_name(desk: Desk) -> None:
    told = adjust_view.result(desk, adjusted(desk))
    assert [each["name"] for each in told["report"]["cameras"]] == ["C1", "C3", "C4", "C5"]
    for each in told["report"]["cameras"]:
        assert each["after"]["median"] < each["before"]["median"]
        assert each["shared"] and each["folding"]["monotone"] in {True, False}
    assert len(told["worst"]) == 20
    assert {each["source"] for each in told["worst"]} <= {"ground", "kept"}
    json.dumps(told, allow_nan=False)


def test_a_camera_that_hangs_on_nothing_is_refused_by_its_name(desk: Desk) -> None:
    KeptClick.objects.filter(camera__name="C5").delete()
    row = desk.cameras.get(name="C5")
    for click in list(row.clicks.all())[2:]:
        click.delete()  # the pose stays: as if the points had been dropped, not undone
    with pytest.raises(DeskError, match="C5 is not connected"):
        adjust_job.start(desk, Choices())
    assert not Job.objects.exists() and not DeskAdjustment.objects.exists()
    assert "C5 is not connected" in adjust_view.whole(desk)["problem"]


def test_a_camera_without_a_lens_or_a_place_is_refused_by_its_name(desk: Desk) -> None:
    desk.cameras.filter(name="C3").update(lens=None, pose=None)
    desk.cameras.filter(name="C4").update(pose=None)
    with pytest.raises(DeskError, match=r"No lens yet: C3\..*in: C4\."):
        adjusted(desk)


def test_too_few_shared_points_are_nothing_to_adjust_and_the_desk_may_go_on() -> None:
    desk = noisy_desk(points=5)
    with pytest.raises(DeskError, match="5 points are seen by two cameras or more, 6 are the least"):
        adjust_job.start(desk, Choices())
    found = overview.overview(desk)
    assert "fewer than 6 shared points" in found.adjust.words
    assert found.next_step.page is overview.Page.PLACE


def test_a_point_to_test_with_is_given_to_no_solve(desk: Desk) -> None:
    before = adjust_inputs.gather(desk, Choices())
    keep_points(desk, 10, np.random.default_rng(1), KeptPoint.Use.TEST, "T")
    after = adjust_inputs.gather(desk, Choices())
    assert after.digest == before.digest
    assert not any(name.startswith("T") for _source, name in after.free)
    kept.change(desk, "P1", use="test")
    without = adjust_inputs.gather(desk, Choices())
    assert ("kept", "P1") not in without.free and len(without.free) == len(before.free) - 1


def test_the_same_clicks_and_choices_find_the_same_result(desk: Desk) -> None:
    assert adjusted(desk).pk == adjusted(desk).pk
    adjust_results.use(desk)
    assert adjusted(desk).number == 1, "using it changes nothing that an adjustment begins with"
    assert adjusted(desk, Choices(variant="fixed")).number == 2


def test_what_is_held_does_not_move(desk: Desk) -> None:
    began = poses.from_ground(desk.cameras.get(name="C1"))
    cameras = adjusted(desk, Choices(hold=("C1:pose", "C3:lens"))).cameras
    assert cameras is not None and began is not None
    assert cameras["C1"]["pose"]["rvec"] == began.rvec.tolist()
    assert cameras["C3"]["lens"]["matrix"] == desk.cameras.get(name="C3").lens["matrix"]


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"variant": "magic"}, "no variant magic"),
        ({"turn": 0.0}, "above 0"),
        ({"ground_weight": float("nan")}, "above 0"),
        ({"ground_sigma": -1.0}, "0 to 10 metres"),
        ({"hold": ("C9:pose",)}, "C1, C3, C4, C5"),
        ({"hold": ("C1:nose",)}, "no parameter nose"),
    ],
)
def test_choices_that_make_no_sense_are_refused(desk: Desk, values: dict[str, Any], told: str) -> None:
    with pytest.raises(DeskError, match=told):
        adjust_job.start(desk, Choices(**values))


def test_a_job_that_was_killed_is_finished_by_another_worker_with_the_same_numbers(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = noisy_desk("other")
    straight = adjusted(other)
    monkeypatch.setattr(adjust_solving, "SECONDS_BETWEEN_STATES", 0.0)
    job = adjust_job.start(desk, Choices())
    told: list[str] = []

    class KilledError(BaseException):
        """What no operation catches."""

    def killed(self: queue.Run, done: int, total: int, message: str = "") -> None:
        told.append(message)
        if len(told) == 6:
            raise KilledError

    monkeypatch.setattr(queue.Run, "report", killed)
    with pytest.raises(KilledError):
        queue.run(job.pk, OPERATIONS)
    half = DeskAdjustment.objects.get(desk=desk)
    assert half.state["steps"] == 5 and half.report is None
    Job.objects.filter(pk=job.pk).update(state=Job.State.QUEUED)
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    assert job.state == Job.State.DONE, job.message
    assert "cost" in told[0] and len(told) == straight.report["steps"] + 1
    found = DeskAdjustment.objects.get(desk=desk)
    for name in ("lens", "pose"):
        for camera, value in straight.cameras.items():
            assert found.cameras[camera][name] == value[name]


def test_a_stopped_job_goes_on_from_there_when_it_is_asked_for_again(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(adjust_solving, "SECONDS_BETWEEN_STATES", 0.0)
    began: list[int] = []
    real = adjusting.adjust

    def watched(*args: Any) -> Any:
        began.append(args[5].steps if args[5] else 0)
        if len(began) == 8:
            raise queue.JobCancelled("stopped")
        return real(*args)

    monkeypatch.setattr(adjust_solving, "adjust", watched)
    job = adjust_job.start(desk, Choices())
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    assert job.state == Job.State.CANCELLED
    again = adjust_job.start(desk, Choices())
    queue.run(again.pk, OPERATIONS)
    assert again.pk != job.pk and began[8] == began[7] > 0
    assert adjust_results.result_of(desk).number == 1


def test_going_back_and_undoing_let_the_cameras_stand_as_before(desk: Desk) -> None:
    before = misplaced(desk)
    adjusted(desk)
    adjust_results.use(desk)
    used = misplaced(desk)
    edits.undo(desk, adjust_results.PAGE)
    assert misplaced(desk) == before
    edits.redo(desk, adjust_results.PAGE)
    assert misplaced(desk) == used
    adjust_results.go_back(desk)
    assert misplaced(desk) == before
    with pytest.raises(DeskError, match="No result is used"):
        adjust_results.go_back(desk)


def test_a_click_on_the_ground_ends_the_use_for_its_camera_until_it_is_undone(desk: Desk) -> None:
    adjusted(desk)
    adjust_results.use(desk)
    stood = {row.name: poses.calibrated(row) for row in desk.cameras.all()}
    moved = desk.cameras.get(name="C4").clicks.all()[0]
    clicks.put(desk, "C4", moved.point.name, moved.x + 3, moved.y)
    assert adjust_results.in_use(desk).ended == ("C4",)
    assert "C4" in placing.cautions(desk)[-1]
    assert overview.overview(desk).next_step.page is overview.Page.ADJUST
    for row in desk.cameras.all():
        same = poses.calibrated(row).tvec.tolist() == stood[row.name].tvec.tolist()  # type: ignore[union-attr]
        assert same is (row.name != "C4")
    with pytest.raises(DeskError, match="ground points of C4 have changed"):
        adjust_results.use(desk)
    edits.undo(desk, edits.GROUND)
    assert adjust_results.in_use(desk).ended == ()
    row = desk.cameras.get(name="C4")
    assert poses.calibrated(row).tvec.tolist() == stood["C4"].tvec.tolist()  # type: ignore[union-attr]


def test_points_that_came_later_are_told_and_the_result_stays(desk: Desk) -> None:
    found = adjusted(desk)
    adjust_results.use(desk)
    assert adjust_results.changes(desk, found) == []
    keep_points(desk, 3, np.random.default_rng(5), stem="Q")
    assert adjust_results.changes(desk, found) == ["3 points were added since: Q1, Q2, Q3."]
    kept.remove(desk, "P2")
    click = KeptClick.objects.get(point__name="P3", camera__name="C1")
    KeptClick.objects.filter(pk=click.pk).update(x=click.x + 1)
    told = " ".join(adjust_results.changes(desk, found))
    assert "1 point was taken away since: P2." in told and "1 click was moved since." in told
    assert adjust_results.in_use(desk).number == found.number
    assert "3 points were added" in overview.overview(desk).adjust.words


def test_a_dropped_click_leaves_the_next_adjustment_and_undoing_brings_it_back(desk: Desk) -> None:
    click = KeptClick.objects.get(point__name="P7", camera__name="C1")
    KeptClick.objects.filter(pk=click.pk).update(x=click.x + 40)
    found = adjusted(desk)
    worst = worst_of(desk)
    assert (worst.source, worst.point, worst.camera, worst.moved) == ("kept", "P7", "C1", False)
    adjust_decisions.decide(desk, "kept", "P7", "C1", "drop")
    inputs = adjust_inputs.gather(desk, Choices())
    assert ["kept", "P7", "C1"] not in [each[:3] for each in inputs.snapshot["clicks"]]
    assert worst_of(desk).decision == "drop"
    assert any("dropped since" in each for each in adjust_results.changes(desk, found))
    assert [each.point for each in adjust_decisions.dropped(desk)] == ["P7"]
    edits.undo(desk, adjust_results.PAGE)
    assert adjust_results.changes(desk, found) == [] and worst_of(desk).decision == ""


def test_a_click_that_is_put_elsewhere_is_not_dropped_any_more(desk: Desk) -> None:
    click = KeptClick.objects.get(point__name="P7", camera__name="C1")
    adjust_decisions.decide(desk, "kept", "P7", "C1", "drop")
    KeptClick.objects.filter(pk=click.pk).update(x=click.x + 1)
    assert adjust_decisions.dropped(desk) == []


def test_a_kept_click_is_marked_and_adjusted_with(desk: Desk) -> None:
    found = adjusted(desk)
    worst = worst_of(desk)
    adjust_decisions.decide(desk, worst.source, worst.point, worst.camera, "keep")
    assert worst_of(desk).decision == "keep" and adjust_results.changes(desk, found) == []


def test_a_decision_on_no_click_is_refused(desk: Desk) -> None:
    with pytest.raises(DeskError, match="no click on P999 in C1"):
        adjust_decisions.decide(desk, "kept", "P999", "C1", "drop")
    with pytest.raises(DeskError, match="kept or dropped"):
        adjust_decisions.decide(desk, "kept", "P1", "C1", "burn")
