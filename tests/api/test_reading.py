from __future__ import annotations

from typing import Any

import pytest

from gtm_hit.models import Assignment, Job, Layer
from gtm_hit.ops.jobs import queue
from tests.api.conftest import Caller, bearer
from tests.work_scene import add_frames, make_dataset, make_layer, row, save

BASE = "/api/v1/datasets/square/"
READS = [
    "/api/v1/datasets/",
    BASE,
    *(BASE + part for part in ("cameras/", "frames/", "layers/", "layers/own/", "layers/own/annotations/")),
    *(BASE + part for part in ("batches/", "progress/", "assignments/", "releases/", "agreement/")),
    *(BASE + "layers/own/statistics/" + part for part in ("", "numbers.csv", "coverage.svg", "heights.png")),
    *(BASE + "evaluation/" + part + "?truth=own&found=own" for part in ("", "frames/", "frames/0/")),
    "/api/v1/jobs/",
    "/api/v1/sources/",
]


@pytest.fixture(autouse=True)
def people(layer: Layer) -> None:
    frames = list(layer.dataset.frames.order_by("number"))
    save(layer, frames[0], [row(2, 1000), row(1, 2000)], done=True)
    save(layer, frames[2], [row(1, 2001)])


@pytest.mark.parametrize("path", READS)
def test_staff_and_their_scripts_read(staff: Caller, path: str) -> None:
    assert staff.get(path).status_code == 200
    assert bearer("read").get(path).status_code == 200


@pytest.mark.parametrize("path", READS)
def test_nobody_else_reads(stranger: Caller, alice: Caller, user: Caller, path: str) -> None:
    assert stranger.get(path).status_code == 401
    assert alice.get(path).status_code == 401
    assert user.get(path).status_code == 403
    assert bearer("import", "work", "release").get(path).status_code == 403


@pytest.mark.parametrize(
    "path",
    [
        *("/api/v1/datasets/other/", "/api/v1/datasets/other/frames/", BASE + "layers/none/"),
        *(BASE + "layers/own/statistics/coverage.pdf", BASE + "layers/own/statistics/noses.svg"),
        *(BASE + "evaluation/frames/5/?truth=own&found=own", BASE + "calibrations/1/"),
        BASE + "releases/1/files/README.md",
        *(BASE + "layers/a%00b/", BASE + "releases/1/", BASE + "releases/1/download/"),
        *("/api/v1/jobs/1/", f"/api/v1/jobs/{10**30}/", "/api/v1/jobs/1/download/"),
        *(BASE + "frames/?page=2", BASE + "frames/?page=x"),
    ],
)
def test_what_is_not_there_is_not_found(path: str) -> None:
    response = bearer("read").get(path)
    assert (response.status_code, response.json()["code"]) == (404, "not_found")


@pytest.mark.parametrize(
    ("path", "place"),
    [
        *((BASE + "frames/?from=-1", "from"), (BASE + "frames/?to=x", "to")),
        *((BASE + "layers/?kind=x", "kind"), (BASE + "batches/?copy=0", "copy")),
        *((BASE + "assignments/?state=x", "state"), ("/api/v1/jobs/?state=x", "state")),
        (BASE + "layers/own/annotations/?frames=501", "frames"),
        *((BASE + "evaluation/?found=own", "truth"), (BASE + "evaluation/?truth=own&found=x", "found")),
        (BASE + "evaluation/?truth=own&found=own&radius=nan", "radius"),
        (BASE + "evaluation/frames/?truth=own&found=own&scope=all", "scope"),
        *((BASE + "agreement/?radius=0", "radius"), (BASE + "layers/own/statistics/?every=0", "every")),
    ],
)
def test_a_senseless_question_is_refused_with_its_place(path: str, place: str) -> None:
    response = bearer("read").get(path)
    assert (response.status_code, response.json()["code"]) == (400, "invalid")
    assert response.json()["details"][0]["place"] == place


def test_lists_come_in_pages_that_lead_on() -> None:
    script = bearer("read")
    first = script.get(BASE + "frames/?page_size=15&from=5").json()
    assert (first["count"], len(first["results"]), first["previous"]) == (19, 15, None)
    second = script.get(first["next"]).json()
    assert [frame["number"] for frame in second["results"]] == [80, 85, 90, 95]
    assert second["next"] is None


