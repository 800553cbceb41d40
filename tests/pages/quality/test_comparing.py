"""Statistics and comparisons as staff sees and downloads them."""

from __future__ import annotations

import csv
import io
from collections import Counter
from html import unescape
from pathlib import Path
from typing import Any
from urllib.parse import quote
from xml.etree import ElementTree

import pytest
from django.contrib.auth.models import User
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Layer
from gtm_hit.ops.work import assignments, batches
from tests.ops.quality.scene import two_layers
from tests.work_scene import add_frames, finish, make_dataset, make_layer, make_worker, row, save

BOTH = "a=truth&b=found"
PAGES = [
    "/datasets/square/statistics/?layer=truth",
    "/datasets/square/statistics/numbers.csv?layer=truth",
    "/datasets/square/statistics/speeds.svg?layer=truth",
    f"/datasets/square/compare/?{BOTH}",
    f"/datasets/square/compare/view/?{BOTH}",
    f"/datasets/square/compare/curve.svg?{BOTH}",
    f"/datasets/square/compare/frames.csv?{BOTH}",
]


@pytest.fixture(autouse=True)
def tables(tmp_path: Path, settings: Any) -> None:
    settings.TABLES_ROOT = tmp_path


@pytest.fixture
def layers(db: None) -> tuple[Layer, Layer]:
    return two_layers()


@pytest.fixture
def staff(client: Client, db: None) -> Client:
    client.force_login(User.objects.create_user("vera", is_superuser=True))
    return client


def text(response: Any) -> str:
    return response.content.decode()


@pytest.mark.parametrize("address", PAGES)
def test_strangers_are_sent_to_the_login_and_back(
    client: Client, layers: tuple[Layer, Layer], address: str
) -> None:
    response = client.get(address)
    assert response.status_code == 302
    assert response["Location"] == f"/login/?next={quote(address)}"


@pytest.mark.parametrize("address", PAGES)
def test_an_account_without_a_role_sees_nothing(
    client: Client, layers: tuple[Layer, Layer], address: str
) -> None:
    client.force_login(User.objects.create_user("curious"))
    assert client.get(address).status_code == 403


@pytest.mark.parametrize("address", PAGES)
def test_staff_sees_it_and_can_change_nothing_there(
    staff: Client, layers: tuple[Layer, Layer], address: str
) -> None:
    assert staff.get(address).status_code == 200
    assert staff.post(address).status_code == 405


def test_the_statistics_page_shows_every_figure_in_the_page(
    staff: Client, layers: tuple[Layer, Layer]
) -> None:
    page = text(staff.get("/datasets/square/statistics/?layer=truth"))
    assert page.count('<figure class="panel plot') == 8
    assert page.count('role="img"') == 8


def test_without_a_choice_the_ground_truth_is_shown(staff: Client, layers: tuple[Layer, Layer]) -> None:
    page = text(staff.get("/datasets/square/statistics/"))
    assert '<option value="truth" selected>' in page
    assert 'data-figure="square-truth-speeds"' in page


@pytest.mark.parametrize(
    "address",
    [
        "/datasets/square/statistics/?layer=nobody",
        "/datasets/square/statistics/numbers.csv?layer=nobody",
        "/datasets/square/statistics/nothing.svg?layer=truth",
        "/datasets/nowhere/statistics/",
        "/datasets/square/compare/?a=truth&b=nobody",
        f"/datasets/square/compare/?{BOTH}&radius=-1",
        f"/datasets/square/compare/?{BOTH}&radius=nan",
        f"/datasets/square/compare/view/?{BOTH}&frames=none",
        "/datasets/square/compare/view/",
        "/datasets/square/statistics/?layer=truth&every=3",
        f"/datasets/square/compare/?{BOTH}&start={10**30}",
    ],
)
def test_what_is_not_there_is_not_found(staff: Client, layers: tuple[Layer, Layer], address: str) -> None:
    assert staff.get(address).status_code == 404


