from __future__ import annotations

from typing import Any

import pytest

from gtm_hit.models import Assignment, Layer, Release, Save
from tests.api.conftest import Caller, bearer, body
from tests.work_scene import add_frames, make_dataset, make_layer, row, save


@pytest.fixture
def base(layer: Layer) -> str:
    return f"/api/v1/layers/{layer.pk}/"


READS = ["scene/", "frames/", "frames/5/", "frames/5/history/"]


@pytest.mark.parametrize("path", READS)
def test_staff_read_any_layer(staff: Caller, base: str, path: str) -> None:
    assert staff.get(base + path).status_code == 200


@pytest.mark.parametrize("path", READS)
@pytest.mark.parametrize(
    ("caller", "status", "code"),
    [("stranger", 401, "not_signed_in"), ("alice", 401, "not_signed_in"), ("user", 403, "forbidden")],
)
def test_others_read_no_layer_by_its_number(
    base: str, path: str, caller: str, status: int, code: str, request: pytest.FixtureRequest
) -> None:
    response = request.getfixturevalue(caller).get(base + path)
    assert (response.status_code, response.json()["code"]) == (status, code)


@pytest.mark.parametrize("caller", ["stranger", "alice", "user"])
def test_others_write_no_layer_by_its_number(base: str, caller: str, request: pytest.FixtureRequest) -> None:
    response = request.getfixturevalue(caller).put(base + "frames/5/", body(people=[row()]))
    assert response.status_code in {401, 403}
    assert not Save.objects.exists()


def test_staff_save_with_their_name(staff: Caller, base: str) -> None:
    response = staff.put(base + "frames/5/", body(people=[row()]))
    assert (response.status_code, response.json()["author"]) == (200, "manager")


def test_a_session_needs_the_csrf_token(staff: Caller, base: str) -> None:
    staff.client.handler.enforce_csrf_checks = True
    response = staff.put(base + "frames/5/", body(people=[row()]))
    assert (response.status_code, response.json()["code"]) == (403, "forbidden")
    assert not Save.objects.exists()


def test_staff_read_a_workers_layer_and_do_not_change_it(staff: Caller, assignment: Assignment) -> None:
    base = f"/api/v1/layers/{assignment.layer_id}/"
    scene = staff.get(base + "scene/").json()
    assert scene["editable"] is False
    assert [frame["number"] for frame in scene["frames"]] == list(range(0, 50, 5))
    response = staff.put(base + "frames/5/", body(people=[row()]))
    assert (response.status_code, response.json()["code"]) == (403, "read_only")
    assert not Save.objects.exists()


def test_the_scene_of_a_layer_has_all_frames_of_the_dataset(staff: Caller, base: str) -> None:
    scene = staff.get(base + "scene/").json()
    assert (scene["mode"], scene["assignment"], scene["editable"]) == ("layer", None, True)
    assert len(scene["frames"]) == 20


def test_frames_come_in_pages(staff: Caller, base: str, layer: Layer) -> None:
    add_frames(layer.dataset, 60)
    numbers = [frame["number"] for frame in staff.get(base + "frames/").json()["frames"]]
    assert numbers == list(range(0, 250, 5))
    page = staff.get(base + "frames/?from=11&count=2").json()["frames"]
    assert [frame["number"] for frame in page] == [15, 20]
    assert staff.get(base + "frames/?from=99999").json() == {"frames": []}


@pytest.mark.parametrize("query", ["count=51", "count=0", "from=-1", "from=x", "from=99999999999"])
def test_impossible_pages_are_refused(staff: Caller, base: str, query: str) -> None:
    response = staff.get(f"{base}frames/?{query}")
    assert response.status_code == 400
    assert response.json()["details"][0]["place"] == query.split("=")[0]


def test_a_frame_of_another_dataset_is_not_found(staff: Caller, base: str, layer: Layer) -> None:
    add_frames(make_dataset("other", frames=0), 30)
    assert staff.get(base + "frames/145/").status_code == 404


@pytest.mark.parametrize("number", [2**31, 2**63, 10**30])
def test_huge_numbers_are_not_found(staff: Caller, base: str, number: int) -> None:
    assert staff.get(f"{base}frames/{number}/").status_code == 404
    assert staff.get(f"/api/v1/layers/{number}/scene/").status_code == 404


def test_the_scene_costs_the_same_for_many_frames(
    staff: Caller, base: str, layer: Layer, django_assert_num_queries: Any
) -> None:
    for frame in add_frames(layer.dataset, 40, images=True):
        save(layer, frame, [row()])
    with django_assert_num_queries(12):  # two of them for the session, one for the proposals there are
        staff.get(base + "scene/")


def test_a_hidden_layer_is_for_staff(staff: Caller, alice: Caller, assignment: Assignment) -> None:
    hidden = make_layer(assignment.batch.dataset, "truth", Layer.Kind.GROUND_TRUTH, hidden=True)
    path = f"/api/v1/layers/{hidden.pk}/frames/"
    assert staff.get(path).status_code == 200
    assert alice.get(path).status_code == 401


@pytest.mark.parametrize(
    ("kind", "hidden"),
    [(Layer.Kind.GROUND_TRUTH, True), (Layer.Kind.IMPORTED, False), (Layer.Kind.STAFF, True)],
)
def test_a_script_does_not_overwrite_what_was_imported_or_is_hidden(
    layer: Layer, kind: Layer.Kind, hidden: bool
) -> None:
    kept = make_layer(layer.dataset, "kept", kind, hidden=hidden)
    script = bearer("read", "work")
    response = script.put(f"/api/v1/layers/{kept.pk}/frames/5/", body(people=[row()]))
    assert (response.status_code, response.json()["code"]) == (403, "read_only")
    assert response.json()["details"]["reason"] == "protected"
    scene = script.get(f"/api/v1/layers/{kept.pk}/scene/").json()
    assert scene["editable"] is False and "at the browser" in scene["read_only_reason"]
    assert not Save.objects.exists()


def test_a_script_does_not_overwrite_what_was_released(layer: Layer, base: str) -> None:
    script = bearer("work")
    assert script.put(base + "frames/5/", body(people=[row()])).status_code == 200
    Release.objects.create(dataset=layer.dataset, layer=layer, number=1, manifest={}, manifest_digest="")
    assert script.put(base + "frames/10/", body(people=[row()])).status_code == 403


def test_staff_at_the_browser_mend_a_hidden_truth(staff: Caller, layer: Layer) -> None:
    truth = make_layer(layer.dataset, "truth", Layer.Kind.GROUND_TRUTH, hidden=True)
    assert staff.put(f"/api/v1/layers/{truth.pk}/frames/5/", body(people=[row()])).status_code == 200
