"""Reviews by REST: for staff with a session or a key, and for workers with their assignment's token."""

from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import ApiToken, Assignment, Comment, Dataset, Transition
from gtm_hit.ops import api_tokens
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition
from gtm_hit.ops.work import links
from gtm_hit.ops.work.assignments import claim
from tests.ops.review.scene import REASON, annotate, into_campaign, make_reviewer, make_work, submitted
from tests.work_scene import finish, make_layer, make_worker, row, save

pytestmark = pytest.mark.django_db
BASE = "/api/v1/datasets/square/reviews/"


@pytest.fixture
def dataset() -> Dataset:
    return make_work()


@pytest.fixture
def work(dataset: Dataset) -> Assignment:
    return submitted("alice", dataset)


@pytest.fixture
def rita() -> User:
    return make_reviewer()


@pytest.fixture
def staff(rita: User) -> Client:
    client = Client()
    client.force_login(rita)
    return client


def post(client: Client, address: str, body: Any, **more: Any) -> Any:
    return client.post(address, body, content_type="application/json", **more)


def as_worker(assignment: Assignment) -> dict[str, Any]:
    return {"headers": {"authorization": f"Assignment {links.assignment_token(assignment)}"}}


def test_the_queue_lists_what_waits(staff: Client, work: Assignment) -> None:
    found = staff.get(BASE).json()["results"]
    assert [(one["id"], one["frames"], one["people"], one["why"]) for one in found] == [
        (work.pk, 2, 4, "all")
    ]
    assert "alice" not in staff.get(BASE).content.decode()


def test_the_queue_of_a_campaign_leaves_out_other_work(staff: Client, dataset: Dataset) -> None:
    work = submitted("alice", dataset)
    into_campaign(dataset)
    dataset.batches.exclude(pk=work.batch_id).update(campaign=None)
    annotate(other := claim(make_worker("bob"), dataset))
    finish(other)
    assert len(staff.get(BASE).json()["results"]) == 2
    assert [one["id"] for one in staff.get(f"{BASE}?campaign=spring").json()["results"]] == [work.pk]
    assert staff.get(f"{BASE}?campaign=autumn").status_code == 400


def test_a_decision_is_taken_and_names_the_next(staff: Client, dataset: Dataset, work: Assignment) -> None:
    following = submitted("bob", dataset)
    said = post(staff, f"{BASE}{work.pk}/decision/", {"action": "accept"}).json()
    assert (said["state"], said["next"], said["waiting"]) == ("accepted", following.pk, 1)
    assert [step["by"] for step in said["steps"]] == [work.worker.pseudonym, "rita"]


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({"action": "reject"}, 400),
        ({"action": "reject", "category": "low_effort", "reason": "bad"}, 400),
        ({"action": "reject", "category": "ugly", "reason": REASON}, 400),
        ({"action": "return"}, 400),
        ({"action": "submit"}, 400),
        ({"action": "accept_unseen"}, 400),
        ({"action": "uphold", "reason": REASON}, 409),
        ({}, 400),
    ],
)
def test_a_decision_that_cannot_be_changes_nothing(
    staff: Client, work: Assignment, body: dict[str, str], status: int
) -> None:
    answer = post(staff, f"{BASE}{work.pk}/decision/", body)
    assert (answer.status_code, Transition.objects.count()) == (status, 1)
    assert answer.json()["message"]


def test_the_second_of_two_reviewers_gets_409(staff: Client, work: Assignment) -> None:
    transition(work, Action.ACCEPT, make_reviewer("sven"))
    answer = post(staff, f"{BASE}{work.pk}/decision/", {"action": "accept"})
    assert (answer.status_code, answer.json()["code"]) == (409, "wrong_state")


def test_ones_own_work_is_refused(staff: Client, dataset: Dataset) -> None:
    work = submitted(make_worker("rita", "own_team"), dataset)
    answer = post(staff, f"{BASE}{work.pk}/decision/", {"action": "accept"})
    assert (answer.status_code, answer.json()["code"]) == (403, "own_work")


@pytest.mark.parametrize("tail", ["", "differences/"])
def test_strangers_read_nothing(client: Client, work: Assignment, tail: str) -> None:
    assert client.get(f"{BASE}{work.pk}/{tail}").status_code == 401
    assert client.get(BASE).status_code == 401


@pytest.mark.parametrize("tail", ["decision/", "comments/", "mend/"])
def test_strangers_and_workers_decide_nothing(client: Client, work: Assignment, tail: str) -> None:
    for more in ({}, as_worker(work)):
        assert post(
            client, f"{BASE}{work.pk}/{tail}", {"action": "accept", "text": "x"}, **more
        ).status_code in {
            401,
            403,
        }
    assert Transition.objects.count() == 1 and not Comment.objects.exists()


def test_staff_without_the_role_is_kept_out(client: Client, dataset: Dataset, work: Assignment) -> None:
    staff, mona = client, User.objects.create_user("mona")
    granting.grant(mona, Role.MAINTAINER, dataset)
    staff.force_login(mona)
    assert staff.get(BASE).status_code == 403
    assert post(staff, f"{BASE}{work.pk}/decision/", {"action": "accept"}).status_code == 403
    for page in ("", f"{work.pk}/"):
        assert staff.get(f"/datasets/square/review/{page}").status_code == 403


