from __future__ import annotations

import re
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client
from django.utils import timezone

from gtm_hit.models import Assignment, Dataset, Layer, Worker
from gtm_hit.ops.work import assignments, batches, links, signing
from tests.work_scene import finish, make_dataset, make_layer, make_worker


@pytest.fixture
def dataset(db: None) -> Dataset:
    dataset = make_dataset()
    batches.make_batches(dataset)
    return dataset


@pytest.fixture
def entry(dataset: Dataset) -> str:
    return f"/join/{links.entry_token(dataset, 'prolific')}/"


@pytest.fixture
def worker(dataset: Dataset) -> Worker:
    return make_worker("alice")


@pytest.fixture
def home(worker: Worker, dataset: Dataset) -> str:
    return f"/work/{links.worker_token(worker, dataset)}/"


def text(response: Any) -> str:
    return response.content.decode()


def test_opening_the_entry_link_creates_nothing(client: Client, entry: str) -> None:
    response = client.get(entry + "?worker_id=5f3c")
    assert response.status_code == 200
    assert "Start" in text(response)
    assert not Worker.objects.exists()


@pytest.mark.parametrize("name", ["worker_id", "workerId", "PROLIFIC_PID", "participant_id"])
def test_the_id_is_taken_from_the_address(client: Client, entry: str, name: str) -> None:
    assert 'value="5f3c"' in text(client.get(f"{entry}?{name}=5f3c"))


def test_without_an_id_the_page_asks_for_it(client: Client, entry: str) -> None:
    assert "Your worker ID" in text(client.get(entry))


def test_start_creates_the_worker_and_leads_to_his_page(client: Client, entry: str, dataset: Dataset) -> None:
    response = client.post(entry, {"worker_id": "5f3cAbÄ漢"})
    worker = Worker.objects.get()
    assert (worker.platform, worker.external_id) == ("prolific", "5f3cAbÄ漢")
    assert response["Location"] == f"/work/{links.worker_token(worker, dataset)}/"
    assert not Assignment.objects.exists()


def test_a_known_worker_goes_straight_to_his_page(client: Client, entry: str) -> None:
    first = client.post(entry, {"worker_id": "5f3c"})
    again = client.get(entry + "?worker_id=5f3c")
    assert again["Location"] == first["Location"]
    assert Worker.objects.count() == 1


def test_the_platforms_id_is_in_no_later_address(client: Client, entry: str) -> None:
    location = client.post(entry, {"worker_id": "secret-panel-id"})["Location"]
    token = location.split("/")[2]
    assert signing.unsign_dated("worker", token) == [Worker.objects.get().pk, Dataset.objects.get().pk]
    page = client.get(location)
    assert "secret-panel-id" not in text(page)


def test_a_personal_link_ignores_ids_in_the_address(client: Client, dataset: Dataset) -> None:
    path = f"/join/{links.entry_token(dataset, 'link', 'alice')}/"
    client.post(path + "?worker_id=mallory", {"worker_id": "mallory"})
    assert Worker.objects.get().external_id == "alice"


@pytest.mark.parametrize("bad", ["", "   ", "a\x00b", "line\nbreak", "x" * 256])
def test_an_impossible_id_is_explained_and_creates_nothing(client: Client, entry: str, bad: str) -> None:
    response = client.post(entry, {"worker_id": bad})
    assert response.status_code == 400
    assert 'role="alert"' in text(response)
    assert not Worker.objects.exists()


def test_an_impossible_id_in_the_address_is_explained(client: Client, entry: str) -> None:
    assert client.get(entry + "?worker_id=a%00b").status_code == 400


def test_a_preview_shows_the_task_and_creates_nothing(client: Client, entry: str) -> None:
    path = entry + "?workerId=w&assignmentId=ASSIGNMENT_ID_NOT_AVAILABLE"
    response = client.get(path)
    assert "preview" in text(response)
    assert "<form" not in text(response).split("<main")[1]
    client.post(path, {"worker_id": "w"})
    assert not Worker.objects.exists()


@pytest.mark.parametrize(
    "path", ["/join/x/", "/work/x/", "/work/x.y/tutorial/", "/annotate/x/", "/annotate/%00/"]
)
def test_a_bad_link_gets_a_friendly_page(client: Client, db: None, path: str) -> None:
    response = client.get(path)
    assert response.status_code == 404
    assert "This link does not work" in text(response)


def test_a_token_of_another_kind_is_a_bad_link(client: Client, home: str) -> None:
    token = home.split("/")[2]
    assert client.get(f"/annotate/{token}/").status_code == 404
    assert client.get(f"/join/{token}/").status_code == 404


def test_the_start_page_takes_no_batch(client: Client, home: str) -> None:
    for _visit in range(3):
        assert client.get(home).status_code == 200
    assert client.get(home + "start/").status_code == 405
    assert not Assignment.objects.exists()


