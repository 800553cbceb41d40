"""Messages of Prolific at our door."""

from __future__ import annotations

import time
from typing import Any

import pytest
from django.test import Client

from gtm_hit.models import Assignment, Campaign, HookEvent, Submission
from tests.paid_campaign import assign, make_account, make_campaign
from tests.prolific_server import deliver, hook_body, hook_headers
from tests.work_scene import make_worker

SECRET = "hook-secret"
DOOR = "/hooks/prolific/square/autumn/"


@pytest.fixture
def campaign(db: None) -> Campaign:
    campaign = make_campaign(platform=Campaign.Platform.PROLIFIC)
    make_account(campaign, hook_secret=SECRET)
    return campaign


@pytest.fixture
def work(campaign: Campaign) -> Assignment:
    return assign(campaign, make_worker("ada", "prolific"), Assignment.State.LEASED, submission="s1")


def post(body: bytes, secret: str = SECRET, at: float | None = None, door: str = DOOR, **headers: str) -> Any:
    sent = {**hook_headers(secret, body, time.time() if at is None else at), **headers}
    return Client().post(door, body, content_type="application/json", headers=sent)


def state(work: Assignment) -> str:
    work.refresh_from_db()
    return work.state


def test_a_signed_return_frees_the_batch(work: Assignment) -> None:
    assert post(hook_body("s1", "RETURNED")).status_code == 204
    assert state(work) == "expired"


def test_the_same_message_again_is_answered_and_changes_nothing(work: Assignment) -> None:
    body = hook_body("s1", "TIMED-OUT")
    for _again in range(2):
        assert post(body, at=1_800_000_000, **{"X-Event-ID": "e1"}).status_code == 204
    assert HookEvent.objects.count() == 1


def test_a_message_about_long_ago_is_answered_and_changes_nothing(work: Assignment) -> None:
    post(hook_body("s1", "ACTIVE"), **{"X-Timestamp": "1800000000"})
    post(hook_body("s1", "TIMED-OUT"), **{"X-Timestamp": "1700000000"})
    assert (state(work), Submission.objects.get().status) == ("leased", "ACTIVE")


@pytest.mark.parametrize("secret", ["other", ""])
def test_whoever_cannot_sign_is_nobody(work: Assignment, secret: str) -> None:
    assert post(hook_body("s1", "RETURNED"), secret).status_code == 403
    assert (state(work), HookEvent.objects.count()) == ("leased", 0)


def test_a_signature_is_for_one_body_and_time(work: Assignment) -> None:
    headers = hook_headers(SECRET, hook_body("s1", "ACTIVE"), 1_800_000_000)
    other = hook_body("s1", "RETURNED")
    assert Client().post(DOOR, other, content_type="application/json", headers=headers).status_code == 403


def test_without_a_secret_nobody_is_believed(work: Assignment, campaign: Campaign) -> None:
    campaign.account.hook_secret = ""
    campaign.account.save()
    assert post(hook_body("s1", "RETURNED"), "").status_code == 403


def test_a_campaign_that_is_not_there_looks_like_a_wrong_secret(work: Assignment) -> None:
    assert post(hook_body("s1", "RETURNED"), door="/hooks/prolific/square/winter/").status_code == 403


@pytest.mark.parametrize("body", [b"", b"[]", b"{}", b"\xff", b'{"event_type": 5, "resource_id": []}'])
def test_what_is_signed_and_says_nothing_is_a_bad_request(work: Assignment, body: bytes) -> None:
    assert post(body).status_code == 400
    assert state(work) == "leased"


def test_too_much_is_not_read(work: Assignment) -> None:
    assert post(b"{" + b" " * 70_000 + b"}").status_code == 413


@pytest.mark.django_db(transaction=True)
def test_the_platform_delivers_over_http(live_server: Any, work: Assignment) -> None:
    body = hook_body("s1", "RETURNED")
    assert deliver(live_server.url + DOOR, body, hook_headers(SECRET, body, time.time())) == 204
    assert state(work) == "expired"
