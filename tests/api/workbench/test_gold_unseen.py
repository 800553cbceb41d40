"""No answer tells a gold frame from an ordinary one: by shape, fields, order, headers, number of queries."""

from __future__ import annotations

from typing import Any

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Assignment, GoldFrame
from gtm_hit.ops.gold import frames, planting
from tests.api.conftest import Caller, body, holder
from tests.gold_scene import make_scene, take, truth_of_square
from tests.work_scene import row

pytestmark = pytest.mark.django_db

VARYING = {"number", "light", "full", "position", "person", "saved_at", "created_at", "save_id", "frame"}


def shape(answer: Any) -> Any:
    """Names and types, and the values of everything that is not different for each frame anyway."""
    if isinstance(answer, dict):
        return {key: type(value) if key in VARYING else shape(value) for key, value in answer.items()}
    if isinstance(answer, list):
        return [shape(one) for one in answer]
    return answer


@pytest.fixture(params=["empty", "filled"])
def assignment(request: Any) -> Assignment:
    """A batch of which every third frame is gold; with people it started with, or without."""
    campaign, truth = make_scene(images=True)
    if request.param == "filled":
        planting.settle(campaign, truth, 0.0)
    frames.choose(campaign, truth, 0.35)
    return take(campaign)


@pytest.fixture
def alice(assignment: Assignment) -> Caller:
    return holder(assignment)


def kinds(assignment: Assignment) -> tuple[list[int], list[int]]:
    """Numbers of the gold frames and of the ordinary ones."""
    numbers = list(assignment.batch.frames.order_by("number").values_list("number", flat=True))
    gold = set(GoldFrame.objects.values_list("frame__number", flat=True))
    both = [one for one in numbers if one in gold], [one for one in numbers if one not in gold]
    assert all(both)
    return both


def by_number(answer: dict[str, Any]) -> dict[int, Any]:
    return {one["number"]: shape(one) for one in answer["frames"]}


@pytest.mark.parametrize("path", ["scene/", "frames/"])
def test_lists_of_frames_show_them_alike_and_in_order(
    alice: Caller, assignment: Assignment, path: str
) -> None:
    gold, ordinary = kinds(assignment)
    answer = alice.get(f"/api/v1/assignment/{path}").json()
    found = by_number(answer)
    assert list(found) == sorted(gold + ordinary)
    for number in gold:
        assert found[number] == found[ordinary[0]]


@pytest.mark.parametrize("path", ["frames/{}/", "frames/{}/history/", "frames/{}/?revision=0"])
def test_single_frames_answer_alike_with_as_many_queries(
    alice: Caller, assignment: Assignment, path: str
) -> None:
    gold, ordinary = kinds(assignment)
    asked = []
    for number in (gold[0], ordinary[0]):
        with CaptureQueriesContext(connection) as queries:
            response = alice.get(f"/api/v1/assignment/{path.format(number)}")
        asked.append((response.status_code, shape(response.json()), len(queries), sorted(response.headers)))
    assert asked[0] == asked[1]


def test_saves_answer_alike_with_as_many_queries(alice: Caller, assignment: Assignment) -> None:
    gold, ordinary = kinds(assignment)
    asked = []
    # Whatever comes first begins the worker's clock.
    for number in (ordinary[1], gold[0], ordinary[0]):
        address = f"/api/v1/assignment/frames/{number}/"
        revision = alice.get(address).json()["revision"]
        people = [row(person, place) for person, place in truth_of_square()[number].items()]
        with CaptureQueriesContext(connection) as queries:
            response = alice.put(address, body(revision, people, done=True))
        asked.append((response.status_code, shape(response.json()), len(queries)))
    assert asked[1] == asked[2]
    assert asked[1][0] == 200


def test_a_batch_with_gold_is_submitted_like_one_without(alice: Caller, assignment: Assignment) -> None:
    counted = []
    for person, caller in (("alice", alice), ("bob", None)):
        if caller is None:
            other = take(assignment.batch.campaign, person)
            GoldFrame.objects.filter(frame__batches=other.batch).delete()
            caller, numbers = holder(other), other.batch.frames.order_by("number")
        else:
            numbers = assignment.batch.frames.order_by("number")
        for number in numbers.values_list("number", flat=True):
            address = f"/api/v1/assignment/frames/{number}/"
            revision = caller.get(address).json()["revision"]
            people = [row(one, place) for one, place in truth_of_square()[number].items()]
            assert caller.put(address, body(revision, people, done=True)).status_code == 200
        with CaptureQueriesContext(connection) as queries:
            response = caller.post("/api/v1/assignment/submit/")
        counted.append(
            (response.status_code, sorted(response.json()), sorted(response.json()["summary"]), len(queries))
        )
    assert counted[0] == counted[1]


def test_neither_rows_nor_words_of_gold_are_in_any_answer(alice: Caller, assignment: Assignment) -> None:
    number = kinds(assignment)[0][0]
    for path in ("scene/", "frames/", f"frames/{number}/", f"frames/{number}/history/"):
        text = alice.get(f"/api/v1/assignment/{path}").content.decode().lower()
        assert not [word for word in ("gold", "truth", "planted", "fault") if word in text], path
