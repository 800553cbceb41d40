from __future__ import annotations

import json
from io import StringIO

import pytest
from django.contrib.auth.models import User
from django.core.management import CommandError, call_command

from gtm_hit.management.acting import acting_as
from gtm_hit.models import RoleChange
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role, may, may_everywhere
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db


def run(*arguments: str) -> str:
    output = StringIO()
    call_command("role", *arguments, stdout=output)
    return output.getvalue().strip()


@pytest.fixture
def ada() -> User:
    return User.objects.create_user("ada")


def fresh(user: User) -> User:
    return User.objects.get(pk=user.pk)


def test_it_gives_lists_and_takes(ada: User) -> None:
    dataset = make_dataset(frames=0)
    told = run("grant", "ada", "manager", "--dataset", "square")
    assert told == "ada is now manager of square"
    assert may(fresh(ada), Role.MANAGER, dataset)
    listed = json.loads(run("list", "--dataset", "square", "--json"))
    assert listed == {"user": "ada", "role": "manager", "dataset": "square", "superuser": False}
    assert run("revoke", "ada", "manager", "--dataset", "square") == "ada is no longer manager of square"
    assert not may(fresh(ada), Role.MANAGER)


def test_the_operator_makes_the_first_administrator(ada: User) -> None:
    run("grant", "ada", "administrator")
    assert may_everywhere(fresh(ada), Role.ADMINISTRATOR)
    assert RoleChange.objects.get().by == ""


def test_in_somebodys_name_it_asks_for_his_role(ada: User) -> None:
    other = User.objects.create_user("other")
    granting.grant(ada, Role.MANAGER)
    with pytest.raises(CommandError, match="ada may not do that: it takes the role administrator"):
        run("grant", "other", "reviewer", "--by", "ada")
    assert not may(fresh(other), Role.REVIEWER)
    granting.grant(ada, Role.ADMINISTRATOR)
    run("grant", "other", "reviewer", "--by", "ada")
    assert RoleChange.objects.first().by == "ada"  # type: ignore[union-attr]


@pytest.mark.parametrize(
    "arguments",
    [("grant", "nobody", "manager"), ("grant", "ada", "king"), ("grant", "ada", "manager", "--dataset", "x")],
)
def test_it_refuses_in_words(ada: User, arguments: tuple[str, ...]) -> None:
    with pytest.raises(CommandError):
        run(*arguments)
    assert not RoleChange.objects.exists()


def test_a_command_acts_as_the_operator_or_as_who_may(ada: User) -> None:
    dataset = make_dataset(frames=0)
    assert acting_as(None, Role.MANAGER, dataset) is None
    with pytest.raises(CommandError):
        acting_as("ada", Role.REVIEWER, dataset)
    granting.grant(ada, Role.MANAGER, dataset)
    assert acting_as("ada", Role.REVIEWER, dataset) == ada
    with pytest.raises(CommandError):
        acting_as("ada", Role.REVIEWER, None)  # for all datasets
