from __future__ import annotations

from datetime import timedelta

import pytest

from gtm_hit.models import Annotation, Assignment, Layer, Save
from tests.api.conftest import Caller, body
from tests.work_scene import finish, row

SCENE = "/api/v1/assignment/scene/"
FRAMES = "/api/v1/assignment/frames/"
FRAME = "/api/v1/assignment/frames/5/"
HISTORY = "/api/v1/assignment/frames/5/history/"
READS = [SCENE, FRAMES, FRAME, HISTORY]


def test_the_scene_describes_what_the_workbench_draws(alice: Caller, assignment: Assignment) -> None:
    scene = alice.get(SCENE).json()
    assert scene["mode"] == "assignment"
    assert scene["grid"] == {"columns": 400, "rows": 400, "step": 0.025, "origin": [-5.0, -5.0]}
    assert scene["cylinder"] == {"radius": 0.16, "height": 1.8}
    assert [camera["name"] for camera in scene["cameras"]] == ["C1", "C2"]
    assert [len(line) for line in scene["cameras"][0]["rotation"]] == [3, 3, 3]
    assert [frame["number"] for frame in scene["frames"]] == list(range(0, 50, 5))
    assert [image["camera"] for image in scene["frames"][0]["images"]] == [0, 1]
    assert scene["layer"]["name"] == assignment.layer.name
    assert (scene["editable"], scene["read_only_reason"]) == (True, "")
    assert scene["assignment"]["batch"] == "square batch 1"
    assert scene["next_person"] == 1


def test_a_layer_has_a_key_that_stays_and_that_no_layer_of_another_database_has(
    alice: Caller, assignment: Assignment
) -> None:
    keys = {alice.get(SCENE).json()["layer"]["key"] for _ in range(2)}
    Layer.objects.filter(pk=assignment.layer.pk).update(
        created_at=assignment.layer.created_at + timedelta(seconds=1)
    )
    other = alice.get(SCENE).json()["layer"]["key"]
    assert len(keys) == 1
    assert other not in keys


def test_the_scene_brings_accepted_people_from_beyond_the_batchs_border(bob: Caller, alice: Caller) -> None:
    """Bob has the batch after Alice's."""
    assert bob.get(SCENE).json()["neighbours"] == {"before": [], "after": []}
    alice.put("/api/v1/assignment/frames/45/", body(people=[row(7, 20)], done=True))
    finish(Assignment.objects.get(worker__external_id="alice"))
    Assignment.objects.filter(worker__external_id="alice").update(state=Assignment.State.ACCEPTED)
    before = bob.get(SCENE).json()["neighbours"]["before"]
    assert [frame["number"] for frame in before] == [45, 40, 35, 30]
    assert before[0]["annotations"] == [row(7, 20)]


def test_the_scene_costs_the_same_queries_for_many_frames(
    alice: Caller, django_assert_max_num_queries: object
) -> None:
    with django_assert_max_num_queries(8):  # type: ignore[operator]
        alice.get(SCENE)


def test_all_frames_of_the_batch_come_in_one_answer(alice: Caller) -> None:
    alice.put(FRAME, body(people=[row()]))
    frames = alice.get(FRAMES).json()["frames"]
    assert [(frame["number"], frame["revision"]) for frame in frames][:3] == [(0, 0), (5, 1), (10, 0)]
    assert frames[1]["annotations"] == [row()]


def test_a_save_is_answered_with_the_new_state(alice: Caller, assignment: Assignment) -> None:
    response = alice.put(FRAME, body(people=[row(7, 20)], done=True))
    assert response.status_code == 200
    state = response.json()
    assert (state["number"], state["revision"], state["done"]) == (5, 1, True)
    assert state["annotations"] == [row(7, 20)]
    assert state["author"] == assignment.worker.pseudonym
    assert state["saved_at"]
    assert alice.get(FRAME).json() == state


def test_the_same_save_again_writes_nothing(alice: Caller) -> None:
    sent = body(people=[row()])
    first = alice.put(FRAME, sent)
    again = alice.put(FRAME, sent)
    assert again.status_code == 200
    assert again.json() == first.json()
    assert Save.objects.count() == 1


def test_a_stale_save_is_answered_with_the_current_state(alice: Caller) -> None:
    current = alice.put(FRAME, body(people=[row(1)])).json()
    response = alice.put(FRAME, body(people=[row(2)]))
    assert response.status_code == 412
    assert response.json()["code"] == "stale"
    assert response.json()["details"] == {"current": current}
    assert list(Annotation.objects.values_list("person", flat=True)) == [1]


def test_an_invalid_save_names_every_place(alice: Caller) -> None:
    response = alice.put(FRAME, body(people=[row(1, 160000), row(1, 5)]))
    assert response.status_code == 400
    assert response.json()["code"] == "invalid"
    places = [problem["place"] for problem in response.json()["details"]]
    assert places == ["annotations[0].position", "annotations[1].person"]
    assert Save.objects.count() == 0