def test_start_takes_a_batch_and_again_the_same(client: Client, home: str) -> None:
    first = client.post(home + "start/")
    again = client.post(home + "start/")
    assignment = Assignment.objects.get()
    assert first["Location"] == again["Location"] == f"/annotate/{links.assignment_token(assignment)}/"


def test_the_start_page_tells_the_progress(client: Client, home: str) -> None:
    client.post(home + "start/")
    assert "0 of 10 frames done" in text(client.get(home))


def test_the_start_page_after_submission_shows_the_code_once(
    client: Client, home: str, worker: Worker, dataset: Dataset
) -> None:
    submitted = finish(assignments.claim(worker, dataset))
    assert submitted.code
    page = text(client.get(home))
    assert page.count(submitted.code) == 1
    assert "10 frames" in page


def test_nobody_elses_code_is_shown(client: Client, home: str, dataset: Dataset) -> None:
    submitted = finish(assignments.claim(make_worker("bob"), dataset))
    assert str(submitted.code) not in text(client.get(home))


def test_when_all_batches_are_taken_the_page_says_so(client: Client, home: str, dataset: Dataset) -> None:
    for name in ("bob", "carol"):
        assignments.claim(make_worker(name), dataset)
    assert "No free batch" in text(client.get(home))
    response = client.post(home + "start/")
    assert "No free batch" in text(response)
    assert Assignment.objects.count() == 2


def test_a_worker_with_a_batch_elsewhere_is_led_to_it(client: Client, home: str, worker: Worker) -> None:
    other = make_dataset("other")
    batches.make_batches(other)
    held = assignments.claim(worker, other)
    response = client.post(home + "start/")
    assert f"/annotate/{links.assignment_token(held)}/" in text(response)
    assert Assignment.objects.count() == 1


def test_the_workbench_gets_its_token_and_the_way_back(
    client: Client, home: str, worker: Worker, dataset: Dataset
) -> None:
    token = links.assignment_token(assignments.claim(worker, dataset))
    page = text(client.get(f"/annotate/{token}/"))
    tag = re.search(r"<body[^>]*>", page)
    assert tag
    assert 'data-api="/api/v1/assignment/"' in tag[0]
    assert f'data-token="{token}"' in tag[0]
    assert 'data-mode="assignment"' in tag[0]
    assert f'data-home="{home}"' in tag[0]


def test_an_expired_batch_gets_a_page_that_leads_on(client: Client, worker: Worker, dataset: Dataset) -> None:
    assignment = assignments.claim(worker, dataset)
    Assignment.objects.update(expires_at=timezone.now())
    path = f"/annotate/{links.assignment_token(assignment)}/"
    # Made anew, the key of the start page tells of another second.
    leads = re.search(r'action="(/work/[^"]+/start/)"', text(client.get(path)))
    assert leads and client.post(leads[1])["Location"] == path
    assert "data-token" in text(client.get(path))


def test_without_a_tutorial_its_address_leads_home(client: Client, home: str) -> None:
    assert client.get(home + "tutorial/")["Location"] == home


def test_the_workers_pages_are_not_kept_by_the_browser(client: Client, home: str) -> None:
    assert "no-store" in client.get(home)["Cache-Control"]


def test_instructions_of_the_dataset_are_shown_as_text(client: Client, home: str, dataset: Dataset) -> None:
    dataset.instructions = "Mark <b>sitting</b> people too."
    dataset.save()
    assert "Mark &lt;b&gt;sitting&lt;/b&gt; people too." in text(client.get(home))


@pytest.fixture
def layer(dataset: Dataset) -> Layer:
    return make_layer(dataset, "night.2")


def test_staff_open_any_layer(client: Client, layer: Layer) -> None:
    client.force_login(User.objects.create_user("manager", is_superuser=True))
    page = text(client.get("/datasets/square/layers/night.2/"))
    assert f'data-api="/api/v1/layers/{layer.pk}/"' in page
    assert 'data-home="/datasets/square/layers/"' in page


def test_strangers_are_sent_to_the_login_and_accounts_without_a_role_away(
    client: Client, layer: Layer
) -> None:
    response = client.get("/datasets/square/layers/night.2/")
    assert (response.status_code, response["Location"].split("?")[0]) == (302, "/login/")
    client.force_login(User.objects.create_user("visitor"))
    assert client.get("/datasets/square/layers/night.2/").status_code == 403


def test_a_layer_is_found_in_its_own_dataset_only(client: Client, layer: Layer) -> None:
    make_dataset("other")
    client.force_login(User.objects.create_user("manager", is_superuser=True))
    assert client.get("/datasets/other/layers/night.2/").status_code == 404
