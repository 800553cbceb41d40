from __future__ import annotations

import re

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import ApiToken
from gtm_hit.ops import api_tokens
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role

pytestmark = pytest.mark.django_db


def manager(name: str) -> User:
    user = User.objects.create_user(name)
    granting.grant(user, Role.MANAGER)
    return user


@pytest.fixture
def ada(client: Client) -> Client:
    client.force_login(manager("ada"))
    return client


def test_the_key_is_shown_once(ada: Client) -> None:
    page = ada.post("/tokens/", {"name": "nightly", "scopes": ["read"], "days": "30"}).content.decode()
    key = re.search(r'value="(gtm_[\w-]+)" data-copy-source', page)
    assert key and api_tokens.find(key[1]).name == "nightly"
    page = ada.get("/tokens/").content.decode()
    assert "nightly" in page and key[1] not in page


def test_without_scopes_nothing_is_made(ada: Client) -> None:
    assert ada.post("/tokens/", {"name": "nightly"}).status_code == 200
    assert not ApiToken.objects.exists()


def test_one_revokes_own_tokens_and_no_others(ada: Client) -> None:
    own, _key = api_tokens.make(User.objects.get(), "own", ["read"])
    foreign, _key = api_tokens.make(manager("bob"), "of bob", ["read"])
    assert ada.post(f"/tokens/{own.pk}/revoke/").status_code == 302
    assert ada.post(f"/tokens/{foreign.pk}/revoke/").status_code == 404
    assert "of bob" not in ada.get("/tokens/").content.decode()
    assert list(api_tokens.valid()) == [foreign]


def test_administrators_revoke_everybodys(client: Client) -> None:
    client.force_login(User.objects.create_superuser("root"))
    foreign, _key = api_tokens.make(manager("bob"), "of bob", ["read"])
    assert "of bob" in client.get("/tokens/").content.decode()
    client.post(f"/tokens/{foreign.pk}/revoke/")
    assert not api_tokens.valid().exists()


def test_others_see_and_make_no_tokens(client: Client) -> None:
    client.force_login(User.objects.create_user("visitor"))
    assert client.get("/tokens/").status_code == 403
    assert client.post("/tokens/", {"name": "x", "scopes": ["read"]}).status_code == 403
    assert not ApiToken.objects.exists()
