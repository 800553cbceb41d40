from __future__ import annotations

from io import StringIO

import pytest
from django.contrib.auth.models import User
from django.core.management import CommandError, call_command

from gtm_hit.models import ApiToken
from gtm_hit.ops import api_tokens

pytestmark = pytest.mark.django_db


def run(*arguments: str) -> str:
    output = StringIO()
    call_command("maketoken", *arguments, stdout=output)
    return output.getvalue().strip()


def test_it_prints_the_key_alone() -> None:
    User.objects.create_user("ada", is_superuser=True)
    token = api_tokens.find(run("ada", "--scope", "work", "--scope", "read", "--days", "7"))
    assert token.scopes == ["read", "work"] and token.expires_at is not None


@pytest.mark.parametrize("arguments", [("nobody",), ("visitor",), ("ada", "--days", "0")])
def test_it_refuses_in_words(arguments: tuple[str, ...]) -> None:
    User.objects.create_user("ada", is_superuser=True)
    User.objects.create_user("visitor")
    with pytest.raises(CommandError):
        run(*arguments)
    assert not ApiToken.objects.exists()
