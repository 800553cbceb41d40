from __future__ import annotations

import pytest
from django.contrib.auth.models import User

from gtm_hit.models import Dataset
from gtm_hit.ops.access.roles import Role, may, may_everywhere
from tests.api.conftest import Caller, bearer

HERE, EVERYWHERE = "/api/v1/datasets/square/roles/", "/api/v1/roles/"


@pytest.fixture
def ada(db: None) -> User:
    return User.objects.create_user("ada")


def fresh(user: User) -> User:
    return User.objects.get(pk=user.pk)


def test_a_role_for_a_dataset_is_given_listed_and_taken(staff: Caller, dataset: Dataset, ada: User) -> None:
    given = staff.post(HERE, {"user": "ada", "role": "manager"})
    expected = [{"user": "ada", "role": "manager", "superuser": False}]
    assert (given.status_code, given.json()["results"]) == (200, expected)
    assert may(fresh(ada), Role.MANAGER, dataset) and not may_everywhere(fresh(ada), Role.MANAGER)
    assert staff.get(HERE).json()["results"] == expected
    assert staff.post(f"{HERE}take/", {"user": "ada", "role": "manager"}).json()["results"] == []
    assert not may(fresh(ada), Role.MANAGER)


def test_a_role_for_all_datasets_is_given_and_taken(staff: Caller, ada: User) -> None:
    staff.post(EVERYWHERE, {"user": "ada", "role": "reviewer"})
    assert may_everywhere(fresh(ada), Role.REVIEWER)
    staff.post(f"{EVERYWHERE}take/", {"user": "ada", "role": "reviewer"})
    assert not may(fresh(ada), Role.REVIEWER)


@pytest.mark.parametrize(
    "wrong", [{"user": "nobody", "role": "manager"}, {"user": "ada", "role": "king"}, {}]
)
def test_what_does_not_exist_is_refused(staff: Caller, dataset: Dataset, ada: User, wrong: object) -> None:
    assert staff.post(HERE, wrong).status_code == 400
    assert staff.get(HERE).json()["results"] == []


def test_no_token_gives_roles_but_it_lists_them(dataset: Dataset, ada: User) -> None:
    script = bearer("read", "import", "work", "release")
    assert script.get(HERE).status_code == 200
    refused = script.post(HERE, {"user": "ada", "role": "administrator"})
    assert (refused.status_code, "at the browser" in refused.json()["message"]) == (403, True)
    assert not may(fresh(ada), Role.ADMINISTRATOR)
