"""Links end: by their age, or because somebody revoked them."""

from __future__ import annotations

import time
from collections.abc import Callable
from datetime import timedelta
from typing import Any

import pytest
from django.utils import timezone

from gtm_hit.models import Assignment, CampaignLink, Dataset, Worker
from gtm_hit.ops.campaigns import links as campaign_links
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work import links
from gtm_hit.ops.work.assignments import claim
from tests.campaign_scene import make_campaign
from tests.work_scene import finish, make_worker

Later = Callable[[int], None]


@pytest.fixture
def worker(dataset: Dataset) -> Worker:
    return make_worker("alice")


@pytest.fixture
def later(monkeypatch: pytest.MonkeyPatch) -> Later:
    now = time.time()

    def pass_by(days: int) -> None:
        monkeypatch.setattr(time, "time", lambda: now + days * 86400)

    return pass_by


def test_a_general_link_is_closed_when_it_is_too_old(dataset: Dataset, later: Later) -> None:
    token = links.entry_token(dataset)
    later(179)
    assert not links.read_entry(token).closed
    later(181)
    assert links.read_entry(token).closed
    assert not links.read_entry(links.entry_token(dataset)).closed


@pytest.mark.parametrize("kind", ["personal", "seat"])
def test_a_workers_own_links_end(dataset: Dataset, worker: Worker, later: Later, kind: str) -> None:
    seat = kind == "seat"
    token = links.worker_token(worker, dataset) if seat else links.entry_token(dataset, "link", "alice")
    read: Callable[[str], Any] = links.read_worker if seat else links.read_entry
    later(89)
    assert read(token)
    later(91)
    with pytest.raises(links.BadToken):
        read(token)


def test_links_never_end_where_the_setting_is_zero(
    dataset: Dataset, worker: Worker, later: Later, settings: Any
) -> None:
    settings.ENTRY_LINK_DAYS = settings.WORKER_LINK_DAYS = 0
    entry, seat = links.entry_token(dataset), links.worker_token(worker, dataset)
    later(3000)
    assert not links.read_entry(entry).closed
    assert links.read_worker(seat).worker == worker


def test_a_batch_that_was_over_long_ago_is_not_opened_any_more(dataset: Dataset, worker: Worker) -> None:
    token = links.assignment_token(finish(claim(worker, dataset)))
    assert links.read_assignment(token)
    Assignment.objects.update(submitted_at=timezone.now() - timedelta(days=91))
    with pytest.raises(links.BadToken):
        links.read_assignment(token)
    Assignment.objects.update(state="returned")
    assert links.read_assignment(token)


def test_revoking_one_batchs_link_leaves_the_workers_others(dataset: Dataset, worker: Worker) -> None:
    assignment = claim(worker, dataset)
    token, seat = links.assignment_token(assignment), links.worker_token(worker, dataset)
    links.revoke_assignment(assignment)
    with pytest.raises(links.BadToken):
        links.read_assignment(token)
    assert links.read_worker(seat).worker == worker
    assignment.refresh_from_db()
    assert links.read_assignment(links.assignment_token(assignment)) == assignment


def test_revoking_a_workers_links_ends_all_of_his_and_nobody_elses(dataset: Dataset, worker: Worker) -> None:
    campaign = make_campaign(dataset)
    other = make_worker("bob")
    link = campaign_links.make(campaign, "personal", worker=worker)
    seats = [links.Seat(worker, dataset), links.Seat(worker, dataset, campaign)]
    dead: list[tuple[Callable[[str], Any], str]] = [
        *((links.read_worker, links.seat_token(seat)) for seat in seats),
        (links.read_entry, links.entry_token(dataset, "link", "alice")),
        (links.read_entry, campaign_links.token(link)),
        (links.read_assignment, links.assignment_token(claim(worker, dataset))),
    ]
    alive = links.worker_token(other, dataset)
    links.revoke_worker(worker)
    for read, token in dead:
        with pytest.raises(links.BadToken):
            read(token)
    assert links.read_worker(alive).worker == other
    worker.refresh_from_db()
    assert links.read_worker(links.worker_token(worker, dataset)).worker == worker
    assert links.read_entry(links.entry_token(dataset, "link", "alice")).external_id == "alice"


def test_a_seat_in_a_campaign_reads_back(dataset: Dataset, worker: Worker) -> None:
    seat = links.Seat(worker, dataset, make_campaign(dataset), "A1", "https://panel.example")
    assert links.read_worker(links.seat_token(seat)) == seat


@pytest.mark.parametrize("kind", ["general", "personal", "invitation"])
def test_a_campaigns_link_is_over_at_its_date(worker: Worker, dataset: Dataset, kind: str) -> None:
    campaign = make_campaign(dataset, platform="own_team")
    whose = worker if kind == "personal" else None
    link = campaign_links.make(campaign, kind, worker=whose, days=1)
    assert campaign_links.find(campaign_links.token(link)).state == "open"
    CampaignLink.objects.update(expires_at=timezone.now())
    assert campaign_links.find(campaign_links.token(link)).state == "expired"


def test_rotating_kills_the_old_address_and_opens_a_new_one(dataset: Dataset) -> None:
    link = campaign_links.make(make_campaign(dataset))
    old = campaign_links.token(link)
    campaign_links.revoke(link)
    fresh = campaign_links.rotate(CampaignLink.objects.get())
    with pytest.raises(links.BadToken):
        links.read_entry(old)
    assert not links.read_entry(campaign_links.token(fresh)).closed


@pytest.mark.parametrize(
    "given",
    [{"days": 0}, {"days": 4000}, {"note": "x" * 121}, {"kind": "invitation"}, {"kind": "personal"}],
)
def test_a_link_that_makes_no_sense_is_not_made(dataset: Dataset, given: dict[str, Any]) -> None:
    with pytest.raises(CampaignError):
        campaign_links.make(make_campaign(dataset), **given)
    assert not CampaignLink.objects.exists()
