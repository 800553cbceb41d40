from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Job, Layer, Release
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.releases import releasing
from gtm_hit.tasks import OPERATIONS
from tests.ops.square_layer import fill, make_square
from tests.work_scene import make_layer

pytestmark = pytest.mark.django_db

PAGES = (
    "/datasets/square/releases/",
    "/datasets/square/releases/1/",
    "/datasets/square/releases/1/download/",
    "/datasets/square/releases/1/provenance.csv",
)


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.EXPORTS_ROOT = tmp_path / "exports"
    settings.RELEASES_ROOT = tmp_path / "releases"


@pytest.fixture
def layer() -> Layer:
    layer = make_layer(make_square(), "truth")
    fill(layer)
    return layer


@pytest.fixture
def made(layer: Layer, tmp_path: Path) -> Release:
    order = releasing.Order(layer, "Use it as you like.", "First light")
    return releasing.make_release(order, tmp_path / "partial", lambda *_: None)


@pytest.fixture
def staff(client: Client) -> Client:
    client.force_login(User.objects.create_user("ada", password="x", is_superuser=True))
    return client


def test_staff_see_releases_with_counts_figures_and_digests(staff: Client, made: Release) -> None:
    assert "First light" in staff.get(PAGES[0]).content.decode()
    page = staff.get(PAGES[1]).content.decode()
    assert "First light" in page and "<svg" in page and made.manifest_digest in page
    assert staff.get(PAGES[2])["Content-Type"] == "application/zip"
    assert b"".join(staff.get(PAGES[3]).streaming_content).startswith(b"frame,person")  # type: ignore[attr-defined]


@pytest.mark.parametrize("page", PAGES)
def test_nobody_else_sees_them(client: Client, made: Release, page: str) -> None:
    assert client.get(page).status_code == 302
    client.force_login(User.objects.create_user("guest", password="x"))
    assert client.get(page).status_code == 403


def test_only_parts_of_the_release_can_be_asked_for(staff: Client, made: Release) -> None:
    for name in ("cameras.json", "..%2F..%2Fsecret", "figures%2Fspeeds.svg"):
        assert staff.get(f"/datasets/square/releases/1/{name}").status_code == 404
    assert staff.get("/datasets/square/releases/2/").status_code == 404


def test_the_form_starts_a_job_that_makes_the_release(staff: Client, layer: Layer) -> None:
    answer = staff.post(
        PAGES[0], {"layer": "truth", "title": "By form", "licence": "Free.", "formats": ["csv", "coco"]}
    )
    job = Job.objects.get(kind=Job.Kind.MAKE_RELEASE)
    assert answer["Location"] == f"/jobs/{job.pk}/"
    queue.run(job.pk, OPERATIONS)
    found = Release.objects.get()
    assert (found.title, found.created_by) == ("By form", User.objects.get())
    assert found.manifest["parameters"]["formats"] == ["coco", "csv"]
    assert "/datasets/square/releases/1/" in staff.get(f"/jobs/{job.pk}/").content.decode()


@pytest.mark.parametrize(
    "change", [{"licence": " "}, {"layer": "nothing"}, {"formats": ["pdf"]}, {"formats": []}]
)
def test_a_form_with_an_error_starts_nothing(staff: Client, layer: Layer, change: dict[str, Any]) -> None:
    answer = staff.post(PAGES[0], {"layer": "truth", "licence": "Free.", "formats": ["csv"], **change})
    assert answer.status_code == 200
    assert "errorlist" in answer.content.decode()
    assert not Job.objects.exists()


def test_a_release_whose_files_are_elsewhere_says_so(staff: Client, made: Release, settings: Any) -> None:
    settings.RELEASES_ROOT = settings.RELEASES_ROOT / "elsewhere"
    assert "not on this server" in staff.get(PAGES[1]).content.decode()
    assert staff.get(PAGES[2]).status_code == 404