def test_frames_without_anybody_have_scores_but_nothing_to_look_at(staff: Client, db: None) -> None:
    dataset = make_dataset(frames=1)
    for name in ("truth", "found"):
        save(make_layer(dataset, name), dataset.frames.get(), [], nobody=True)
    assert "Nobody is in these frames" in text(staff.get(f"/datasets/square/compare/?{BOTH}"))
    assert staff.get(f"/datasets/square/compare/view/?{BOTH}").status_code == 404


@pytest.mark.parametrize("page", ["statistics", "compare"])
def test_a_dataset_without_layers_has_the_page(staff: Client, page: str) -> None:
    make_dataset()
    assert staff.get(f"/datasets/square/{page}/").status_code == 200


def test_a_figure_is_a_file_of_its_own(staff: Client, layers: tuple[Layer, Layer]) -> None:
    response = staff.get("/datasets/square/statistics/coverage.svg?layer=truth")
    assert response["Content-Disposition"] == 'attachment; filename="square-truth-coverage.svg"'
    ElementTree.fromstring(text(response))


def test_frames_as_csv_are_the_frames_of_the_table(staff: Client, layers: tuple[Layer, Layer]) -> None:
    lines = list(csv.DictReader(io.StringIO(text(staff.get(f"/datasets/square/compare/frames.csv?{BOTH}")))))
    assert len(lines) == 40
    assert {int(line["frame"]) for line in lines} == set(range(0, 200, 5))


def test_a_frames_marks_tell_both_sides(staff: Client, layers: tuple[Layer, Layer]) -> None:
    page = text(staff.get(f"/datasets/square/compare/view/?{BOTH}&radius=0.3&frames=either"))
    address = unescape(page.split('data-marks="')[1].split('"')[0])
    assert "radius=0.3&scope=either&start=0" in address
    found = staff.get(address.replace("/frames/0/", "/frames/100/")).json()
    kinds = Counter(mark["kind"] for mark in found["marks"])
    assert kinds["matched"] > 0
    for mark in found["marks"]:
        assert (mark["truth"] is None) == (mark["kind"] == "extra")
        assert (mark["found"] is None) == (mark["kind"] == "missed")


def test_a_layer_with_many_others_before_it_is_reached_by_its_name(
    staff: Client, layers: tuple[Layer, Layer]
) -> None:
    Layer.objects.bulk_create(
        Layer(dataset=layers[0].dataset, name=f"a{number:03d}", kind=Layer.Kind.IMPORTED)
        for number in range(250)
    )
    page = text(staff.get(f"/datasets/square/compare/?{BOTH}"))
    assert "a150" in page and "a240" not in page
    assert '<option value="found" selected>' in page


def test_workers_who_agree_are_named_by_pseudonym(staff: Client, db: None) -> None:
    dataset = make_dataset(frames=2)
    batches.make_batches(dataset, copies=2)
    names = []
    for who in ("ada-lovelace", "ben-franklin"):
        mine = assignments.claim(make_worker(who), dataset)
        save(mine.layer, dataset.frames.all()[0], [row(1, 1000)], author=mine.worker)
        names.append(finish(mine).worker.pseudonym)
    page = text(staff.get("/datasets/square/compare/"))
    assert all(name in page for name in names)
    assert "lovelace" not in page and "franklin" not in page


@pytest.mark.parametrize("address", [PAGES[0], PAGES[3]])
def test_queries_do_not_grow_with_the_layers(
    staff: Client, layers: tuple[Layer, Layer], address: str
) -> None:
    before = queries_of(staff, address)
    for frame in add_frames(layers[0].dataset, 10):
        for layer in layers:
            save(layer, frame, [row(person, 500 * person) for person in range(1, 5)])
    for number in range(5):
        make_layer(layers[0].dataset, f"another-{number}")
    assert queries_of(staff, address) == before


def queries_of(client: Client, address: str) -> int:
    with CaptureQueriesContext(connection) as queries:
        assert client.get(address).status_code == 200
    return len(queries)
