from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Dataset

pytestmark = pytest.mark.django_db

PAGES = [
    *("compare", "compare/frames/5", "compare/view", "calibration", "releases", "import-annotations"),
    *("batches", "layers", "statistics"),
]


@pytest.fixture
def staff(client: Client) -> Client:
    Dataset.objects.create(slug="square", name="Square")
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    return client


@pytest.mark.parametrize("page", PAGES)
def test_a_page_about_something_else_does_not_count_the_dataset(staff: Client, page: str) -> None:
    with CaptureQueriesContext(
        connection,
    ) as queries:
        staff.get(f"/datasets/square/{page}/")
    found: list[dict[str, Any]] = [each for each in queries if "annotated_count" in each["sql"]]
    assert found == []


@pytest.mark.parametrize("page", PAGES)
def test_a_page_of_a_dataset_that_is_not_there_is_not_found(staff: Client, page: str) -> None:
    assert staff.get(f"/datasets/nowhere/{page}/").status_code == 404
