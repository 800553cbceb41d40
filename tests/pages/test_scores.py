"""The pages of workers by score and of assignments by suspicion, and their files."""

from __future__ import annotations

import csv
import io

import pytest
from django.contrib.auth.models import User
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext
from django.utils import timezone

from gtm_hit.models import Campaign, Worker, WorkerScore
from gtm_hit.ops.scores import computing
from gtm_hit.ops.work import assignments
from tests.gold_scene import confirm, hand_in, make_scene, plant_everywhere, take, truth_of_square

pytestmark = pytest.mark.django_db
CAMPAIGN = "/datasets/square/campaigns/street/"


@pytest.fixture
def campaign() -> Campaign:
    campaign, truth = make_scene(copies=2)
    plant_everywhere(campaign, truth)
    return campaign


@pytest.fixture
def manager(client: Client) -> Client:
    client.force_login(User.objects.create_user("manager", password="x", is_superuser=True))
    return client


@pytest.fixture
def workers(campaign: Campaign) -> list[str]:
    """One who works and one who presses “next”, by pseudonym."""
    good = hand_in(take(campaign), truth_of_square())
    bad = take(campaign, "bob")
    confirm(bad)
    assignments.submit(bad)
    computing.recompute(campaign)
    return [good.worker.pseudonym, bad.worker.pseudonym]


def rows(answer: object) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(answer.content.decode())))  # type: ignore[attr-defined]


def test_without_work_the_pages_say_so(manager: Client, campaign: Campaign) -> None:
    assert "Nobody has submitted" in manager.get(f"{CAMPAIGN}scores/").content.decode()
    assert "Nothing has been submitted" in manager.get(f"{CAMPAIGN}suspicion/").content.decode()
    assert rows(manager.get(f"{CAMPAIGN}scores.csv")) == []


def test_workers_come_lowest_first_with_reasons(
    manager: Client, campaign: Campaign, workers: list[str]
) -> None:
    text = manager.get(f"{CAMPAIGN}scores/").content.decode()
    assert text.index(workers[1]) < text.index(workers[0])
    assert "0 of 3 planted faults repaired." in text
    found = rows(manager.get(f"{CAMPAIGN}scores.csv"))
    assert [row["worker"] for row in found] == [workers[1], workers[0]]
    assert float(found[0]["low"]) <= float(found[0]["score"]) <= float(found[0]["high"])


def test_assignments_come_most_suspicious_first(
    manager: Client, campaign: Campaign, workers: list[str]
) -> None:
    text = manager.get(f"{CAMPAIGN}suspicion/").content.decode()
    assert text.index(workers[1]) < text.index(workers[0])
    found = rows(manager.get(f"{CAMPAIGN}suspicion.csv"))
    assert [row["worker"] for row in found] == [workers[1], workers[0]]
    assert "planted faults were left" in found[0]["why"]


def test_measuring_anew_is_a_button(manager: Client, campaign: Campaign, workers: list[str]) -> None:
    WorkerScore.objects.all().delete()
    answer = manager.post(f"{CAMPAIGN}scores/recompute/", follow=True)
    assert "Measured anew: 2 assignments." in answer.content.decode()
    assert WorkerScore.objects.count() == 2


def test_two_hundred_workers_cost_as_many_queries_as_one(manager: Client, campaign: Campaign) -> None:
    def queries(count: int) -> int:
        people = [Worker(external_id=f"{count}-{index}") for index in range(count)]
        made = Worker.objects.bulk_create(people)
        WorkerScore.objects.bulk_create(
            WorkerScore(campaign=campaign, worker=one, score=50, low=40, high=60, computed_at=timezone.now())
            for one in made
        )
        with CaptureQueriesContext(connection) as counted:
            assert manager.get(f"{CAMPAIGN}scores/").status_code == 200
        return len(counted)

    assert queries(1) == queries(200)
