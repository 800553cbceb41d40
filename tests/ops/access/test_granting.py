from __future__ import annotations

import importlib

import pytest
from django.apps import apps
from django.contrib.auth.models import AnonymousUser, Group, User

from gtm_hit.models import Dataset, Layer, Membership, RoleChange
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import (
    SEES,
    Role,
    Verdict,
    datasets_of,
    has_role,
    layers_of,
    may,
    may_everywhere,
    verdict,
)
from tests.work_scene import make_dataset, make_layer


@pytest.fixture
def here(db: None) -> Dataset:
    return make_dataset("here", frames=0)


@pytest.fixture
def elsewhere(db: None) -> Dataset:
    return make_dataset("elsewhere", frames=0)


@pytest.fixture
def ada(db: None) -> User:
    return User.objects.create_user("ada")


@pytest.fixture
def chief(db: None) -> User:
    user = User.objects.create_user("chief")
    granting.grant(user, Role.ADMINISTRATOR)
    return user


def test_a_role_for_one_dataset_is_none_for_another(ada: User, here: Dataset, elsewhere: Dataset) -> None:
    granting.grant(ada, Role.MANAGER, here)
    assert may(ada, Role.MANAGER, here) and may(ada, Role.MANAGER)
    assert not may(ada, Role.MANAGER, elsewhere) and not may_everywhere(ada, Role.MANAGER)
    assert list(datasets_of(ada)) == [here]


def test_a_group_of_djangos_is_a_role_for_all_datasets(ada: User, here: Dataset, elsewhere: Dataset) -> None:
    ada.groups.add(Group.objects.get(name="maintainer"))
    assert may_everywhere(ada, Role.MAINTAINER) and may(ada, SEES, elsewhere)
    assert set(datasets_of(ada)) == {here, elsewhere}
    assert not may(ada, Role.MANAGER)


def test_managers_review_and_maintainers_do_not(ada: User, here: Dataset) -> None:
    granting.grant(ada, Role.MAINTAINER, here)
    assert not may(ada, Role.REVIEWER, here)
    granting.grant(ada, Role.MANAGER, here)
    assert may(ada, Role.REVIEWER, here)


def test_who_is_switched_off_or_a_stranger_has_no_role(ada: User) -> None:
    granting.grant(ada, Role.ADMINISTRATOR)
    ada.is_active = False
    assert not has_role(ada) and not has_role(AnonymousUser())


def test_another_dataset_looks_as_if_it_were_not_there(ada: User, here: Dataset, elsewhere: Dataset) -> None:
    granting.grant(ada, Role.REVIEWER, here)
    assert verdict(ada, Role.MANAGER, here) is Verdict.MAY_NOT
    assert verdict(ada, Role.MANAGER, elsewhere) is verdict(ada, Role.MANAGER, None) is Verdict.HIDDEN


def test_hidden_layers_are_for_those_who_may_know_the_truth(ada: User, here: Dataset) -> None:
    seen = make_layer(here)
    truth = make_layer(here, "truth", Layer.Kind.GROUND_TRUTH, hidden=True)
    granting.grant(ada, Role.REVIEWER, here)
    granting.grant(ada, Role.MAINTAINER)
    assert list(layers_of(ada)) == [seen]
    granting.grant(ada, Role.MANAGER, here)
    assert set(layers_of(ada)) == {seen, truth}


def test_giving_and_taking_is_written_down_once(ada: User, chief: User, here: Dataset) -> None:
    RoleChange.objects.all().delete()
    assert granting.grant(ada, Role.REVIEWER, here, chief)
    assert not granting.grant(ada, Role.REVIEWER, here, chief)
    assert granting.revoke(ada, Role.REVIEWER, here)
    assert not granting.revoke(ada, Role.REVIEWER, here)
    told = RoleChange.objects.order_by("pk").values_list("by", "username", "role", "dataset", "granted")
    assert list(told) == [
        ("chief", "ada", "reviewer", "here", True),
        ("", "ada", "reviewer", "here", False),
    ]


def test_the_record_outlives_account_and_dataset(ada: User, here: Dataset) -> None:
    granting.grant(ada, Role.REVIEWER, here)
    ada.delete()
    here.delete()
    assert not Membership.objects.exists()
    assert RoleChange.objects.get().username == "ada"


@pytest.mark.parametrize("role", [Role.MANAGER, Role.MAINTAINER])
def test_only_administrators_give_roles(ada: User, here: Dataset, role: Role) -> None:
    other = User.objects.create_user("other")
    granting.grant(other, role)
    with pytest.raises(granting.RoleError):
        granting.grant(ada, Role.ANNOTATOR, here, other)
    assert not has_role(ada)


def test_an_administrator_of_a_dataset_gives_roles_there_only(
    ada: User, here: Dataset, elsewhere: Dataset
) -> None:
    local = User.objects.create_user("local")
    granting.grant(local, Role.ADMINISTRATOR, here)
    granting.grant(ada, Role.MANAGER, here, local)
    for dataset in (elsewhere, None):
        with pytest.raises(granting.RoleError):
            granting.grant(ada, Role.MANAGER, dataset, local)
    assert list(datasets_of(ada)) == [here]


def test_nobody_locks_himself_out(chief: User) -> None:
    with pytest.raises(granting.RoleError):
        granting.revoke(chief, Role.ADMINISTRATOR, None, chief)
    assert may_everywhere(chief, Role.ADMINISTRATOR)


def test_no_role_is_given_to_an_account_that_is_switched_off(ada: User, here: Dataset) -> None:
    ada.is_active = False
    with pytest.raises(granting.RoleError):
        granting.grant(ada, Role.REVIEWER, here)


def test_staff_of_before_become_administrators_and_groups_of_the_same_name_give_nothing(ada: User) -> None:
    migration = importlib.import_module("gtm_hit.migrations.0010_roles")
    staff = User.objects.create_user("staff", is_staff=True)
    old = Group.objects.get(name="manager")
    old.user_set.add(ada)
    migration.make_groups(apps, None)
    assert may_everywhere(staff, Role.ADMINISTRATOR) and not has_role(ada)
    assert RoleChange.objects.get().username == "staff"
    assert ada.groups.get().name.startswith("manager (before roles")
