"""Campaigns by command."""

from __future__ import annotations

from io import StringIO
from typing import Any

import pytest
from django.core.management import CommandError, call_command
from django.test import Client

from gtm_hit.models import Campaign, CampaignLink, Worker
from gtm_hit.ops.work import links
from gtm_hit.ops.work.assignments import claim
from gtm_hit.ops.work.pools import Pool
from tests.campaign_scene import make_campaign
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db


def run(*words: str, **options: Any) -> str:
    out = StringIO()
    call_command(*words, stdout=out, **options)
    return out.getvalue()


@pytest.fixture
def campaign() -> Campaign:
    return make_campaign(make_dataset(frames=60))


def test_a_campaign_is_made_with_its_rules_and_opened() -> None:
    make_dataset(frames=60)
    rules = ["--platform", "prolific", "--copies", "2", "--pay-per-batch", "3.20", "--currency", "GBP"]
    said = run("makecampaign", "square", "walk", "--open", *rules, "--set", "code_completed=C1")
    campaign = Campaign.objects.get()
    assert "open, 14 batches" in said
    assert (campaign.state, str(campaign.pay_per_batch), campaign.currency) == ("open", "3.20", "GBP")
    assert campaign.platform_settings == {"code_completed": "C1"}


@pytest.mark.parametrize(
    "words",
    [
        ["nowhere", "x"],
        ["square", "x", "--overlap", "10"],
        ["square", "x", "--set", "what"],
        ["square", "x", "--set", "what=1"],
        ["square", "a b"],
    ],
)
def test_what_makes_no_campaign_is_said(words: list[str]) -> None:
    make_dataset()
    with pytest.raises(CommandError):
        run("makecampaign", *words)
    assert not Campaign.objects.exists()


def test_a_campaign_is_changed_and_closed(campaign: Campaign) -> None:
    run("campaign", "square", "walk", "--copies", "2")
    assert campaign.batches.count() == 14
    with pytest.raises(CommandError, match="batches are cut"):
        run("campaign", "square", "walk", "--batch-size", "5")
    assert "closed" in run("campaign", "square", "walk", "close")
    with pytest.raises(CommandError):
        run("campaign", "square", "walk", "open")
    with pytest.raises(CommandError, match="there are: walk"):
        run("campaign", "square", "other")


def test_a_link_is_made_listed_rotated_and_revoked(campaign: Campaign) -> None:
    first = run("campaignlink", "square", "walk", "--base-url", "https://gtm.example/").strip()
    assert first.startswith("https://gtm.example/join/")
    path = first.removeprefix("https://gtm.example")
    assert Client().get(path).status_code == 200
    pk = CampaignLink.objects.get().pk
    run("campaignlink", "square", "walk", "--rotate", str(pk))
    assert Client().get(path).status_code == 404
    run("campaignlink", "square", "walk", "--revoke", str(pk))
    assert "revoked" in run("campaignlink", "square", "walk", "--list")
    assert "/join/" in run("campaignlink", "square", "walk", "--worker", "alice")
    with pytest.raises(CommandError):
        run("campaignlink", "square", "walk", "--invitation")
    with pytest.raises(CommandError):
        run("campaignlink", "square", "walk", "--revoke", "77")


def test_a_worker_is_invited_blocked_and_his_links_ended(campaign: Campaign) -> None:
    run("campaignworker", "square", "walk", "alice", "--invite")
    worker = Worker.objects.get()
    held = claim(worker, Pool(campaign.dataset, campaign))
    token, seat = links.assignment_token(held), links.worker_token(worker, campaign.dataset)
    run("campaignworker", "square", "walk", worker.pseudonym, "--revoke-link", "1")
    assert Client().get(f"/annotate/{token}/").status_code == 404
    run("campaignworker", "square", "walk", worker.pseudonym, "--block", "clicks anywhere")
    assert campaign.workers.get().standing == "blocked"
    run("campaignworker", "square", "walk", "alice", "--revoke-links")
    assert Client().get(f"/work/{seat}/").status_code == 404
    run("campaignworker", "square", "walk", "alice", "--forget")
    assert not campaign.workers.exists()
    assert worker.pseudonym in run("campaignworker", "square", "walk", "alice")
    with pytest.raises(CommandError):
        run("campaignworker", "square", "walk", "nobody", "--forget")
