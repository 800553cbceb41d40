"""What platforms put into the address of an entry link."""

from __future__ import annotations

import pytest

from gtm_hit.crowd.entry import WORKER_PARAMETERS, is_preview, worker_id


def test_no_parameter_belongs_to_two_platforms() -> None:
    assert sorted(WORKER_PARAMETERS) == ["PROLIFIC_PID", "participant_id", "workerId", "worker_id"]


@pytest.mark.parametrize("name", WORKER_PARAMETERS)
def test_each_platforms_parameter_names_the_worker(name: str) -> None:
    assert worker_id({name: "somebody", "unrelated": "other"}) == "somebody"


@pytest.mark.parametrize("name", WORKER_PARAMETERS)
def test_a_parameter_left_empty_names_nobody(name: str) -> None:
    assert worker_id({name: ""}) == ""


def test_an_empty_parameter_does_not_hide_a_filled_one() -> None:
    assert worker_id({"worker_id": "", "PROLIFIC_PID": "somebody"}) == "somebody"


@pytest.mark.parametrize("name", ["WORKER_ID", "prolific_pid", "assignmentId", ""])
def test_other_names_name_nobody(name: str) -> None:
    assert worker_id({name: "somebody"}) == ""


def test_the_sign_of_a_preview_is_known() -> None:
    assert is_preview({"assignmentId": "ASSIGNMENT_ID_NOT_AVAILABLE", "workerId": "w"})


@pytest.mark.parametrize(
    "address",
    [
        {},
        {"workerId": "w"},
        {"assignmentId": ""},
        {"assignmentId": "3XYZ"},
        {"assignmentId": "assignment_id_not_available"},
        {"workerId": "ASSIGNMENT_ID_NOT_AVAILABLE"},
    ],
)
def test_whoever_accepted_the_task_sees_no_preview(address: dict[str, str]) -> None:
    assert not is_preview(address)
