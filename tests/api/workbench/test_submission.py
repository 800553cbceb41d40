from __future__ import annotations

import pytest
from django.utils import timezone

from gtm_hit.models import Assignment
from tests.api.conftest import Caller
from tests.work_scene import do_frames, finish

PATH = "/api/v1/assignment/submit/"


def test_a_finished_batch_gets_its_code(alice: Caller, assignment: Assignment) -> None:
    do_frames(assignment)
    response = alice.post(PATH)
    assert response.status_code == 200
    assignment.refresh_from_db()
    assert response.json()["code"] == assignment.code
    assert len(response.json()["summary"]["frames"]) == 10
    assert assignment.state == "submitted"


def test_submitting_again_answers_the_same(alice: Caller, assignment: Assignment) -> None:
    do_frames(assignment)
    assert alice.post(PATH).json() == alice.post(PATH).json()


def test_unfinished_frames_are_listed(alice: Caller, assignment: Assignment) -> None:
    response = alice.post(PATH)
    assert (response.status_code, response.json()["code"]) == (409, "unfinished")
    assert response.json()["details"] == {"frames": list(range(0, 50, 5))}
    assignment.refresh_from_db()
    assert (assignment.state, assignment.code) == ("leased", None)


def test_an_expired_batch_is_not_submitted(alice: Caller, assignment: Assignment) -> None:
    do_frames(assignment)
    Assignment.objects.update(expires_at=timezone.now())
    response = alice.post(PATH)
    assert (response.status_code, response.json()["details"]) == (403, {"reason": "expired"})
    assert not Assignment.objects.filter(state="submitted").exists()


@pytest.mark.parametrize("caller", ["stranger", "user", "staff"])
def test_nobody_else_submits_it(caller: str, assignment: Assignment, request: pytest.FixtureRequest) -> None:
    do_frames(assignment)
    assert request.getfixturevalue(caller).post(PATH).status_code == 401
    assert not Assignment.objects.filter(state="submitted").exists()


def test_another_worker_submits_only_his_own(bob: Caller, assignment: Assignment) -> None:
    do_frames(assignment)
    assert bob.post(PATH).status_code == 409
    assert not Assignment.objects.filter(state="submitted").exists()


def test_a_rejected_assignment_stays_rejected(alice: Caller, assignment: Assignment) -> None:
    finish(assignment)
    Assignment.objects.update(state="rejected")
    assert alice.post(PATH).status_code == 200
    assignment.refresh_from_db()
    assert assignment.state == "rejected"
