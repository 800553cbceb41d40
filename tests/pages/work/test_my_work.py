"""What the work came to, on the page of somebody with an account and on the start page."""

from __future__ import annotations

from decimal import Decimal

import pytest
from django.contrib.auth.models import User
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Assignment, Campaign, Dataset, Worker, WorkerScore
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import accounts
from gtm_hit.ops.pay import ledger
from gtm_hit.ops.review import comments
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition
from gtm_hit.ops.work import links
from tests.campaign_scene import account
from tests.ops.review.scene import into_campaign, make_reviewer, make_work, submitted

pytestmark = pytest.mark.django_db


@pytest.fixture
def dataset() -> Dataset:
    dataset = make_work(frames=8)
    into_campaign(dataset, platform="own_team", title="Walk one", review_share=1.0)
    return dataset


@pytest.fixture
def alice(client: Client, dataset: Dataset) -> Worker:
    user = account("alice", Role.ANNOTATOR, dataset)
    client.force_login(user)
    return accounts.worker_of(user)


@pytest.fixture
def rita() -> User:
    return make_reviewer()


def page(client: Client, address: str = "/my-work/") -> str:
    answer = client.get(address)
    assert answer.status_code == 200
    return " ".join(answer.content.decode().split())


def start_page(client: Client, worker: Worker) -> str:
    campaign = Campaign.objects.get()
    return page(client, f"/work/{links.seat_token(links.Seat(worker, campaign.dataset, campaign))}/")


def returned(worker: Worker, dataset: Dataset, by: User) -> Assignment:
    work = submitted(worker, dataset)
    comments.remark(work, by, "Two steps to the left.", comments.Pin(0, 2))
    return transition(work, Action.RETURN, by)


def test_a_campaign_says_how_it_goes_and_what_was_earned(
    client: Client, alice: Worker, dataset: Dataset, rita: User
) -> None:
    transition(submitted(alice, dataset), Action.ACCEPT, rita)
    ledger.mark_paid(Campaign.objects.get(), alice, rita, Decimal("1.00"))
    WorkerScore.objects.create(
        campaign=Campaign.objects.get(), worker=alice, score=71.6, low=60, high=80, assignments=3,
        computed_at="2026-01-01T00:00Z",
    )  # fmt: skip
    said = page(client)
    for part in ("Your work scores 72 of 100.", "2.50 USD", "1.00 USD"):
        assert part in said, part


def test_a_batch_leads_to_its_decision(client: Client, alice: Worker, dataset: Dataset, rita: User) -> None:
    work = transition(submitted(alice, dataset), Action.ACCEPT, rita)
    decision = f"/annotate/{links.assignment_token(work)}/decision/"
    assert f'<a href="{decision}">accepted</a>' in page(client)
    assert client.get(decision).status_code == 200


def test_open_comments_lead_to_the_batch_and_go_when_they_are_done(
    client: Client, alice: Worker, dataset: Dataset, rita: User
) -> None:
    work = returned(alice, dataset, rita)
    leads = f'<a href="/annotate/{links.assignment_token(work)}/"><b>1</b></a>'
    assert leads in page(client)
    comments.resolve(work.comments.get(), alice, resolved=True)
    assert leads not in page(client)


def test_the_start_page_leads_to_the_first_open_comment(
    client: Client, alice: Worker, dataset: Dataset, rita: User
) -> None:
    work = returned(alice, dataset, rita)
    said = start_page(client, alice)
    assert f'<a href="/annotate/{links.assignment_token(work)}/"><strong>1 comment waits for you' in said


def test_the_start_page_tells_of_money_before_a_batch_is_finished(
    client: Client, alice: Worker, dataset: Dataset, rita: User
) -> None:
    assert "Your work so far" not in start_page(client, alice)
    with ledger.holding(Campaign.objects.get()) as held:
        ledger.approve_bonus(held, alice, Decimal("0.75"), rita)
    said = start_page(client, alice)
    assert "Your work so far" in said and "<dd>0.75</dd>" in said


def test_other_workers_money_is_not_told(client: Client, alice: Worker, dataset: Dataset, rita: User) -> None:
    transition(submitted("own-bob", dataset), Action.ACCEPT, rita)
    assert "2.50" not in page(client) and "2.50" not in start_page(client, alice)


def test_three_batches_in_two_campaigns_take_as_many_queries_as_one(
    client: Client, alice: Worker, dataset: Dataset, rita: User
) -> None:
    def queries() -> int:
        page(client)
        with CaptureQueriesContext(connection) as asked:
            page(client)
        return len(asked)

    transition(submitted(alice, dataset), Action.ACCEPT, rita)
    few = queries()
    for _ in range(2):
        transition(submitted(alice, dataset), Action.ACCEPT, rita)
    Campaign.objects.create(dataset=dataset, name="autumn", platform="own_team", state=Campaign.State.OPEN)
    assert page(client).count("accepted</a>") == 3 and "autumn" in page(client)
    assert queries() == few