def test_a_script_needs_the_scope_of_work(client: Client, rita: User, work: Assignment) -> None:
    for scopes, status in (([ApiToken.Scope.READ], 403), ([ApiToken.Scope.READ, ApiToken.Scope.WORK], 200)):
        _token, key = api_tokens.make(rita, "desk", scopes, None)
        more = {"headers": {"authorization": f"Bearer {key}"}}
        assert post(client, f"{BASE}{work.pk}/decision/", {"action": "accept"}, **more).status_code == status


def test_another_dataset_s_work_is_not_found(staff: Client, work: Assignment) -> None:
    assert staff.get(f"/api/v1/datasets/round/reviews/{work.pk}/").status_code == 404


def test_differences_come_worst_first_beside_the_best_reference(staff: Client, dataset: Dataset) -> None:
    truth = make_layer(dataset, "truth", hidden=True)
    work = submitted("alice", dataset, missing=1)
    frame = dataset.frames.get(number=0)
    save(truth, frame, [row(one.person, one.position) for one in work.layer.annotations.filter(frame=frame)])
    other = dataset.frames.get(number=5)
    rows = [row(1, 20_012), row(2, 40_100), row(3, 60_200), row(4, 80_300)]
    save(truth, other, rows)
    said = staff.get(f"{BASE}{work.pk}/differences/").json()
    assert said["reference"] == "truth"
    assert [(one["frame"], one["differences"]) for one in said["frames"]] == [(0, 0), (5, 2)]
    kinds = [said["frames"][1]["marks"][place]["kind"] for _frame, place in said["worst_first"]]
    assert kinds == ["missed", "moved"]


def test_without_a_reference_everybody_is_shown_and_nothing_differs(staff: Client, work: Assignment) -> None:
    said = staff.get(f"{BASE}{work.pk}/differences/?reference=").json()
    assert (said["reference"], said["worst_first"]) == (None, [])
    assert [len(one["marks"]) for one in said["frames"]] == [4, 4]


def test_another_copy_and_a_neighbour_are_offered_as_references(staff: Client) -> None:
    dataset = make_work(copies=2)
    first, second = submitted("alice", dataset), submitted("bob", dataset)
    third = submitted("carl", dataset)
    found = staff.get(f"{BASE}{third.pk}/differences/").json()
    assert third.batch.number == 1 and found["reference"] == first.layer.name
    assert second.layer.name not in [one["name"] for one in found["references"]]


def test_a_reference_that_is_not_there_is_said(staff: Client, work: Assignment) -> None:
    assert staff.get(f"{BASE}{work.pk}/differences/?reference=nothing").status_code == 400


@pytest.mark.parametrize(
    "pin", [{"frame": 99}, {"person": 1}, {"frame": 0, "position": 160_000}, {"frame": -1}, {"frame": "a"}]
)
def test_a_comment_on_what_is_not_there_is_refused(
    staff: Client, work: Assignment, pin: dict[str, Any]
) -> None:
    answer = post(staff, f"{BASE}{work.pk}/comments/", {"text": "Look", **pin})
    assert answer.status_code == 400 and not Comment.objects.exists()


def test_a_worker_reads_answers_and_finishes_comments_by_his_token(
    staff: Client, client: Client, work: Assignment
) -> None:
    post(staff, f"{BASE}{work.pk}/comments/", {"text": "Too far left", "frame": 5, "person": 2})
    post(staff, f"{BASE}{work.pk}/decision/", {"action": "return"})
    remark = client.get("/api/v1/assignment/comments/", **as_worker(work)).json()["comments"][0]
    assert (remark["frame"], remark["person"], remark["role"]) == (5, 2, "reviewer")
    assert "rita" not in str(remark)
    answer = {"text": "Moved", "answers": remark["id"]}
    said = post(client, "/api/v1/assignment/comments/", answer, **as_worker(work)).json()["comments"][0]
    assert [one["role"] for one in said["answers"]] == ["worker"]
    address = f"/api/v1/assignment/comments/{remark['id']}/"
    assert post(client, address, {"resolved": True}, **as_worker(work)).json()["comments"][0]["resolved"]


def test_a_worker_reaches_nobody_else_s_comments(client: Client, dataset: Dataset, work: Assignment) -> None:
    remark = Comment.objects.create(assignment=work, user=make_reviewer(), text="Look")
    other = submitted("bob", dataset)
    assert client.get("/api/v1/assignment/comments/", **as_worker(other)).json() == {"comments": []}
    address = f"/api/v1/assignment/comments/{remark.pk}/"
    assert post(client, address, {"resolved": True}, **as_worker(other)).status_code == 404


def test_a_rejected_worker_reads_why_and_appeals_once(client: Client, work: Assignment, rita: User) -> None:
    address = "/api/v1/assignment/appeal/"
    assert post(client, address, {"text": "No!"}, **as_worker(work)).status_code == 409
    transition(work, Action.REJECT, rita, category="no_data", reason=REASON)
    said = client.get("/api/v1/assignment/decision/", **as_worker(work)).json()
    assert (said["state"], said["reason"], said["may_appeal"]) == ("rejected", REASON, True)
    assert post(client, address, {"text": "They left."}, **as_worker(work)).status_code == 201
    assert post(client, address, {"text": "Really."}, **as_worker(work)).status_code == 409
