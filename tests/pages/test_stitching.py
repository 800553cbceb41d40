"""The pages of the ground truth: what they show, who may, and what a wrong form says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Campaign, Job, StitchConflict
from gtm_hit.ops.jobs.progress import no_progress
from gtm_hit.ops.stitching import conflicts
from gtm_hit.ops.stitching.running import Asked, stitch_layer
from gtm_hit.ops.stitching.scope import Scope
from tests.stitch_scene import accept, doubtful, two_batches
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db

PAGES = (
    "/datasets/square/stitching/",
    "/datasets/square/stitching/conflicts/",
    "/datasets/square/campaigns/autumn/stitching/",
    "/datasets/square/campaigns/autumn/stitching/conflicts/",
)
RULES = {"gate": 0.6, "gap": 5, "margin": 3, "return_seconds": 60, "return_reach": 4}


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def staff(client: Client) -> Client:
    client.force_login(User.objects.create_user("ada", password="x", is_superuser=True))
    return client


def test_before_anything_is_accepted_the_page_says_so_and_offers_nothing(staff: Client) -> None:
    make_dataset()
    page = staff.get(PAGES[0]).content.decode()
    assert "No batch has been accepted yet" in page and "disabled>Make the ground truth" in page


def test_the_button_starts_the_job_and_the_page_follows_it(staff: Client) -> None:
    two_batches()
    answer = staff.post(PAGES[0], RULES)
    job = Job.objects.get(kind=Job.Kind.STITCH)
    assert (answer.status_code, answer["Location"]) == (302, PAGES[0])
    assert f'data-job="/api/v1/jobs/{job.pk}/"' in staff.get(PAGES[0]).content.decode()


def test_a_rule_that_makes_no_sense_is_told_and_starts_nothing(staff: Client) -> None:
    two_batches()
    page = staff.post(PAGES[0], {**RULES, "gate": "-1"})
    assert page.status_code == 200 and "errorlist" in page.content.decode()
    assert not Job.objects.exists()


def test_questions_and_decisions_are_counted(staff: Client) -> None:
    dataset = doubtful(pairs=2)
    stitch_layer(Scope(dataset), Asked(), None, no_progress)
    conflicts.decide(StitchConflict.objects.all()[0], "apart", User.objects.get())
    page = staff.get(PAGES[0]).content.decode()
    assert "Decide 1 question" in page and "1 decision is not in the layer yet" in page
    assert "two people" in page


def test_the_queue_holds_the_open_questions(staff: Client) -> None:
    dataset = doubtful(pairs=3)
    stitch_layer(Scope(dataset), Asked(), None, no_progress)
    first = StitchConflict.objects.order_by("pk")[0]
    conflicts.decide(first, "same", None)
    page = staff.get(PAGES[1])
    assert len(page.context["queue"]["ids"]) == 2 and first.pk not in page.context["queue"]["ids"]


def test_a_campaign_has_pages_of_its_own(staff: Client) -> None:
    dataset, _ = two_batches()
    campaign = Campaign.objects.create(dataset=dataset, name="autumn")
    accept(dataset, 1, range(0, 5), {1: (50, 50, 1, 1)}, campaign=campaign)
    page = staff.get(PAGES[2])
    assert page.context["found"].covered == 5
    assert 'aria-current="page">Ground truth' in page.content.decode()
    assert staff.get(PAGES[2].replace("autumn", "spring")).status_code == 404


@pytest.mark.parametrize("address", PAGES)
def test_strangers_are_sent_to_the_login_and_start_nothing(client: Client, address: str) -> None:
    dataset, _ = two_batches()
    Campaign.objects.create(dataset=dataset, name="autumn")
    assert client.get(address)["Location"].startswith("/login/")
    assert client.post(address, RULES).status_code in {302, 405}
    assert not Job.objects.exists()


@pytest.mark.parametrize("address", PAGES)
def test_somebody_without_the_role_is_refused(client: Client, address: str) -> None:
    dataset, _ = two_batches()
    Campaign.objects.create(dataset=dataset, name="autumn")
    client.force_login(User.objects.create_user("eve", password="x"))
    assert client.get(address).status_code == 403


def test_the_pages_ask_the_database_equally_often_for_two_and_for_forty_batches(
    staff: Client, django_assert_max_num_queries: Any
) -> None:
    dataset = make_dataset(frames=40)
    for index in range(40):
        accept(dataset, index + 1, [index], {1: (50, 50, 1, 1)})
    stitch_layer(Scope(dataset), Asked(), None, no_progress)
    with django_assert_max_num_queries(20):
        staff.get(PAGES[0])
