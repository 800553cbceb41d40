from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Dataset
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role, may, may_everywhere
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db
PAGE = "/datasets/square/people/"


@pytest.fixture
def dataset() -> Dataset:
    return make_dataset(frames=0)


@pytest.fixture
def chief(client: Client) -> Client:
    user = User.objects.create_user("chief")
    granting.grant(user, Role.ADMINISTRATOR)
    client.force_login(user)
    return client


def text(answer: Any) -> str:
    return answer.content.decode()


def user(name: str) -> User:
    return User.objects.get(username=name)


def test_a_role_for_a_dataset_is_given_and_taken_by_buttons(chief: Client, dataset: Dataset) -> None:
    User.objects.create_user("ada")
    page = text(chief.post(PAGE, {"user": "ada", "role": "reviewer"}, follow=True))
    assert "ada has the role reviewer now." in page and "<td>given</td>" in page
    assert may(user("ada"), Role.REVIEWER, dataset) and not may_everywhere(user("ada"), Role.REVIEWER)
    page = text(chief.post(f"{PAGE}take/", {"user": "ada", "role": "reviewer"}, follow=True))
    assert "ada no longer has the role reviewer." in page and "<td>removed</td>" in page
    assert not may(user("ada"), Role.REVIEWER)


def test_a_role_for_all_datasets_is_given_and_taken(chief: Client, dataset: Dataset) -> None:
    User.objects.create_user("ada")
    chief.post("/people/", {"user": "ada", "role": "maintainer"})
    assert may_everywhere(user("ada"), Role.MAINTAINER)
    assert "ada" in text(chief.get(PAGE))  # who has it for all has it here, too
    chief.post("/people/take/", {"user": "ada", "role": "maintainer"})
    assert not may(user("ada"), Role.MAINTAINER)


def test_an_unknown_name_is_told_and_gives_nothing(chief: Client, dataset: Dataset) -> None:
    page = text(chief.post(PAGE, {"user": "nobody", "role": "reviewer"}))
    assert "There is no account nobody." in page
    assert granting.holdings(dataset) == []


@pytest.mark.parametrize("role", ["", "king"])
def test_an_unknown_role_gives_and_takes_nothing(chief: Client, dataset: Dataset, role: str) -> None:
    ada = User.objects.create_user("ada")
    granting.grant(ada, Role.REVIEWER, dataset)
    assert chief.post(PAGE, {"user": "ada", "role": role}).status_code == 200
    chief.post(f"{PAGE}take/", {"user": "ada", "role": role})
    assert [each.role for each in granting.holdings(dataset)] == [Role.REVIEWER]


def test_one_does_not_take_ones_own_administration(chief: Client, dataset: Dataset) -> None:
    page = text(chief.post("/people/take/", {"user": "chief", "role": "administrator"}, follow=True))
    assert "ask another administrator" in page
    assert may_everywhere(user("chief"), Role.ADMINISTRATOR)
    assert "Remove the role administrator of chief" not in page


def test_superusers_are_listed_and_cannot_be_taken_the_role(chief: Client) -> None:
    User.objects.create_superuser("root")
    page = text(chief.get("/people/"))
    assert "root" in page and "as a superuser" in page
    assert "Remove the role administrator of root" not in page


def test_many_people_come_in_pages_those_who_may_much_first(chief: Client, dataset: Dataset) -> None:
    for number in range(101):
        granting.grant(User.objects.create_user(f"a-{number:03d}"), Role.ANNOTATOR, dataset)
    granting.grant(User.objects.create_user("zoe"), Role.MANAGER, dataset)
    first, second = (text(chief.get(f"{PAGE}?page={page}")).split("Give a role")[0] for page in (1, 2))
    assert first.index("zoe") < first.index("a-000") and "a-099" not in first
    assert "101 to 102 of 102" in second and "a-100" in second


def test_an_empty_list_says_so(chief: Client, dataset: Dataset) -> None:
    assert "Nobody has a role for this dataset alone yet." in text(chief.get(PAGE))