def test_a_frame_names_its_pictures() -> None:
    frame = bearer("read").get(BASE + "frames/?from=10&to=10").json()["results"][0]
    assert frame["number"] == 10
    assert [image["camera"] for image in frame["images"]] == [0, 1]
    assert frame["images"][0]["full"].startswith("/api/v1/images/")


def test_annotations_are_in_metres_and_in_order() -> None:
    found = bearer("read").get(BASE + "layers/own/annotations/").json()
    assert [(each["frame"], each["person"]) for each in found["results"]] == [(0, 1), (0, 2), (10, 1)]
    assert (found["results"][0]["x"], found["results"][0]["y"]) == (-5.0, -4.875)
    assert found["next"] is None


def test_annotations_go_on_where_they_stopped() -> None:
    script = bearer("read")
    first = script.get(BASE + "layers/own/annotations/?frames=2&to=10").json()
    assert [each["frame"] for each in first["results"]] == [0, 0]
    second = script.get(first["next"]).json()
    assert [each["frame"] for each in second["results"]] == [10]
    assert second["next"] is None


def test_a_layer_tells_its_counts() -> None:
    found = bearer("read").get(BASE + "layers/own/").json()
    assert (found["frames_saved"], found["frames_done"], found["annotations"], found["people"]) == (
        2,
        1,
        3,
        2,
    )
    kinds = [each["kind"] for each in bearer("read").get(BASE + "layers/?kind=staff").json()["results"]]
    assert kinds == ["staff"]


def test_assignments_show_pseudonyms_only(assignment: Assignment) -> None:
    response = bearer("read").get(BASE + "assignments/?state=leased")
    found = response.json()["results"][0]
    assert (found["worker"], found["batch"], found["frames"]) == (assignment.worker.pseudonym, 1, 10)
    assert "alice" not in response.content.decode()
    assert bearer("read").get(BASE + "assignments/?state=accepted").json()["count"] == 0
    assert bearer("read").get(BASE + "progress/").json()["leased"] == 1


def test_jobs_are_narrowed_down(layer: Layer) -> None:
    queue.create(Job.Kind.EXPORT_LAYER, layer.dataset, {})
    queue.create(Job.Kind.IMPORT_DATASET, None, {})
    script = bearer("read")
    assert script.get("/api/v1/jobs/").json()["count"] == 2
    found = script.get("/api/v1/jobs/?dataset=square&state=queued").json()["results"]
    assert [(job["dataset"], job["kind"], job["download"]) for job in found] == [
        ("square", "export_layer", None)
    ]


def test_two_layers_are_measured_by_each_other(layer: Layer) -> None:
    found = bearer("read").get(BASE + "evaluation/?truth=own&found=own").json()
    assert (found["moda"], found["recall"], found["frames"]) == (1.0, 1.0, 2)


def test_layers_without_a_common_frame_cannot_be_measured(layer: Layer) -> None:
    make_layer(layer.dataset, "empty")
    response = bearer("read").get(BASE + "evaluation/?truth=own&found=empty")
    assert (response.status_code, response.json()["code"]) == (400, "invalid")


@pytest.mark.parametrize(
    ("path", "queries"),
    [("frames/?page_size=10", 6), ("layers/", 5), ("batches/", 5), ("assignments/", 5)],
)
def test_a_page_costs_the_same_for_many(
    layer: Layer, assignment: Assignment, django_assert_num_queries: Any, path: str, queries: int
) -> None:
    add_frames(layer.dataset, 60, images=True)
    for number in range(20):
        make_layer(layer.dataset, f"layer-{number}")
    script = bearer("read")
    script.get(BASE)  # notes that the token was used
    with django_assert_num_queries(queries):
        script.get(BASE + path)


def test_hidden_layers_are_there_for_staff(layer: Layer) -> None:
    make_layer(make_dataset("other", frames=0), "truth", Layer.Kind.GROUND_TRUTH, hidden=True)
    found = bearer("read").get("/api/v1/datasets/other/layers/").json()["results"]
    assert [(each["name"], each["hidden"]) for each in found] == [("truth", True)]
