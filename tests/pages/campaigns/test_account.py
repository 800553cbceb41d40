"""What one worker's work came to: as the manager sees it, and as the worker reads it."""

from __future__ import annotations

from decimal import Decimal

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Assignment, Campaign, Worker, WorkerScore
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition
from gtm_hit.ops.scores import words
from gtm_hit.ops.work import links
from gtm_hit.scoring.worker import PARTS
from tests.ops.review.scene import REASON, into_campaign, make_reviewer, make_work, submitted

pytestmark = pytest.mark.django_db

REASONS = [
    {"part": "faults", "good": 1.0, "bad": 5.0, "lost": 12.0},
    {"part": "found", "good": 60.0, "bad": 20.0, "lost": 8.0},
]


@pytest.fixture
def work() -> Assignment:
    """Accepted by Rita, at 2.50 a batch."""
    dataset = make_work()
    into_campaign(dataset, platform="link")
    done = submitted("alice", dataset)
    return transition(done, Action.ACCEPT, make_reviewer())


def score(work: Assignment, assignments: int = 3) -> WorkerScore:
    assert work.batch.campaign
    return WorkerScore.objects.create(
        campaign=work.batch.campaign,
        worker=work.worker,
        score=71.6,
        low=60.0,
        high=80.0,
        assignments=assignments,
        reasons=REASONS,
        computed_at="2026-01-01T00:00Z",
    )


def manager_page(client: Client, worker: Worker) -> str:
    client.force_login(User.objects.create_superuser("mona"))
    page = client.get(f"/datasets/square/campaigns/spring/workers/{worker.pseudonym}/")
    assert page.status_code == 200
    return page.content.decode()


def own_page(client: Client, work: Assignment) -> str:
    seat = links.Seat(work.worker, work.batch.dataset, work.batch.campaign)
    return client.get(f"/work/{links.seat_token(seat)}/").content.decode()


def test_the_manager_sees_score_money_and_decisions(client: Client, work: Assignment) -> None:
    score(work)
    page = manager_page(client, work.worker)
    for said in ("72</b>", "60 to 80", "2.50", "rita", "accepted"):
        assert said in page, said


def test_before_anything_is_decided_the_manager_reads_so(client: Client) -> None:
    dataset = make_work()
    into_campaign(dataset, platform="link")
    page = manager_page(client, submitted("alice", dataset).worker)
    assert "No score yet" in page and "Nothing has been decided yet." in page


def test_a_worker_reads_what_was_earned_and_the_score(client: Client, work: Assignment) -> None:
    score(work)
    page = own_page(client, work)
    assert "Your work scores 72 of 100." in page and "2.50" in page


def test_a_worker_of_one_batch_reads_no_score(client: Client, work: Assignment) -> None:
    score(work, assignments=1)
    assert "Your work scores" not in own_page(client, work)


def test_where_nothing_is_paid_no_money_is_spoken_of(client: Client) -> None:
    dataset = make_work()
    into_campaign(dataset, platform="link", pay_per_batch=Decimal("0.00"))
    assert "earned" not in own_page(client, submitted("alice", dataset))


def test_a_workers_words_give_away_neither_gold_nor_faults(work: Assignment) -> None:
    said = words.for_worker(score(work)).lower()
    assert "what cost most" in said
    assert not [word for word in ("gold", "plant", "fault", "truth", "5", "20") if word in said]


@pytest.mark.parametrize("part", [one.name for one in PARTS])
def test_every_part_of_a_score_has_words_for_the_worker(part: str) -> None:
    """And those of one part are no other's: what is planted hides behind nothing else."""
    lost = [{"part": part, "good": 7.0, "bad": 9.0, "lost": 5.0}]
    said = words.for_worker(WorkerScore(score=90.0, assignments=3, reasons=lost))
    assert said.endswith(f"What cost most: {words.worker_words()[part]}.")
    assert not [word for word in ("gold", "plant", "fault", "truth") if word in said.lower()]
    assert len(set(words.worker_words().values())) == len(PARTS)
    assert words.part_in_words(lost[0]) and part in words.part_names()


def test_the_table_of_workers_shows_the_score_between_its_bounds(client: Client, work: Assignment) -> None:
    """On the page, as CSV and by REST."""
    client.force_login(User.objects.create_superuser("mona"))
    base = "datasets/square/campaigns/spring/workers"
    assert "<b>" not in client.get(f"/{base}/").content.decode().split("<tbody>")[1]
    score(work)
    shown = " ".join(client.get(f"/{base}/").content.decode().split())
    assert '<b>72</b> <span class="muted small">60 to 80</span>' in shown
    assert client.get(f"/{base}.csv").content.decode().strip().endswith(",72,60,80")
    told = client.get(f"/api/v1/{base}/").json()["results"][0]["score"]
    assert told == {"score": 72, "low": 60, "high": 80}


def test_bonuses_wait_for_the_manager(client: Client, work: Assignment) -> None:
    """Half an hour at 8.00 an hour, paid with 2.50."""
    work.layer.layer_frames.update(seconds=900)
    Campaign.objects.update(hourly_floor=Decimal("8.00"))
    client.force_login(User.objects.create_superuser("mona"))
    page = " ".join(client.get("/datasets/square/campaigns/spring/").content.decode().split())
    assert "1 bonus to be approved, 1.50 USD" in page and "campaigns/spring/pay/" in page


def test_an_appeal_waits_for_the_manager(client: Client) -> None:
    dataset = make_work()
    into_campaign(dataset, platform="link")
    done = submitted("alice", dataset)
    done = transition(done, Action.REJECT, make_reviewer(), category="low_effort", reason=REASON)
    transition(done, Action.APPEAL, done.worker, reason="They were hidden behind the pillar.")
    client.force_login(User.objects.create_superuser("mona"))
    assert "1 appeal to be decided" in client.get("/datasets/square/campaigns/spring/").content.decode()
