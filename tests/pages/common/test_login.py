from __future__ import annotations

import logging
from datetime import timedelta
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client
from django.utils import timezone

from gtm_hit.models import Attempt
from gtm_hit.pages.common import login

PASSWORD = "long enough"


@pytest.fixture(autouse=True)
def vera(db: None) -> User:
    return User.objects.create_user("vera", password=PASSWORD, is_superuser=True)


def attempt(password: str, name: str = "vera", address: str = "192.0.2.1") -> Any:
    return Client(REMOTE_ADDR=address).post("/login/", {"username": name, "password": password})


def fail(times: int, **values: str) -> None:
    for _number in range(times):
        assert attempt("wrong", **values).status_code == 200


def test_after_too_many_failures_the_right_password_is_refused_too() -> None:
    fail(login.PAIR.most)
    response = attempt(PASSWORD)
    assert response.status_code == 429
    assert 800 < int(response["Retry-After"]) <= 901
    assert "Too many failed attempts. Try again at" in response.content.decode()


def test_a_limited_login_hashes_no_password(monkeypatch: pytest.MonkeyPatch) -> None:
    fail(login.PAIR.most)
    monkeypatch.setattr("django.contrib.auth.forms.authenticate", lambda *_a, **_k: pytest.fail("was asked"))
    assert attempt(PASSWORD).status_code == 429


def test_after_the_time_told_the_door_is_open_again() -> None:
    fail(login.PAIR.most)
    Attempt.objects.update(at=timezone.now() - login.SPAN - timedelta(seconds=1))
    assert attempt(PASSWORD).status_code == 302


def test_others_at_the_address_and_she_elsewhere_may_still_come_in() -> None:
    User.objects.create_user("ada", password=PASSWORD, is_superuser=True)
    fail(login.PAIR.most)
    assert attempt(PASSWORD, name="ada").status_code == 302
    assert attempt(PASSWORD, address="192.0.2.2").status_code == 302


def test_names_of_every_spelling_count_as_one() -> None:
    for number in range(login.PAIR.most):
        attempt("wrong", name="vera" if number % 2 else "VERA")
    assert attempt(PASSWORD).status_code == 429


def test_one_address_that_tries_many_names_is_stopped() -> None:
    for number in range(login.ADDRESS.most):
        attempt("wrong", name=f"name {number}")
    assert attempt(PASSWORD).status_code == 429


def test_one_name_tried_from_many_addresses_is_stopped() -> None:
    for number in range(login.NAME.most):
        attempt("wrong", address=f"198.51.100.{number}")
    assert attempt(PASSWORD).status_code == 429


def test_a_right_password_ends_the_counting() -> None:
    fail(login.PAIR.most - 1)
    assert attempt(PASSWORD).status_code == 302
    fail(login.PAIR.most - 1)
    assert attempt(PASSWORD).status_code == 302


def test_failures_are_logged_with_name_and_address_and_without_passwords(
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level(logging.INFO, "gtm_hit.pages.common.login")
    attempt("my secret"), attempt(PASSWORD)
    said = [(record.levelname, record.getMessage()) for record in caplog.records]
    assert ("WARNING", "login failed: 'vera' from 192.0.2.1") in said
    assert ("INFO", "login: 'vera' from 192.0.2.1") in said
    assert "my secret" not in caplog.text and PASSWORD not in caplog.text


def test_the_administration_has_no_door_of_its_own(client: Client) -> None:
    response = client.get("/admin/login/?next=/admin/")
    assert response["Location"] == "/login/?next=/admin/"
    posted = client.post("/admin/login/", {"username": "vera", "password": PASSWORD}, follow=True)
    assert not posted.wsgi_request.user.is_authenticated
