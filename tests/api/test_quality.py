"""What scripts can measure."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.urls import reverse
from PIL import Image as Picture

from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.quality.agreement import as_numbers, batch_agreements
from gtm_hit.ops.quality.comparing import compare, frame_lines
from gtm_hit.ops.work import assignments, batches, links
from tests.api.conftest import Caller, bearer
from tests.ops.quality.scene import two_layers
from tests.work_scene import finish, make_dataset, make_worker, row, save

BASE = "/api/v1/datasets/square/"
FILES = "/api/v1/evaluations/"


@pytest.fixture(autouse=True)
def tables(tmp_path: Path, settings: Any) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def layers(db: None) -> tuple[Layer, Layer]:
    return two_layers()


def test_statistics_have_the_coverage_asked_for(layers: tuple[Layer, Layer]) -> None:
    found = bearer("read").get(BASE + "layers/truth/statistics/?every=4").json()
    assert (found["annotations"], found["coverage"]["positions"]) == (320, 100 * 100)


def test_the_table_has_all_numbers(layers: tuple[Layer, Layer]) -> None:
    response = bearer("read").get(BASE + "layers/truth/statistics/numbers.csv")
    lines = list(csv.reader(io.StringIO(response.content.decode())))
    assert lines[0] == ["quantity", "of", "value", "unit"]
    assert ["annotations", "", "320", ""] in lines
    assert response["Content-Type"] == "text/csv; charset=utf-8"


def test_figures_come_as_svg_and_as_png(layers: tuple[Layer, Layer]) -> None:
    script = bearer("read")
    drawn = script.get(BASE + "layers/truth/statistics/coverage.svg")
    assert drawn["Content-Type"] == "image/svg+xml"
    assert drawn.content.startswith(b"<svg ")
    printed = script.get(BASE + "layers/truth/statistics/coverage.png")
    with Picture.open(io.BytesIO(printed.content)) as picture:
        assert picture.format == "PNG" and picture.width > 1000


def test_frames_come_worst_first_in_pages(layers: tuple[Layer, Layer]) -> None:
    script = bearer("read")
    page = script.get(BASE + "evaluation/frames/?truth=truth&found=found&page_size=15").json()
    expected = frame_lines(compare(*layers))
    assert (page["count"], page["results"]) == (len(expected), expected[:15])
    assert script.get(page["next"]).json()["results"] == expected[15:30]


def test_a_frame_tells_who_is_matched_and_who_is_not(layers: tuple[Layer, Layer]) -> None:
    worst = frame_lines(compare(*layers))[0]
    query = "?truth=truth&found=found"
    found = bearer("read").get(f"{BASE}evaluation/frames/{worst['frame']}/{query}").json()["marks"]
    kinds = [mark["kind"] for mark in found]
    assert (kinds.count("missed"), kinds.count("extra")) == (worst["missed"], worst["extra"])


def test_an_evaluation_may_begin_later(layers: tuple[Layer, Layer]) -> None:
    script, query = bearer("read"), BASE + "evaluation/?truth=truth&found=found"
    numbers = sorted(line["frame"] for line in frame_lines(compare(*layers)))
    assert script.get(f"{query}&start={numbers[10]}").json()["frames"] == len(numbers) - 10


@pytest.fixture
def shared(db: None) -> Dataset:
    """Two batches, each done by the same two workers."""
    dataset = make_dataset(frames=20)
    batches.make_batches(dataset, copies=2)
    for name in ("ada-lovelace", "ben-franklin"):
        for number in (0, 1):
            mine = assignments.claim(make_worker(f"{name}-{number}"), dataset)
            for frame in mine.batch.frames.all():
                save(mine.layer, frame, [row(1, 1000 + number)], author=mine.worker, done=True)
            finish(mine)
    return dataset


def test_agreement_comes_batch_by_batch_with_pseudonyms_only(shared: Dataset) -> None:
    script = bearer("read")
    response = script.get(BASE + "agreement/?page_size=1")
    first = response.json()
    assert (first["count"], first["results"]) == (2, [as_numbers(batch_agreements(shared, [1])[0])])
    assert [each["batch"] for each in script.get(first["next"]).json()["results"]] == [2]
    assert "lovelace" not in response.content.decode()


def send(caller: Caller, truth: str, found: str, **values: Any) -> Any:
    files = {
        "truth": SimpleUploadedFile("gt.txt", truth.encode()),
        "found": SimpleUploadedFile("found.txt", found.encode()),
    }
    return caller.client.post(FILES, {"step": "0.025", **files, **values}, headers=caller.headers)


def test_two_text_files_are_measured_by_each_other(db: None) -> None:
    found = send(bearer("read"), "0 100 100\n0 200 100\n", "0 112 100\n", curve="true").json()
    assert (found["moda"], found["recall"]) == (0.5, 0.5)
    assert found["modp"] == pytest.approx(0.4)
    assert len(found["curve"]) == 20


def test_a_file_may_hold_nobody(db: None) -> None:
    found = send(bearer("read"), "", "0 1 1\n").json()
    assert (found["moda"], found["precision"], found["extra"]) == (None, 0.0, 1)


def test_wrong_lines_of_both_files_are_listed(db: None) -> None:
    response = send(bearer("read"), "0 1\n", "0 1 1\n0 x 1\n")
    assert (response.status_code, response.json()["code"]) == (400, "invalid")
    reasons = [each["reason"].split(": ")[:2] for each in response.json()["details"]]
    assert reasons == [["truth.txt", "line 1"], ["found.txt", "line 2"]]


@pytest.mark.parametrize(("name", "value"), [("step", "0"), ("step", "nan"), ("radius", "-1")])
def test_lengths_that_are_none_are_refused(db: None, name: str, value: str) -> None:
    response = send(bearer("read"), "0 1 1\n", "0 1 1\n", **{name: value})
    assert (response.status_code, response.json()["code"]) == (400, "invalid")


def test_a_frame_that_was_not_compared_has_no_marks(layers: tuple[Layer, Layer]) -> None:
    address = f"{BASE}evaluation/frames/{10**30}/?truth=truth&found=found"
    assert bearer("read").get(address).status_code == 404


def test_long_files_are_for_the_command_line(db: None) -> None:
    assert send(bearer("read"), "0 1 1\n" * 400_000, "").status_code == 400
    assert send(bearer("read"), "0 1 1\n" * 900_000, "").status_code == 413


def test_measuring_files_takes_the_scope_to_read(stranger: Caller, user: Caller) -> None:
    for caller, status in [(stranger, 401), (user, 403), (bearer("import", "work", "release"), 403)]:
        assert send(caller, "0 1 1\n", "0 1 1\n").status_code == status


def test_the_link_lets_workers_in(dataset: Dataset, staff: Caller, stranger: Caller, user: Caller) -> None:
    entry = reverse("join", args=[links.entry_token(dataset)])
    assert bearer("work").get(BASE + "link/").json()["link"] == "http://testserver" + entry
    own = bearer("work").get(BASE + "link/?worker=ada&platform=prolific").json()["link"]
    assert links.read_entry(own.split("/")[-2]).external_id == "ada"
    assert staff.get(BASE + "link/").status_code == 200
    assert stranger.get(BASE + "link/").status_code == 401
    assert user.get(BASE + "link/").status_code == 403
    assert bearer("read", "import", "release").get(BASE + "link/").status_code == 403
    assert bearer("work").get(BASE + "link/?platform=a%20b").status_code == 400


def test_the_link_is_closed_and_made_anew(dataset: Dataset, staff: Caller) -> None:
    first = staff.get(BASE + "link/").json()
    assert first["closed"] is False
    closed = bearer("work").post(BASE + "link/", {"closed": True})
    assert closed.json()["closed"] is True
    again = bearer("work").post(BASE + "link/", {"closed": False}).json()
    assert again["closed"] is False and again["link"] != first["link"]


def test_closing_the_link_takes_the_scope_to_work(dataset: Dataset) -> None:
    reader = bearer("read", "import", "release")
    assert reader.post(BASE + "link/", {"closed": True}).status_code == 403


def crowd(people: int, frames: int = 1) -> str:
    return "".join(f"{frame} {column} 0\n" for frame in range(frames) for column in range(people))


def test_a_crowd_that_would_fill_the_memory_is_refused(db: None) -> None:
    response = send(bearer("read"), crowd(6000), crowd(6000))
    assert (response.status_code, response.json()["code"]) == (400, "invalid")
    assert "6000 people are in frame 0; at most 500" in response.json()["details"][0]["reason"]


def test_a_request_for_too_many_pairs_is_refused(db: None) -> None:
    response = send(bearer("read"), crowd(500, 41), crowd(500, 41))
    assert response.status_code == 400 and "pairs of people" in response.json()["details"][0]["reason"]


def test_a_full_frame_is_compared(db: None) -> None:
    response = send(bearer("read"), crowd(500), crowd(500))
    assert response.status_code == 200 and response.json()["matched"] == 500
