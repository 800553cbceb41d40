from __future__ import annotations

from datetime import timedelta

import pytest
from django.contrib.auth.models import User
from django.utils import timezone

from gtm_hit.models import ApiToken
from gtm_hit.ops import api_tokens
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role


@pytest.fixture
def ada(db: None) -> User:
    user = User.objects.create_user("ada")
    granting.grant(user, Role.MANAGER)
    return user


def test_a_key_finds_its_token_and_is_not_kept(ada: User) -> None:
    token, key = api_tokens.make(ada, " nightly ", ["release", "read"])
    assert api_tokens.find(key) == token
    assert (token.name, token.scopes) == ("nightly", ["read", "release"])
    assert key not in str(ApiToken.objects.values_list().get())


def test_looking_a_key_up_notes_its_use_at_most_once_a_minute(ada: User) -> None:
    token, key = api_tokens.make(ada, "nightly", ["read"])
    api_tokens.find(key)
    token.refresh_from_db()
    first = token.last_used_at
    assert first is not None
    api_tokens.find(key)
    token.refresh_from_db()
    assert token.last_used_at == first


@pytest.mark.parametrize("key", ["", "gtm_", "nonsense", "ä\udc80"])
def test_anything_else_finds_nothing(ada: User, key: str) -> None:
    api_tokens.make(ada, "nightly", ["read"])
    with pytest.raises(api_tokens.BadKey):
        api_tokens.find(key)


@pytest.mark.parametrize("ended", ["revoked", "expired", "inactive", "without a role"])
def test_a_token_ends(ada: User, ended: str) -> None:
    token, key = api_tokens.make(ada, "nightly", ["read"])
    if ended == "revoked":
        api_tokens.revoke(token)
    elif ended == "expired":
        ApiToken.objects.update(expires_at=timezone.now())
    elif ended == "inactive":
        User.objects.update(is_active=False)
    else:
        granting.revoke(ada, Role.MANAGER)
    with pytest.raises(api_tokens.BadKey):
        api_tokens.find(key)


@pytest.mark.parametrize(
    ("name", "scopes"), [("", ["read"]), ("x" * 101, ["read"]), ("x", []), ("x", ["root"])]
)
def test_senseless_tokens_are_not_made(ada: User, name: str, scopes: list[str]) -> None:
    with pytest.raises(api_tokens.TokenError):
        api_tokens.make(ada, name, scopes)
    assert not ApiToken.objects.exists()


def test_a_token_is_not_born_expired_nor_for_those_without_a_role(ada: User) -> None:
    with pytest.raises(api_tokens.TokenError):
        api_tokens.make(ada, "x", ["read"], timezone.now() - timedelta(seconds=1))
    with pytest.raises(api_tokens.TokenError):
        api_tokens.make(User.objects.create_user("visitor"), "x", ["read"])
