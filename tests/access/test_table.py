"""Every address × every role, allowed and refused, as the table says; and the table is complete."""

from __future__ import annotations

import re
from argparse import ArgumentParser, _SubParsersAction
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.management import get_commands, load_command_class
from django.db import transaction
from django.test import Client
from django.urls import URLPattern, URLResolver, get_resolver

from gtm_hit.models import ApiToken
from gtm_hit.ops import api_tokens
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.work import links
from tests.access.conftest import Places
from tests.access.scene import ELSEWHERE, SECRET, Place, somebody
from tests.access.table import COMMANDS, TABLE, WITHOUT_TOKEN

pytestmark = pytest.mark.django_db

METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE")
# What takes which role, said here once more and independently of the program.
ENOUGH = {
    "annotator": {"annotator"},
    "reviewer": {"reviewer", "manager"},
    "manager": {"manager"},
    "maintainer": {"maintainer"},
    "administrator": set[str](),
    "sees": {"reviewer", "manager", "maintainer"},
    "cares": {"manager", "maintainer"},
}


def routes(patterns: Iterable[URLPattern | URLResolver], before: str = "") -> Iterator[str]:
    """Every address but those of Django's admin, which has rights of its own."""
    for pattern in patterns:
        address = before + str(pattern.pattern)
        if isinstance(pattern, URLPattern):
            yield address
        elif pattern.app_name != "admin":
            yield from routes(pattern.url_patterns, address)


ROUTES = sorted(set(routes(get_resolver().url_patterns)))
LINES = {
    (route, method): need
    for route, needs in TABLE.items()
    for method, _colon, need in (each.partition(":") for each in needs.split())
}


def test_every_address_has_its_line_and_every_line_its_address() -> None:
    print(f"\n{len(TABLE)} addresses, {len(LINES)} lines of address and method, {len(COMMANDS)} commands")
    assert set(ROUTES) - set(TABLE) == set(), "say in tests/access/table.py who may come here"
    assert set(TABLE) - set(ROUTES) == set()
    assert list(TABLE) == sorted(TABLE)


@dataclass
class Caller:
    """Somebody, and what the table lets him do."""

    name: str
    user: User | None = None
    role: str = ""
    everywhere: bool = False
    headers: dict[str, str] = field(default_factory=dict)
    token: str = ""  # assignment, worker

    def __post_init__(self) -> None:
        self.client = Client(raise_request_exception=False)
        if self.user is not None:
            self.client.force_login(self.user)
        self.cookies = self.client.cookies.copy()

    def may(self, need: str) -> bool:
        return any(self._may(each) for each in need.removesuffix("~").split("+"))

    def _may(self, need: str) -> bool:
        name, _dash, everywhere = need.partition("-")
        if name not in ENOUGH:
            return name in {"anyone", self.token}
        if everywhere and not self.everywhere:
            return False
        return self.role in ENOUGH[name] | {"administrator"}

    def ask(self, method: str, address: str) -> Any:
        """The answer; what it wrote is taken back."""
        kind = "application/json" if "/api/" in address else "application/x-www-form-urlencoded"
        with transaction.atomic():
            self.client.cookies = self.cookies.copy()
            answer = self.client.generic(method, address, content_type=kind, headers=self.headers)
            if answer.streaming:
                b"".join(answer.streaming_content)  # closes the file, and no connection as close() does
            transaction.set_rollback(True)
        return answer


def wrong(caller: Caller, place: Place, route: str, method: str, *, allowed: bool) -> str:
    """What an answer has that it must not have; empty when it is right."""
    answer = caller.ask(method, place.address(route))
    status, to_login = answer.status_code, answer.get("Location", "").startswith("/login/")
    told = f"{method} /{route}: {caller.name} got {status}{' and the login' * to_login}"
    if status >= 500:
        return told
    loose = LINES[route, method].endswith("~")
    if "anyone" in LINES[route, method]:
        return ""
    if allowed:
        return told if status in {401, 403} or to_login or (status == 404 and not loose) else ""
    refused = status in {401, 403} or to_login or (status == 404 and not (loose and caller.role == ""))
    return "" if refused else told


def check(caller: Caller, place: Place, *, foreign: bool = False) -> None:
    """All lines at once; `foreign`: a dataset the caller has nothing to do with."""
    problems = []
    for (route, method), need in LINES.items():
        allowed = caller.may(need) and not (foreign and place.within(route))
        problems.append(wrong(caller, place, route, method, allowed=allowed))
    assert "\n".join(filter(None, problems)) == ""


ROLES = [role.value for role in Role]


@pytest.fixture(scope="module")
def holders(places: Places) -> dict[str, Caller]:
    """Each role for the dataset here, and for all."""
    found = {}
    for role in Role:
        one = somebody(f"{role.value}-here", role, places.here.dataset)
        found[role.value] = Caller(f"{role.value} here", one, role.value)
        every = somebody(f"{role.value}-everywhere", role)
        found[f"{role.value}-all"] = Caller(f"{role.value} everywhere", every, role.value, everywhere=True)
    return found


@pytest.mark.parametrize("role", ROLES)
def test_a_role_for_a_dataset_opens_there_what_the_table_says(
    places: Places, holders: dict[str, Caller], role: str
) -> None:
    check(holders[role], places.here)


@pytest.mark.parametrize("role", ROLES)
def test_a_role_for_a_dataset_opens_no_other_one(
    places: Places, holders: dict[str, Caller], role: str
) -> None:
    check(holders[role], places.elsewhere, foreign=True)


@pytest.mark.parametrize("role", ROLES)
def test_a_role_for_all_datasets_opens_each_of_them(
    places: Places, holders: dict[str, Caller], role: str
) -> None:
    check(holders[f"{role}-all"], places.elsewhere)