def test_a_missing_save_id_is_named(alice: Caller) -> None:
    response = alice.put(FRAME, {"revision": 0, "annotations": []})
    assert response.status_code == 400
    assert [problem["place"] for problem in response.json()["details"]] == ["save_id"]


def test_a_save_id_of_another_frame_is_refused(alice: Caller) -> None:
    sent = body(people=[row()])
    alice.put(FRAME, sent)
    response = alice.put("/api/v1/assignment/frames/10/", sent)
    assert (response.status_code, response.json()["code"]) == (409, "save_id_used")
    assert Save.objects.count() == 1


def test_the_history_lists_every_save_and_gives_each_back(alice: Caller) -> None:
    alice.put(FRAME, body(people=[row(1), row(2, 5)]))
    alice.put(FRAME, body(1, people=[row(1)]))
    revisions = alice.get(HISTORY).json()["revisions"]
    assert [(entry["revision"], entry["people"]) for entry in revisions] == [(1, 2), (2, 1)]
    assert alice.get(FRAME + "?revision=1").json()["annotations"] == [row(1), row(2, 5)]
    assert alice.get(FRAME + "?revision=0").json()["annotations"] == []


def test_a_revision_that_never_was_is_not_found(alice: Caller) -> None:
    assert alice.get(FRAME + "?revision=9").status_code == 404
    assert alice.get(FRAME + "?revision=x").status_code == 400


def test_a_frame_of_another_batch_is_not_found(alice: Caller) -> None:
    path = "/api/v1/assignment/frames/50/"
    assert alice.get(path).json()["code"] == "not_found"
    assert alice.put(path, body()).status_code == 404


def test_another_worker_sees_only_his_own_layer(alice: Caller, bob: Caller) -> None:
    alice.put(FRAME, body(people=[row()]))
    assert bob.get(FRAME).status_code == 404
    assert [frame["number"] for frame in bob.get(FRAMES).json()["frames"]] == list(range(50, 100, 5))


@pytest.mark.parametrize("path", READS)
@pytest.mark.parametrize("caller", ["stranger", "user", "staff"])
def test_without_a_token_nothing_is_read(
    path: str, caller: str, assignment: Assignment, request: pytest.FixtureRequest
) -> None:
    response = request.getfixturevalue(caller).get(path)
    assert (response.status_code, response.json()["code"]) == (401, "not_signed_in")


@pytest.mark.parametrize("caller", ["stranger", "user", "staff"])
def test_without_a_token_nothing_is_written(
    caller: str, assignment: Assignment, request: pytest.FixtureRequest
) -> None:
    response = request.getfixturevalue(caller).put(FRAME, body(people=[row()]))
    assert response.status_code == 401
    assert Save.objects.count() == 0


@pytest.mark.parametrize("token", ["", "x", "abc.def", "\x7f", "é"])
def test_a_broken_token_is_not_signed_in(token: str, assignment: Assignment) -> None:
    response = Caller(f"Assignment {token}").get(SCENE)
    assert (response.status_code, response.json()["code"]) == (401, "not_signed_in")


def test_a_revoked_token_is_not_signed_in(alice: Caller, assignment: Assignment) -> None:
    assignment.nonce = "another"
    assignment.save()
    assert alice.get(SCENE).status_code == 401


def test_an_expired_assignment_can_be_read_and_not_changed(alice: Caller, assignment: Assignment) -> None:
    assignment.expires_at = assignment.leased_at
    assignment.save()
    response = alice.put(FRAME, body(people=[row()]))
    assert (response.status_code, response.json()["code"]) == (403, "read_only")
    assert response.json()["details"] == {"reason": "expired"}
    assert Save.objects.count() == 0
    scene = alice.get(SCENE).json()
    assert scene["editable"] is False
    assert "run out" in scene["read_only_reason"]
    assert [alice.get(path).status_code for path in READS] == [200] * 4


def test_a_submitted_assignment_can_be_read_and_not_changed(alice: Caller, assignment: Assignment) -> None:
    finish(assignment)
    response = alice.put(FRAME, body(1, people=[row()]))
    assert (response.status_code, response.json()["details"]) == (403, {"reason": "submitted"})
    assert Annotation.objects.count() == 0
    assert [alice.get(path).status_code for path in READS] == [200] * 4


def test_a_save_whose_answer_was_lost_is_confirmed_after_submission(
    alice: Caller, assignment: Assignment
) -> None:
    sent = body(nobody=True, done=True)
    assert alice.put(FRAME, sent).status_code == 200
    finish(assignment)
    assert alice.put(FRAME, sent).status_code == 200
