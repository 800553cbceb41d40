"""The reviewer's pages and the worker's page of a decision, as they are asked for over HTTP."""

from __future__ import annotations

import re
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client
from django.urls import reverse

from gtm_hit.models import Appeal, Assignment, Dataset, Layer
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition
from gtm_hit.ops.work import links
from tests.ops.review.scene import REASON, into_campaign, make_reviewer, make_work, state, submitted

pytestmark = pytest.mark.django_db
QUEUE = "/datasets/square/review/"


@pytest.fixture
def dataset() -> Dataset:
    return make_work()


@pytest.fixture
def work(dataset: Dataset) -> Assignment:
    return submitted("alice", dataset)


@pytest.fixture
def staff() -> Client:
    client = Client()
    client.force_login(make_reviewer())
    return client


def rejected(work: Assignment, by: User, appeal: bool = False) -> None:
    transition(work, Action.REJECT, by, category="low_effort", reason=REASON)
    if appeal:
        transition(work, Action.APPEAL, work.worker, reason="They left the square.")


def decision_page(work: Assignment) -> str:
    return reverse("work-decision", args=[links.assignment_token(work)])


def test_strangers_are_sent_to_the_login(client: Client, work: Assignment) -> None:
    for page in ("", f"{work.pk}/", f"{work.pk}/mended/"):
        assert client.get(QUEUE + page)["Location"].startswith("/login/")
    assert client.post(f"{QUEUE}{work.pk}/mend/").status_code == 302
    assert not Layer.objects.filter(kind="staff").exists()


def test_an_account_that_is_no_staff_gets_403(client: Client, work: Assignment) -> None:
    client.force_login(User.objects.create_user("guest"))
    assert client.get(QUEUE).status_code == 403
    assert client.get(f"{QUEUE}{work.pk}/").status_code == 403


def test_an_empty_queue_says_so(staff: Client, dataset: Dataset) -> None:
    assert "Nothing waits for a review" in staff.get(QUEUE).content.decode()
    for name, words in {"appeals": "Nobody has appealed", "decided": "Nothing has been decided"}.items():
        assert words in staff.get(f"{QUEUE}?list={name}").content.decode()


def test_the_queue_leads_to_the_desk(staff: Client, work: Assignment) -> None:
    page = staff.get(QUEUE).content.decode()
    assert f'href="{QUEUE}{work.pk}/"' in page and work.worker.pseudonym in page and "alice" not in page
    assert staff.get(f"{QUEUE}{work.pk}/").status_code == 200


def test_a_campaign_has_a_queue_of_its_own(staff: Client, dataset: Dataset, work: Assignment) -> None:
    into_campaign(dataset)
    address = "/datasets/square/campaigns/spring/review/"
    assert f'href="{address}{work.pk}/"' in staff.get(address).content.decode()
    assert staff.get("/datasets/square/campaigns/autumn/review/").status_code == 404


def test_many_waiting_take_as_many_queries_as_few(staff: Client, django_assert_max_num_queries: Any) -> None:
    dataset = make_work(frames=60)
    for number in range(30):
        submitted(f"worker-{number}", dataset)
    with django_assert_max_num_queries(12):
        staff.get(QUEUE)


def test_a_rejected_worker_reads_why_and_appeals_by_a_form(client: Client, work: Assignment) -> None:
    rejected(work, make_reviewer())
    page = client.get(decision_page(work)).content.decode()
    assert REASON in page and "hardly any effort" in page.lower() and "rita" not in page
    assert client.post(decision_page(work), {"text": "They left."}).status_code == 302
    assert Appeal.objects.get().text == "They left."
    again = client.post(decision_page(work), {"text": "Really."})
    assert again.status_code == 409 and Appeal.objects.count() == 1


def test_an_empty_appeal_is_none(client: Client, work: Assignment) -> None:
    rejected(work, make_reviewer())
    assert client.post(decision_page(work), {"text": "  "}).status_code == 200
    assert not Appeal.objects.exists()


def test_a_cut_off_link_shows_no_decision(client: Client, work: Assignment) -> None:
    assert client.get(decision_page(work)[:-12] + "/decision/").status_code == 404


def test_the_start_page_leads_to_the_decision(client: Client, work: Assignment) -> None:
    rejected(work, make_reviewer())
    home = reverse("work-home", args=[links.worker_token(work.worker, work.batch.dataset)])
    assert decision_page(work) in client.get(home).content.decode()


def test_an_appeal_is_decided_by_somebody_else_and_told(
    client: Client, staff: Client, work: Assignment
) -> None:
    rita = User.objects.get(username="rita")
    rejected(work, rita, appeal=True)
    address = f"{QUEUE}{work.pk}/appeal/"
    answer = {"reason": "Right: they left.", "decision": "overturn"}
    assert staff.post(address, answer).status_code == 400
    assert state(work) == "rejected"
    other = Client()
    other.force_login(make_reviewer("sven"))
    assert other.post(address, answer).status_code == 302
    assert state(work) == "accepted"
    assert "Right: they left." in client.get(decision_page(work)).content.decode()


def test_the_corrected_copy_opens_with_the_desk_to_go_back_to(staff: Client, work: Assignment) -> None:
    assert staff.post(f"{QUEUE}{work.pk}/mend/")["Location"] == f"{QUEUE}{work.pk}/mended/"
    assert f'data-home="{QUEUE}{work.pk}/"' in staff.get(f"{QUEUE}{work.pk}/mended/").content.decode()


def test_a_reviewer_sees_only_those_pages_of_a_campaign_that_open(client: Client) -> None:
    dataset = make_work()
    into_campaign(dataset)
    rosa = User.objects.create_user("rosa")
    granting.grant(rosa, Role.REVIEWER, dataset)
    client.force_login(rosa)
    page = client.get("/datasets/square/campaigns/spring/review/").content.decode()
    campaign = "/datasets/square/campaigns/spring/"
    shown = {link for link in re.findall(r'href="([^"?#]+)', page) if link.startswith(campaign)}
    assert shown == {f"{campaign}review/", f"{campaign}stitching/"}
    assert {client.get(link).status_code for link in shown} == {200}
