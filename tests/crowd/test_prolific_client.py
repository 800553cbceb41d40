"""The client against a stand-in of Prolific, over real HTTP."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from decimal import Decimal
from typing import Any

import pytest

from gtm_hit.crowd import http_json
from gtm_hit.crowd.prolific_client import ProlificClient, bonus_lines, units, work_of
from gtm_hit.ops.outbox.platform import (
    Bonus,
    NotSent,
    PlatformError,
    Refused,
    StudyDraft,
    TooFast,
    Unanswered,
)
from tests.prolific_server import TOKEN, Prolific, prolific_server
from tests.services import free_port

DRAFT = StudyDraft(
    title="Mark people",
    description="Mark people in seven views.",
    address="https://gtm.example/join/x/?PROLIFIC_PID={{%PROLIFIC_PID%}}",
    places=12,
    minutes=15,
    reward=Decimal("2.25"),
    completion_code="CODE1",
)
REASON = (
    "Most of the people who stand near the fountain were not marked in any of the ten frames of this batch."
)


@pytest.fixture
def prolific() -> Iterator[Prolific]:
    with prolific_server() as server:
        server.add("s1", "p1")
        yield server


def client(server: Prolific, token: str = TOKEN, waited: list[float] | None = None) -> ProlificClient:
    sleep = (waited if waited is not None else []).append
    return ProlificClient.at(server.base, token, timeout=5.0, sleep=sleep)


def test_a_study_is_drafted_published_paused_and_resumed(prolific: Prolific) -> None:
    mine = client(prolific)
    study = mine.create_study(DRAFT)
    kept = prolific.studies[study.identifier]
    assert (study.state, kept["reward"], kept["total_available_places"]) == ("UNPUBLISHED", 225, 12)
    states = [mine.change_study(study.identifier, how).state for how in ("publish", "pause", "resume")]
    assert states == ["ACTIVE", "PAUSED", "ACTIVE"]
    assert mine.study(study.identifier).state == "ACTIVE"


def test_all_pages_of_submissions_are_read(prolific: Prolific) -> None:
    for number in range(250):
        prolific.add(f"many-{number}", study="st2")
    assert len(list(client(prolific).submissions("st2"))) == 250


def test_a_submission_is_approved_and_again_without_harm(prolific: Prolific) -> None:
    for _again in range(2):
        client(prolific).approve("s1")
    assert client(prolific).submission("s1").status == "APPROVED"


def test_a_rejection_carries_its_reason_and_category(prolific: Prolific) -> None:
    client(prolific).reject("s1", REASON, "LOW_EFFORT")
    assert prolific.submissions["s1"]["message"] == REASON


@pytest.mark.parametrize(("message", "category"), [(REASON[:99], "LOW_EFFORT"), (REASON, "BECAUSE")])
def test_a_rejection_without_a_proper_reason_is_never_sent(
    prolific: Prolific, message: str, category: str
) -> None:
    with pytest.raises(Refused):
        client(prolific).reject("s1", message, category)
    assert prolific.asked == []


def test_a_return_is_asked_for(prolific: Prolific) -> None:
    client(prolific).request_return("s1", ["Withdrew consent"])
    assert client(prolific).submission("s1").return_requested


def test_a_bonus_is_set_up_and_then_paid(prolific: Prolific) -> None:
    mine = client(prolific)
    prepared = mine.set_up_bonuses("st1", [Bonus("p1", Decimal("0.70"))])
    assert prolific.payments == []
    mine.pay_bonuses(prepared)
    assert mine.submission("s1").bonuses == (Decimal("0.70"),)


def test_whole_amounts_are_written_with_their_cents() -> None:
    assert bonus_lines([Bonus("p1", Decimal(30)), Bonus("p2", Decimal("1.5"))]) == "p1,30.00\np2,1.50"


@pytest.mark.parametrize(
    "bonus", [Bonus("p1,99", Decimal(1)), Bonus("p1\np2", Decimal(1)), Bonus("p1", Decimal(0))]
)
def test_a_bonus_that_would_be_read_as_another_is_refused(bonus: Bonus) -> None:
    with pytest.raises(Refused):
        bonus_lines([bonus])


@pytest.mark.parametrize("cents", [70, 70.0, "70"])
def test_cents_come_back_as_they_like(cents: Any) -> None:
    assert units(cents) == Decimal("0.70")


def test_a_wrong_key_is_refused_in_prolifics_words(prolific: Prolific) -> None:
    with pytest.raises(Refused, match="credentials") as caught:
        client(prolific, "wrong").approve("s1")
    assert caught.value.status == 401


def test_a_question_waits_as_long_as_it_is_asked_to(prolific: Prolific) -> None:
    prolific.go_wrong("submissions", "status", status=429, retry_after="3", method="GET")
    waited: list[float] = []
    assert client(prolific, waited=waited).submission("s1").status == "AWAITING REVIEW"
    assert waited == [3.0]


def test_a_question_that_would_wait_too_long_gives_up(prolific: Prolific) -> None:
    prolific.go_wrong("submissions", "status", status=429, retry_after="900", method="GET")
    with pytest.raises(TooFast) as caught:
        client(prolific).submission("s1")
    assert caught.value.seconds == 900


def test_a_question_outlives_errors_and_lost_connections(prolific: Prolific) -> None:
    prolific.go_wrong("submissions", "status", status=503, method="GET")
    prolific.go_wrong("submissions", "drop_before", method="GET")
    waited: list[float] = []
    client(prolific, waited=waited).submission("s1")
    assert waited == [0.5, 1.0]


@pytest.mark.parametrize("how", ["drop_before", "drop_after"])
def test_a_lost_answer_is_told_from_a_refusal_and_nothing_is_repeated(prolific: Prolific, how: str) -> None:
    prolific.go_wrong("transition", how)
    with pytest.raises(Unanswered):
        client(prolific).approve("s1")
    assert prolific.count("POST /api/v1/submissions/s1/transition/") == 1


def test_a_server_error_after_a_change_may_have_done_it(prolific: Prolific) -> None:
    prolific.go_wrong("transition", "status_after", status=502)
    with pytest.raises(Unanswered):
        client(prolific).approve("s1")


def test_nobody_there_means_that_nothing_was_sent() -> None:
    nowhere = ProlificClient.at(f"http://127.0.0.1:{free_port()}", TOKEN, timeout=5.0)
    with pytest.raises(NotSent):
        nowhere.approve("s1")


def test_a_server_that_never_answers_is_given_up() -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        mine = ProlificClient.at(f"http://127.0.0.1:{silent.getsockname()[1]}", TOKEN, timeout=0.3)
        with pytest.raises(Unanswered):
            mine.approve("s1")


def test_an_endless_answer_is_not_read(prolific: Prolific, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(http_json, "MOST_BYTES", 50)
    with pytest.raises(PlatformError, match="larger"):
        client(prolific).submission("s1")


@pytest.mark.parametrize(
    ("header", "seconds"),
    [
        ("7", 7.0),
        ("Thu, 01 Jan 1970 00:01:40 GMT", 40.0),
        ("", 5.0),
        ("soon", 5.0),
        ("-3", 0.0),
        ("nan", 5.0),
    ],
)
def test_retry_after_is_read_in_both_its_forms(header: str, seconds: float) -> None:
    assert http_json.seconds_to_wait(header, now=lambda: 60.0) == seconds


def test_both_spellings_of_a_status_are_one() -> None:
    assert work_of({"id": "s1", "status": "TIMED-OUT"}).status == "TIMED-OUT"
    assert work_of({"id": "s1", "status": "AWAITING_REVIEW"}).status == "AWAITING REVIEW"