@pytest.mark.parametrize("staff", [False, True])
def test_an_account_without_a_role_may_nothing_not_even_as_staff(places: Places, staff: bool) -> None:
    user = User.objects.create_user(f"visitor-{staff}", is_staff=staff)
    check(Caller("an account", user), places.here)


def test_strangers_may_nothing(places: Places) -> None:
    check(Caller("a stranger"), places.here)


def test_superusers_are_administrators(places: Places) -> None:
    chief = User.objects.create_superuser("chief")
    check(Caller("a superuser", chief, "administrator", everywhere=True), places.here)


def test_an_assignments_token_opens_its_own_work_only(places: Places) -> None:
    headers = {"Authorization": f"Assignment {links.assignment_token(places.here.assignment)}"}
    check(Caller("an assignment", headers=headers, token="assignment"), places.here)


def test_a_workers_token_opens_the_tutorial_only(places: Places) -> None:
    seat = links.worker_token(places.here.assignment.worker, places.here.dataset)
    headers = {"Authorization": f"Worker {seat}"}
    check(Caller("a worker", headers=headers, token="worker"), places.here)


@pytest.mark.parametrize("role", [Role.REVIEWER, Role.MANAGER, Role.MAINTAINER, Role.ADMINISTRATOR])
def test_a_token_may_what_its_owner_may_until_the_role_is_taken(places: Places, role: Role) -> None:
    owner = somebody(f"{role.value}-script", role, places.here.dataset)
    _token, key = api_tokens.make(owner, "everything", ApiToken.Scope.values)
    caller = Caller(f"a token of a {role.value}", None, role.value)
    caller.headers = {"Authorization": f"Bearer {key}"}
    problems = []
    for taken in (False, True):
        for (route, method), need in LINES.items():
            if not route.startswith("api/") or "anyone" in need:
                continue
            forbidden = method != "GET" and route in WITHOUT_TOKEN
            allowed = caller.may(need) and not forbidden and not taken
            problems.append(wrong(caller, places.here, route, method, allowed=allowed))
            problems.append(foreign_problem(caller, places.elsewhere, route, method))
        granting.revoke(owner, role, places.here.dataset)
    assert "\n".join(filter(None, problems)) == ""


def foreign_problem(caller: Caller, place: Place, route: str, method: str) -> str:
    if not place.within(route):
        return ""
    return wrong(caller, place, route, method, allowed=False)


def test_what_has_no_line_answers_that_there_is_no_such_method(places: Places) -> None:
    chief = Caller("a superuser", User.objects.create_superuser("head"), "administrator", everywhere=True)
    for route in TABLE:
        for method in METHODS:
            if (route, method) in LINES or "anyone" in TABLE[route]:
                continue
            status = chief.ask(method, places.here.address(route)).status_code
            assert status in {401, 405}, f"{method} /{route} answers {status}: it needs a line"


@pytest.mark.parametrize("role", ROLES)
def test_no_page_and_no_list_names_another_dataset(
    places: Places, holders: dict[str, Caller], role: str
) -> None:
    caller = holders[role]
    for (route, method), need in LINES.items():
        if method == "GET" and caller.may(need) and "anyone" not in need:
            assert ELSEWHERE not in content(caller.ask("GET", places.here.address(route))).lower(), route


KNOWING = {"manager", "administrator"}


@pytest.mark.parametrize("role", ["reviewer", "maintainer", "manager", "administrator"])
def test_the_hidden_truth_is_named_and_read_only_by_who_may_know_it(
    places: Places, holders: dict[str, Caller], role: str
) -> None:
    place, caller = places.here, holders[role]
    named, read = [], []
    secret = {"layers/<str:name>": f"layers/{SECRET}", "layers/<int:layer>": f"layers/{place.hidden.pk}"}
    hidden = Place(place.dataset, place.assignment, place.hidden, place.hidden, {**place.fills, **secret})
    for (route, method), need in LINES.items():
        if not caller.may(need) or "anyone" in need:
            continue
        if method == "GET" and SECRET in content(caller.ask(method, place.address(route))):
            named.append(route)
        if re.search(r"layers/<(str:name|int:layer)>", route):
            answer = caller.ask(method, hidden.address(route))
            read += [route] if answer.status_code < 400 else []
    assert (bool(named), bool(read)) == (role in KNOWING, role in KNOWING), (named, read)


@pytest.mark.parametrize(
    "address", ["compare/?a={}&b=own", "compare/view/?a={}&b=own", "statistics/?layer={}"]
)
@pytest.mark.parametrize("role", ["reviewer", "maintainer", "manager"])
def test_nothing_is_measured_by_the_hidden_truth_for_who_may_not_know_it(
    places: Places, holders: dict[str, Caller], role: str, address: str
) -> None:
    path = f"/datasets/{places.here.dataset.slug}/{address.format(SECRET)}"
    assert holders[role].ask("GET", path).status_code == (200 if role in KNOWING else 404)


def content(answer: Any) -> str:
    return "" if answer.streaming else answer.content.decode(errors="replace")


def test_every_command_has_its_line() -> None:
    assert {name for name, app in get_commands().items() if app == "gtm_hit"} == set(COMMANDS)


@pytest.mark.parametrize("name", COMMANDS)
def test_commands_that_act_in_somebodys_name_say_so(name: str) -> None:
    parser = load_command_class("gtm_hit", name).create_parser("manage.py", name)
    named = {"by", "user", "username"} & set(destinations(parser))
    assert bool(named) == (COMMANDS[name] == "acts as")


def destinations(parser: ArgumentParser) -> Iterator[str]:
    for action in parser._actions:
        yield action.dest
        if isinstance(action, _SubParsersAction):
            for inner in action.choices.values():
                yield from destinations(inner)
