from __future__ import annotations

from typing import Any

import pytest
from django.core.management import call_command
from django.db import OperationalError

from gtm_hit.api.workbench import frames
from gtm_hit.models import Save
from tests.api.conftest import Caller, body

FRAME = "/api/v1/assignment/frames/5/"


def send(caller: Caller, content: bytes | str, content_type: str = "application/json") -> Any:
    return caller.client.put(FRAME, content, content_type=content_type, headers=caller.headers)


def code(response: Any) -> tuple[int, str]:
    answer = response.json()
    assert set(answer) == {"code", "message", "details"}
    assert answer["message"]
    return response.status_code, answer["code"]


@pytest.mark.parametrize(
    "content",
    ["{", b"\xff\xfe", "[" * 100_000, '{"revision": ' + "9" * 5000 + "}", '{"seconds": NaN}', "\x00"],
)
def test_what_is_no_json_is_unreadable(alice: Caller, content: bytes | str) -> None:
    assert code(send(alice, content)) == (400, "unreadable")


@pytest.mark.parametrize("content", ["", "[]", "1", "null", '"x"', "{}", "true"])
def test_json_of_another_shape_is_invalid(alice: Caller, content: str) -> None:
    assert code(send(alice, content)) == (400, "invalid")
    assert not Save.objects.exists()


@pytest.mark.parametrize(
    "annotations",
    [[{f"{number:012d}": 1 for number in range(40_000)}], [{"x" * 900_000: 1}], [3] * 501, [{}] * 500],
)
def test_a_megabyte_of_nonsense_gets_a_short_answer(alice: Caller, annotations: list[Any]) -> None:
    response = alice.put(FRAME, body(people=annotations))
    assert response.status_code == 400
    assert len(response.content) < 50_000


def test_other_formats_are_refused(alice: Caller) -> None:
    assert code(send(alice, "a=1", "application/x-www-form-urlencoded")) == (415, "unsupported_media_type")


def test_a_body_beyond_a_megabyte_is_too_large(alice: Caller) -> None:
    assert code(send(alice, '{"x": "' + "a" * 1024 * 1024 + '"}')) == (413, "too_large")


def test_other_methods_are_refused(alice: Caller) -> None:
    assert code(alice.post(FRAME)) == (405, "method_not_allowed")


@pytest.mark.parametrize("path", ["", "nothing/", "assignment/", "layers/x/scene/", "layers/-1/scene/"])
def test_an_address_that_is_not_there_answers_in_the_same_shape(db: None, path: str) -> None:
    assert code(Caller().get("/api/v1/" + path)) == (404, "not_found")


def test_a_busy_database_asks_to_try_again(alice: Caller, monkeypatch: pytest.MonkeyPatch) -> None:
    def locked(*_arguments: Any, **_values: Any) -> None:
        raise OperationalError("database is locked")

    monkeypatch.setattr(frames, "save_frame", locked)
    response = alice.put(FRAME, body())
    assert code(response) == (503, "busy")
    assert response["Retry-After"]


def test_a_mistake_of_the_program_is_noted_and_told(alice: Caller, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_arguments: Any, **_values: Any) -> None:
        raise ZeroDivisionError("secret detail")

    monkeypatch.setattr(frames, "save_frame", broken)
    alice.client.raise_request_exception = False
    response = alice.put(FRAME, body())
    assert code(response) == (500, "error")
    assert b"secret detail" not in response.content


def test_the_api_is_described_without_a_warning(tmp_path: Any, db: None) -> None:
    file = tmp_path / "schema.yml"
    call_command("spectacular", "--validate", "--fail-on-warn", file=str(file))
    assert "/api/v1/assignment/frames/{number}/:" in file.read_text()


@pytest.mark.parametrize("path", ["/api/v1/schema/", "/api/v1/docs/"])
@pytest.mark.parametrize(("caller", "status"), [("staff", 200), ("user", 403), ("stranger", 401)])
def test_the_description_is_for_staff(
    path: str, caller: str, status: int, request: pytest.FixtureRequest
) -> None:
    assert request.getfixturevalue(caller).get(path).status_code == status


def test_the_documentation_loads_nothing_from_outside(staff: Caller) -> None:
    assert b"//cdn" not in staff.get("/api/v1/docs/").content
