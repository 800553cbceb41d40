"""One worker's work as the manager sees it: beside others, what was decided and what reviewers wrote."""

from __future__ import annotations

import pytest
from django.contrib.auth.models import User
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Assignment, Campaign, Dataset, MoneyEntry
from gtm_hit.ops.pay import ledger
from gtm_hit.ops.review import comments
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition
from tests.ops.review.scene import into_campaign, make_reviewer, make_work, submitted
from tests.work_scene import make_worker

pytestmark = pytest.mark.django_db
BASE = "/datasets/square/campaigns/spring/"


def in_two_copies(batches: int, slug: str = "square") -> Dataset:
    dataset = make_work(frames=2 * batches, copies=2, slug=slug)
    into_campaign(dataset, platform="link", copies=2)
    return dataset


@pytest.fixture
def copies() -> Dataset:
    return in_two_copies(1)


@pytest.fixture
def rita() -> User:
    return make_reviewer()


@pytest.fixture
def mona(client: Client) -> User:
    user = User.objects.create_superuser("mona")
    client.force_login(user)
    return user


def page_of(client: Client, work: Assignment) -> str:
    answer = client.get(f"{BASE}workers/{work.worker.pseudonym}/")
    assert answer.status_code == 200
    return " ".join(answer.content.decode().split())


def commented(work: Assignment, by: User, text: str = "Two steps to the left.") -> Assignment:
    frame = work.batch.frames.order_by("number")[0]
    comments.remark(work, by, text, comments.Pin(frame.number, 2))
    return work


def test_agreement_and_bias_are_told_where_others_did_the_same_frames(
    client: Client, copies: Dataset, mona: User
) -> None:
    submitted("alice", copies)
    bob = submitted("bob", copies, aside=4, missing=1)  # four positions of 2.5 cm along X, one person less
    page = page_of(client, bob)
    assert "<dd>86 %</dd>" in page  # three of three and four found
    assert "<dd>+10.0</dd>" in page and "<dd>0.0</dd>" in page


def test_without_others_the_manager_reads_that_there_are_none(
    client: Client, copies: Dataset, mona: User
) -> None:
    page = page_of(client, submitted("alice", copies))
    assert "Nobody else has finished the same frames." in page and "bias in X" not in page


def test_reviewers_comments_stand_with_frame_person_and_whether_they_are_done(
    client: Client, copies: Dataset, rita: User, mona: User
) -> None:
    work = commented(submitted("alice", copies), rita)
    remark = work.comments.get()
    desk = f'<a href="{BASE}review/{work.pk}/">batch 1, frame 0, person 2</a>'
    page = page_of(client, work)
    assert desk in page and "Two steps to the left." in page and "○ open" in page
    comments.resolve(remark, work.worker, resolved=True)
    assert "✓ done" in page_of(client, work)


def test_answers_are_no_comments_by_reviewers(
    client: Client, copies: Dataset, rita: User, mona: User
) -> None:
    work = commented(submitted("alice", copies), rita)
    comments.answer(work.comments.get(), work.worker, "Nobody can be seen there.")
    page = page_of(client, work)
    assert "Two steps to the left." in page and "Nobody can be seen there." not in page


def test_a_decision_leads_to_the_desk(client: Client, copies: Dataset, rita: User, mona: User) -> None:
    work = transition(submitted("alice", copies), Action.ACCEPT, rita)
    assert f'<a href="{BASE}review/{work.pk}/">batch 1</a>: accepted, rita' in page_of(client, work)


def test_one_batch_takes_as_many_queries_as_six(client: Client, rita: User, mona: User) -> None:
    """All of them done by two, commented and accepted."""

    def queries(slug: str, batches: int) -> int:
        dataset = in_two_copies(batches, slug)
        for name in ("alice", "bob"):
            worker = make_worker(f"{name} of {slug}")
            done = [commented(submitted(worker, dataset), rita) for _ in range(batches)]
            for work in done:
                transition(work, Action.ACCEPT, rita)
        address = f"/datasets/{slug}/campaigns/spring/workers/{worker.pseudonym}/"
        client.get(address)
        with CaptureQueriesContext(connection) as asked:
            page = client.get(address).content.decode()
        assert page.count("person 2</a>") == batches and "bias in X" in page
        return len(asked)

    assert queries("square", 1) == queries("large", 6)


def test_money_is_right_before_it_is_booked_and_reading_books_nothing(
    client: Client, copies: Dataset, mona: User
) -> None:
    work = submitted("alice", copies)
    Assignment.objects.filter(pk=work.pk).update(state=Assignment.State.ACCEPTED)
    assert "<dd>2.50</dd>" in page_of(client, work)
    assert not MoneyEntry.objects.exists()
    with ledger.holding(Campaign.objects.get()) as held:
        ledger.settle(held)
    assert page_of(client, work).count("<dd>2.50</dd>") == 1


def test_an_hour_counts_this_workers_seconds_alone(
    client: Client, copies: Dataset, rita: User, mona: User
) -> None:
    alice = transition(submitted("alice", copies), Action.ACCEPT, rita)
    bob = transition(submitted("bob", copies), Action.ACCEPT, rita)
    for work, seconds in ((alice, 900), (bob, 3600)):
        work.layer.layer_frames.update(seconds=seconds)  # of two frames each
    assert "<dd>5.00</dd>" in page_of(client, alice)
    assert "<dd>1.25</dd>" in page_of(client, bob)
