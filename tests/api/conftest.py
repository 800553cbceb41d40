from __future__ import annotations

import uuid
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Assignment, Dataset, Layer
from gtm_hit.ops import api_tokens
from gtm_hit.ops.work import assignments, batches, links
from tests.work_scene import make_dataset, make_layer, make_worker


class Caller:
    """A client that speaks JSON and always carries the same authority."""

    def __init__(self, authorization: str = "", user: User | None = None) -> None:
        self.client = Client()
        self.headers = {"Authorization": authorization} if authorization else {}
        if user is not None:
            self.client.force_login(user)

    def get(self, path: str, **headers: str) -> Any:
        return self.client.get(path, headers={**self.headers, **headers})

    def head(self, path: str) -> Any:
        return self.client.head(path, headers=self.headers)

    def put(self, path: str, body: Any) -> Any:
        return self.client.put(path, body, content_type="application/json", headers=self.headers)

    def post(self, path: str, body: Any = None) -> Any:
        return self.client.post(path, body or {}, content_type="application/json", headers=self.headers)


def holder(assignment: Assignment) -> Caller:
    return Caller(f"Assignment {links.assignment_token(assignment)}")


def bearer(*scopes: str) -> Caller:
    """A script with a token of these scopes; all scripts act under one name."""
    user, _made = User.objects.get_or_create(username="script", defaults={"is_superuser": True})
    _token, key = api_tokens.make(user, " ".join(scopes), scopes)
    return Caller(f"Bearer {key}")


def body(revision: int = 0, people: Any = (), **values: Any) -> dict[str, Any]:
    return {"save_id": str(uuid.uuid4()), "revision": revision, "annotations": list(people), **values}


@pytest.fixture
def dataset(db: None) -> Dataset:
    dataset = make_dataset(images=True)
    batches.make_batches(dataset)
    return dataset


@pytest.fixture
def assignment(dataset: Dataset) -> Assignment:
    return assignments.claim(make_worker("alice"), dataset)


@pytest.fixture
def alice(assignment: Assignment) -> Caller:
    return holder(assignment)


@pytest.fixture
def bob(dataset: Dataset, assignment: Assignment) -> Caller:
    """Another worker, with the next batch."""
    return holder(assignments.claim(make_worker("bob"), dataset))


@pytest.fixture
def stranger() -> Caller:
    return Caller()


@pytest.fixture
def user(db: None) -> Caller:
    """Somebody with an account who is not staff."""
    return Caller(user=User.objects.create_user("visitor", password="x"))


@pytest.fixture
def staff(db: None) -> Caller:
    return Caller(user=User.objects.create_user("manager", password="x", is_superuser=True))


@pytest.fixture
def layer(dataset: Dataset) -> Layer:
    return make_layer(dataset)
