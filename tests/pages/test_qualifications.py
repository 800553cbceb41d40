"""Qualifications on the manager's pages, and on the worker's."""

from __future__ import annotations

import re
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.base import ContentFile
from django.core.files.storage import default_storage
from django.test import Client

from gtm_hit.models import Assignment, Campaign, Image, Qualification, QualificationGrant, Worker
from gtm_hit.ops.files.images import storage_name
from gtm_hit.ops.qualifications import attempts, managing
from gtm_hit.ops.qualifications.managing import Order
from gtm_hit.ops.work import links
from tests.gold_scene import hand_in, make_scene, truth_of_square
from tests.scoring.people import moved
from tests.work_scene import make_worker

pytestmark = pytest.mark.django_db
PAGE = "/datasets/square/qualifications/"
MARKS = {"tries": 2, "recall": 90, "precision": 90, "identity": 80, "median": 15, "p95": 40}
NEW = {
    "name": "basics",
    "title": "The basics",
    "layer": "truth",
    "first_frame": 0,
    "frames_per_try": 4,
    **MARKS,
}


@pytest.fixture
def campaign() -> Campaign:
    return make_scene(images=True)[0]


@pytest.fixture
def basics(campaign: Campaign) -> Qualification:
    truth = campaign.dataset.layers.get(name="truth")
    return managing.create(campaign.dataset, Order("basics", truth, "The basics", frames_per_try=4))


@pytest.fixture
def manager() -> Client:
    client = Client()
    client.force_login(User.objects.create_user("manager", password="x", is_superuser=True))
    return client


@pytest.fixture
def alice(campaign: Campaign) -> Worker:
    return make_worker("alice")


@pytest.fixture
def home(alice: Worker, campaign: Campaign) -> str:
    return f"/work/{links.worker_token(alice, campaign.dataset)}/qualifications/"


def text(answer: Any) -> str:
    return answer.content.decode()


def test_a_manager_makes_one(manager: Client, campaign: Campaign) -> None:
    assert "No qualifications yet" in text(manager.get(PAGE))
    assert manager.post(PAGE, NEW).status_code == 302
    made = Qualification.objects.get()
    assert (made.min_recall, made.max_median, made.max_p95, made.min_idf1) == (0.9, 0.15, 0.4, 0.8)
    assert made.frames.count() == 8
    assert "The basics" in text(manager.get(PAGE))


def test_what_cannot_be_is_said_and_makes_nothing(manager: Client, campaign: Campaign) -> None:
    answer = manager.post(PAGE, {**NEW, "frames_per_try": 50})
    assert answer.status_code == 400
    assert "knows only 20 frames" in text(answer)
    assert not Qualification.objects.exists()


@pytest.mark.parametrize("path", ["", "basics/", "basics/decide/"])
def test_only_staff_gets_there(client: Client, basics: Qualification, path: str) -> None:
    assert client.post(PAGE + path, {**NEW, "what": "close"}).status_code == 302
    client.force_login(User.objects.create_user("visitor", password="x"))
    assert client.post(PAGE + path, {**NEW, "what": "close"}).status_code == 403
    basics.refresh_from_db()
    assert basics.closed_at is None
    assert Qualification.objects.count() == 1


def test_marks_are_changed(manager: Client, basics: Qualification) -> None:
    assert manager.post(f"{PAGE}basics/", {**MARKS, "recall": 95, "title": "New"}).status_code == 302
    basics.refresh_from_db()
    assert (basics.min_recall, basics.title) == (0.95, "New")


def test_granted_and_revoked_by_hand_with_who_and_why(
    manager: Client, basics: Qualification, alice: Worker
) -> None:
    decide = f"{PAGE}basics/decide/"
    manager.post(decide, {"what": "grant", "worker": alice.pseudonym, "why": "an old hand"})
    refused = manager.post(decide, {"what": "revoke", "worker": alice.pseudonym}, follow=True)
    assert "Say why" in text(refused)
    manager.post(decide, {"what": "revoke", "worker": alice.pseudonym, "why": "shared an account"})
    told = [
        (one.granted, one.by.username, one.why) for one in QualificationGrant.objects.order_by("pk") if one.by
    ]
    assert told == [(True, "manager", "an old hand"), (False, "manager", "shared an account")]


def test_a_worker_nobody_knows_is_said(manager: Client, basics: Qualification) -> None:
    for nobody in ("w-0", "w\x00"):
        answer = manager.post(f"{PAGE}basics/decide/", {"what": "grant", "worker": nobody}, follow=True)
        assert "There is no worker w" in text(answer)


def test_a_worker_begins_a_try_by_a_button(client: Client, basics: Qualification, home: str) -> None:
    assert "The basics" in text(client.get(home))
    assert client.get(f"{home}basics/").status_code == 200
    assert not Assignment.objects.exists()
    answer = client.post(f"{home}basics/")
    assert answer.status_code == 302
    assert answer["Location"].startswith("/annotate/")


def test_afterwards_the_worker_sees_every_mistake_worst_first(
    client: Client, basics: Qualification, alice: Worker, home: str
) -> None:
    people = truth_of_square()
    del people[0][3]
    people[5][4] = moved(people[5][4], 0.3)
    hand_in(attempts.begin(basics, alice), people)
    page = text(client.get(f"{home}basics/"))
    assert "You passed" in page
    missed, off = page.index("whom you did not mark"), page.index("Your box stands 0.30 m from")
    assert missed < off
    assert page.count('<rect class="box truth"') > page.count('<rect class="box found"') > 0


def test_nothing_of_the_truth_is_shown_before_it_is_judged(
    client: Client, basics: Qualification, alice: Worker, home: str
) -> None:
    attempts.begin(basics, alice)
    page = text(client.get(f"{home}basics/"))
    assert "mistake" not in page.replace("Afterwards you see your mistakes.", "")
    assert "<image" not in page


def test_pictures_of_mistakes_are_for_the_worker_whose_try_it_is(
    client: Client, basics: Qualification, alice: Worker, home: str, campaign: Campaign
) -> None:
    from PIL import Image as Picture

    hand_in(attempts.begin(basics, alice), {})
    for image in Image.objects.filter(frame__dataset=campaign.dataset):
        name = storage_name(image.full_digest)
        if not default_storage.exists(name):
            import io

            written = io.BytesIO()
            Picture.new("RGB", (1920, 1080)).save(written, "JPEG")
            default_storage.save(name, ContentFile(written.getvalue()))
    page = text(client.get(f"{home}basics/"))
    address = re.findall(r'<image href="([^"]+)"', page)[0]
    answer = client.get(address)
    assert (answer.status_code, answer["Content-Type"]) == (200, "image/jpeg")
    other = f"/work/{links.worker_token(make_worker('bob'), campaign.dataset)}/"
    assert client.get(other + address.split("/", 3)[3]).status_code == 404
    assert client.get(re.sub(r"\d+-\d+-\d+\.jpg", "1900-1000-500.jpg", address)).status_code == 404
    token = address.split("/")[2]
    assert client.get(address.replace(f"/{token}/", "/nonsense/")).status_code == 404


def test_without_tries_left_the_button_says_so(
    client: Client, basics: Qualification, alice: Worker, home: str
) -> None:
    for _try in range(2):
        hand_in(attempts.begin(basics, alice), {})
    assert "There are no tries left." in text(client.get(f"{home}basics/"))
    answer = client.post(f"{home}basics/")
    assert answer.status_code == 409
    assert "All 2 tries are used." in text(answer)


def test_one_of_another_dataset_is_not_there(client: Client, basics: Qualification, home: str) -> None:
    assert client.get(f"{home}others/").status_code == 404
