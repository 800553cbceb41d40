from __future__ import annotations

import pytest

from gtm_hit.models import Assignment, Dataset, Image, Worker
from gtm_hit.ops.tutorial.lesson import Step
from gtm_hit.ops.work import assignments, batches, links
from tests.api.conftest import Caller, body, holder
from tests.tutorial_scene import make_tutorial, solved
from tests.work_scene import make_dataset, make_worker

BASE = "/api/v1/tutorial/"
READS = ["scene/", "frames/", "frames/5/"]


@pytest.fixture
def demo(db: None) -> Dataset:
    return make_tutorial(images=True)


@pytest.fixture
def worker(demo: Dataset) -> Worker:
    return make_worker("learner")


@pytest.fixture
def learner(worker: Worker) -> Caller:
    return Caller(f"Worker {links.worker_token(worker, make_dataset('real'))}")


def check(caller: Caller, step: str, frame: int, rows: object) -> dict[str, object]:
    response = caller.post(BASE + "check/", {"step": step, "frame": frame, "annotations": rows})
    assert response.status_code == 200, response.content
    return response.json()


def test_the_scene_has_three_frames_and_is_editable(learner: Caller) -> None:
    scene = learner.get(BASE + "scene/").json()
    assert (scene["mode"], scene["editable"], scene["assignment"]) == ("tutorial", True, None)
    assert [(frame["number"], frame["revision"]) for frame in scene["frames"]] == [(0, 1), (5, 1), (10, 1)]
    assert [len(frame["images"]) for frame in scene["frames"]] == [2, 2, 2]
    assert len(scene["cameras"]) == 2


def test_the_prepared_frames_come_together_and_singly(learner: Caller) -> None:
    frames = learner.get(BASE + "frames/").json()["frames"]
    assert [frame["number"] for frame in frames] == [0, 5, 10]
    assert learner.get(BASE + "frames/5/").json() == frames[1]


def test_frames_beyond_the_third_are_not_there(learner: Caller) -> None:
    assert learner.get(BASE + "frames/15/").status_code == 404


def test_the_whole_tutorial(learner: Caller, worker: Worker) -> None:
    for step in Step:
        assert check(learner, step.value, *solved(step))["ok"] is True
    assert learner.post(BASE + "done/").status_code == 200
    worker.refresh_from_db()
    assert worker.tutorial_done_at


def test_done_before_the_steps_is_refused(learner: Caller, worker: Worker) -> None:
    response = learner.post(BASE + "done/")
    assert (response.status_code, response.json()["code"]) == (409, "unfinished")
    assert response.json()["details"] == {"steps": ["place", "correct", "remove", "next"]}
    worker.refresh_from_db()
    assert worker.tutorial_done_at is None


def test_a_wrong_step_is_answered_with_words(learner: Caller) -> None:
    answer = check(learner, "place", 0, [])
    assert answer["ok"] is False
    assert answer["message"]


def test_an_unknown_step_is_invalid(learner: Caller) -> None:
    response = learner.post(BASE + "check/", {"step": "fly", "frame": 0, "annotations": []})
    assert (response.status_code, response.json()["details"][0]["place"]) == (400, "step")


def test_nothing_of_the_tutorial_is_saved(learner: Caller) -> None:
    assert learner.put(BASE + "frames/0/", body()).status_code == 405


def test_the_learner_sees_the_three_frames_pictures_and_no_others(learner: Caller, demo: Dataset) -> None:
    last = Image.objects.filter(frame__number=25).first()
    assert last
    assert learner.get(f"/api/v1/images/{last.light_digest}.jpg").status_code == 404


@pytest.mark.parametrize("path", READS)
@pytest.mark.parametrize("caller", ["stranger", "user", "staff"])
def test_without_a_workers_token_nothing_is_read(
    path: str, caller: str, demo: Dataset, request: pytest.FixtureRequest
) -> None:
    response = request.getfixturevalue(caller).get(BASE + path)
    assert (response.status_code, response.json()["code"]) == (401, "not_signed_in")


@pytest.mark.parametrize("path", ["check/", "done/"])
def test_without_a_workers_token_nothing_is_marked(path: str, worker: Worker, stranger: Caller) -> None:
    assert stranger.post(BASE + path).status_code == 401
    worker.refresh_from_db()
    assert worker.tutorial_steps == []


def test_an_assignments_token_is_no_workers_token(demo: Dataset, worker: Worker) -> None:
    batches.make_batches(demo)
    assignment: Assignment = assignments.claim(worker, demo)
    assert holder(assignment).get(BASE + "scene/").status_code == 401


def test_without_the_demo_there_is_no_tutorial(db: None) -> None:
    token = links.worker_token(make_worker(), make_dataset("real"))
    response = Caller(f"Worker {token}").get(BASE + "scene/")
    assert (response.status_code, response.json()["code"]) == (404, "not_found")
