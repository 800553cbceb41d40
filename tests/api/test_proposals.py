"""Proposals over REST: runs for staff, people and refusals for who works on the frames."""

from __future__ import annotations

from typing import Any

import pytest

from gtm_hit.models import Annotation, Dataset, Job, Layer, ProposalRun, Refusal
from gtm_hit.ops.proposals import runs
from gtm_hit.ops.work import assignments, batches
from tests.api.conftest import Caller, bearer, holder
from tests.ops.proposals.conftest import NUMBERS, dataset  # noqa: F401
from tests.ops.proposals.watcher import shown_run, walk
from tests.work_scene import make_layer, make_worker

BASE = "/api/v1/datasets/square/"


@pytest.fixture
def run(dataset: Dataset) -> ProposalRun:  # noqa: F811
    return shown_run(dataset, walk(NUMBERS), alarms=["C2"])


@pytest.fixture
def annotator(run: ProposalRun) -> Caller:
    batches.make_batches(run.dataset, size=4)
    return holder(assignments.claim(make_worker(), run.dataset))


def test_an_annotator_sees_the_proposals_of_his_frames_only(annotator: Caller) -> None:
    told = annotator.get("/api/v1/assignment/proposals/").json()
    assert [frame["number"] for frame in told["frames"]] == list(NUMBERS[:4])
    person = told["frames"][0]["people"][0]
    assert person["person"] is None
    assert person["evidence"][0]["camera"] == "C1"
    assert Annotation.objects.count() == 0


def test_an_annotator_refuses_and_takes_it_back(annotator: Caller) -> None:
    body = {"frame": 0, "position": 77}
    assert annotator.post("/api/v1/assignment/refusals/", body).status_code == 200
    assert annotator.get("/api/v1/assignment/proposals/").json()["frames"][0]["refused"] == [77]
    annotator.post("/api/v1/assignment/refusals/", {**body, "refused": False})
    assert not Refusal.objects.exists()


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({"frame": 20, "position": 77}, 404),  # of another batch
        ({"frame": 0, "position": 10**6}, 400),
        ({"frame": 0}, 400),
        ({"frame": 0, "position": 1, "refused": "perhaps"}, 400),
    ],
)
def test_a_refusal_that_cannot_be_changes_nothing(annotator: Caller, body: Any, status: int) -> None:
    assert annotator.post("/api/v1/assignment/refusals/", body).status_code == status
    assert not Refusal.objects.exists()


def test_a_mark_is_put_right_only_where_a_detector_has_looked(annotator: Caller) -> None:
    body = {"frame": 0, "position": 77, "others": [{"position": 90, "height": 1.5}]}
    told = annotator.post("/api/v1/assignment/snap/", body).json()
    assert told == {"position": 77, "metres": 0.0, "gain": 0.0, "refused": "unseen", "background": False}
    assert Annotation.objects.count() == 0


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({"frame": 20, "position": 77, "others": []}, 404),  # of another batch
        ({"frame": 0, "position": 10**6, "others": []}, 400),
        ({"frame": 0, "position": 77, "others": [{"position": 10**6}]}, 400),
        ({"frame": 0, "position": 77, "height": -1, "others": []}, 400),
        ({"frame": 0, "position": 77}, 400),
    ],
)
def test_a_mark_that_cannot_be_is_refused(annotator: Caller, body: Any, status: int) -> None:
    assert annotator.post("/api/v1/assignment/snap/", body).status_code == status


def test_strangers_put_nothing_right(stranger: Caller, run: ProposalRun) -> None:
    address = f"/api/v1/layers/{make_layer(run.dataset).pk}/snap/"
    assert stranger.post(address, {"frame": 0, "position": 1, "others": []}).status_code == 401


def test_staff_see_them_on_any_layer_and_strangers_nowhere(
    staff: Caller, stranger: Caller, run: ProposalRun
) -> None:
    address = f"/api/v1/layers/{make_layer(run.dataset).pk}/proposals/"
    assert len(staff.get(address).json()["frames"]) == 8
    assert stranger.get(address).status_code == 401
    assert (
        stranger.post(address.replace("proposals", "refusals"), {"frame": 0, "position": 1}).status_code
        == 401
    )


def test_runs_are_listed_with_what_they_found(staff: Caller, run: ProposalRun) -> None:
    told = staff.get(BASE + "proposals/").json()
    assert told["leaves_the_server"] is False
    (listed,) = told["results"]
    assert (listed["id"], listed["frames"], listed["people"], listed["alarms"]) == (run.pk, 8, 8, {"C2": 8})


def test_a_script_starts_proposing_with_the_right_key_only(run: ProposalRun) -> None:
    assert bearer("read").post(BASE + "proposals/", {}).status_code == 403
    started = bearer("read", "work").post(BASE + "proposals/", {"method": "background", "detector": "none"})
    assert (started.status_code, started.json()["kind"]) == (202, "propose")
    assert Job.objects.get().parameters == {"method": "background", "detector": "none", "use": True}


@pytest.mark.parametrize(
    "body", [{"method": "file"}, {"detector": "file:/etc/passwd"}, {"detector": "http://elsewhere"}]
)
def test_what_the_server_does_not_offer_starts_nothing(staff: Caller, run: ProposalRun, body: Any) -> None:
    assert staff.post(BASE + "proposals/", body).status_code == 400
    assert not Job.objects.exists()


def test_a_run_is_taken_out_of_use_made_a_layer_and_removed(staff: Caller, run: ProposalRun) -> None:
    address = f"{BASE}proposals/{run.pk}/"
    staff.post(address, {"in_use": False})
    assert runs.in_use(run.dataset) is None
    assert staff.post(address + "layer/", {"layer": "found"}).json() == {"layer": "found"}
    assert staff.post(address + "layer/", {"layer": "found"}).status_code == 400
    assert Layer.objects.get().annotations.count() == 8
    assert staff.client.delete(address).status_code == 204
    assert staff.client.delete(address).status_code == 404
    assert Layer.objects.get().annotations.count() == 8


def test_the_missing_are_listed_placed_and_dismissed(staff: Caller, run: ProposalRun) -> None:
    staff.post(f"{BASE}proposals/{run.pk}/layer/", {"layer": "found"})
    taken = Annotation.objects.filter(frame__number__in=(10, 30))
    positions = dict(taken.values_list("frame__number", "position"))
    taken.delete()
    address = BASE + "layers/found/missing/"
    told = staff.get(address).json()
    assert sorted(place["frame"] for place in told["results"]) == [10, 30]
    placed = staff.post(address, {"decision": "place", "frame": 10, "position": positions[10], "person": 1})
    assert placed.json() == {"person": 1}
    staff.post(address, {"decision": "nobody", "frame": 30, "position": positions[30]})
    assert staff.get(address).json()["results"] == []


def test_a_wrong_decision_changes_nothing(staff: Caller, run: ProposalRun) -> None:
    staff.post(f"{BASE}proposals/{run.pk}/layer/", {"layer": "found"})
    before = list(Annotation.objects.values_list())
    address = BASE + "layers/found/missing/"
    for wrong in (
        {"decision": "maybe", "frame": 0, "position": 1},
        {"decision": "place", "frame": 3, "position": 1},
        {"decision": "place", "frame": 0, "position": 10**6},
        {"decision": "place", "frame": 0, "position": 1, "person": 1},
    ):
        assert staff.post(address, wrong).status_code == 400
    assert list(Annotation.objects.values_list()) == before
