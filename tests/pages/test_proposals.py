from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Annotation, Dataset, Job, Layer, ProposalRun, Refusal
from gtm_hit.ops.proposals import layers, runs
from tests.ops.proposals.conftest import NUMBERS, dataset  # noqa: F401
from tests.ops.proposals.watcher import shown_run, walk
from tests.work_scene import make_layer

RUNS = "/datasets/square/proposals/"
MISSING = "/datasets/square/layers/found/missing/"


@pytest.fixture
def staff(client: Client, db: None) -> Client:
    client.force_login(User.objects.create_user("ada", is_superuser=True))
    return client


@pytest.fixture
def run(dataset: Dataset) -> ProposalRun:  # noqa: F811
    return shown_run(dataset, walk(NUMBERS), alarms=["C2"])


@pytest.fixture
def found(run: ProposalRun) -> Layer:
    """Somebody is missing in frame 15."""
    made = layers.make_layer(run, "found")
    Annotation.objects.get(frame__number=15).delete()
    return made


def test_the_page_says_what_was_found_and_that_nothing_leaves_the_server(
    staff: Client, run: ProposalRun
) -> None:
    page = staff.get(RUNS).content.decode()
    assert "8 / 8" in page
    assert "C2 disagrees with all other cameras in 8 frames" in page
    assert "Nothing leaves this server" in page


def test_a_configured_address_is_named(staff: Client, run: ProposalRun, settings: Any) -> None:
    settings.DETECTOR_ADDRESSES = ["http://10.0.0.7:8080"]
    page = staff.get(RUNS).content.decode()
    assert "pictures are sent there: http://10.0.0.7:8080" in page
    assert "Nothing leaves this server" not in page


def test_a_dataset_nobody_looked_at_says_how_to_begin(staff: Client, dataset: Dataset) -> None:  # noqa: F811
    assert "Nobody has looked for people yet" in staff.get(RUNS).content.decode()


def test_the_form_starts_a_job(staff: Client, dataset: Dataset) -> None:  # noqa: F811
    answer = staff.post(RUNS, {"method": "background", "detector": "none"})
    job = Job.objects.get(kind=Job.Kind.PROPOSE)
    assert answer["Location"] == f"/jobs/{job.pk}/"
    assert job.parameters == {"method": "background", "detector": "none", "use": False}


def test_a_form_with_an_error_starts_nothing(staff: Client, dataset: Dataset) -> None:  # noqa: F811
    assert staff.post(RUNS, {"method": "magic", "detector": "http://elsewhere"}).status_code == 200
    assert not Job.objects.exists()


def test_buttons_hide_show_and_remove_a_run_and_make_its_layer(staff: Client, run: ProposalRun) -> None:
    address = f"{RUNS}{run.pk}/"
    staff.post(address, {"do": "hide"})
    assert runs.in_use(run.dataset) is None
    staff.post(address, {"do": "use"})
    assert runs.in_use(run.dataset) == run
    staff.post(address, {"do": "layer", "layer": "mine"})
    assert Layer.objects.get().name == "mine"
    refused = staff.post(address, {"do": "layer", "layer": "mine"}, follow=True)
    assert "is there already" in refused.content.decode()
    staff.post(address, {"do": "remove"})
    assert not ProposalRun.objects.exists()
    assert staff.post(address, {"do": "use"}).status_code == 404


@pytest.mark.parametrize("address", [RUNS, MISSING])
def test_strangers_are_sent_to_the_login(client: Client, found: Layer, address: str) -> None:
    assert client.get(address)["Location"].startswith("/login/")
    client.force_login(User.objects.create_user("eve"))
    assert client.get(address).status_code == 403


def test_the_missing_are_shown_with_pictures_and_placed(staff: Client, found: Layer) -> None:
    page = staff.get(MISSING).content.decode()
    assert "Frame 15" in page
    assert page.count("<svg viewBox") == 2  # as many cameras show the place
    proposal = ProposalRun.objects.get().frames.get(frame__number=15).people.get()
    body = {"decision": "place", "frame": 15, "position": proposal.position, "person": 1}
    assert "Person 1 was placed" in staff.post(MISSING, body, follow=True).content.decode()
    assert Annotation.objects.filter(layer=found).count() == 8
    assert "Nobody seems to be missing" in staff.get(MISSING).content.decode()


def test_nobody_there_is_remembered(staff: Client, found: Layer) -> None:
    proposal = ProposalRun.objects.get().frames.get(frame__number=15).people.get()
    staff.post(MISSING, {"decision": "nobody", "frame": 15, "position": proposal.position})
    assert Refusal.objects.get().user == User.objects.get()
    assert "Nobody seems to be missing" in staff.get(MISSING).content.decode()


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"decision": "place", "frame": 3, "position": 1},
        {"decision": "place", "frame": 0, "position": 10**8},
    ],
)
def test_a_wrong_decision_is_explained_and_changes_nothing(
    staff: Client, found: Layer, body: dict[str, Any]
) -> None:
    before = Annotation.objects.count()
    assert "role=" in staff.post(MISSING, body, follow=True).content.decode()
    assert Annotation.objects.count() == before


def test_a_layer_without_frames_says_so(staff: Client, dataset: Dataset) -> None:  # noqa: F811
    make_layer(dataset, "found")
    assert "Nothing is saved" in staff.get(MISSING).content.decode()
