from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client


@pytest.fixture
def staff(db: None) -> Client:
    client = Client()
    client.force_login(User.objects.create_user("manager", is_superuser=True))
    return client


def send(client: Client, truth: str, found: str, **values: Any) -> Any:
    files = {
        "truth": SimpleUploadedFile("gt.txt", truth.encode()),
        "found": SimpleUploadedFile("found.txt", found.encode()),
    }
    return client.post("/evaluate/", {"step": "0.025", "radius": "0.5", **files, **values})


def test_scores_and_their_curve_are_shown(staff: Client) -> None:
    response = send(staff, "0 100 100\n0 200 100\n", "0 112 100\n")
    assert (response.context["scores"]["moda"], len(response.context["curve"])) == (0.5, 20)
    assert "1 matched, 1 missed, 0 extra" in response.content.decode()


def test_identities_are_compared_when_asked_for(staff: Client) -> None:
    response = send(staff, "0 1 1 1\n5 1 1 1\n", "0 1 1 8\n5 1 1 9\n", identities="on")
    assert response.context["scores"]["switches"] == 1
    assert "HOTA" in response.content.decode()


def test_files_without_anybody_are_shown_without_scores(staff: Client) -> None:
    assert send(staff, "", "").context["scores"]["moda"] is None


def test_wrong_lines_are_all_listed(staff: Client) -> None:
    page = send(staff, "0 1\n", "0 x 1\n").content.decode()
    assert "truth.txt: line 1" in page and "found.txt: line 1" in page


@pytest.mark.parametrize("values", [{"step": "0"}, {"radius": "nan"}, {"step": ""}])
def test_lengths_that_are_none_are_refused(staff: Client, values: dict[str, str]) -> None:
    response = send(staff, "0 1 1\n", "0 1 1\n", **values)
    assert response.status_code == 200 and not response.context["scores"]


def test_it_is_for_staff(staff: Client) -> None:
    assert staff.get("/evaluate/").status_code == 200
    assert Client().get("/evaluate/").status_code == 302
    assert send(Client(), "0 1 1\n", "0 1 1\n").status_code == 302


def test_a_crowd_that_would_fill_the_memory_is_refused(staff: Client) -> None:
    many = "".join(f"7 {column} 0\n" for column in range(3000))
    response = send(staff, many, "7 0 0\n")
    assert "3000 people are in frame 7; at most 500 are compared" in response.content.decode()
