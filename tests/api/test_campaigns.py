"""Campaigns by script."""

from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import ApiToken, Campaign, CampaignLink, Worker
from gtm_hit.ops import api_tokens
from gtm_hit.ops.work import links
from gtm_hit.ops.work.assignments import claim
from gtm_hit.ops.work.pools import Pool
from tests.campaign_scene import make_campaign, make_draft, manager
from tests.work_scene import finish, make_dataset, make_worker

pytestmark = pytest.mark.django_db
BASE = "/api/v1/datasets/square/campaigns/"


@pytest.fixture
def campaign() -> Campaign:
    return make_campaign(make_dataset(frames=60))


@pytest.fixture
def boss(client: Client, campaign: Campaign) -> User:
    user = manager(campaign.dataset)
    client.force_login(user)
    return user


def post(client: Client, path: str, body: Any) -> Any:
    return client.post(BASE + path, body, content_type="application/json")


def test_a_campaign_is_made_changed_and_opened(client: Client, boss: User) -> None:
    made = post(client, "", {"name": "second", "platform": "link", "copies": 2, "pay_per_batch": "1.50"})
    assert (made.status_code, made.json()["state"], made.json()["pay_per_batch"]) == (201, "draft", "1.50")
    changed = client.patch(BASE + "second/", {"copies": 3}, content_type="application/json")
    assert changed.json()["copies"] == 3
    assert post(client, "second/step/", {"step": "open"}).json()["state"] == "open"
    assert [one["name"] for one in client.get(BASE).json()] == ["second", "walk"]
    assert client.get(BASE + "second/").json()["batch_size"] == 10


@pytest.mark.parametrize(
    ("body", "place"),
    [
        ({"name": "walk"}, "name"),
        ({"name": "x", "overlap": 10}, "overlap"),
        ({"name": "x", "colour": "red"}, "colour"),
        ({"name": "x", "state": "open"}, "state"),
        ({"name": "x", "platform_settings": {"what": 1}}, "platform_settings"),
        ({"name": "x", "pay_per_batch": "much"}, "pay_per_batch"),
        ({}, "name"),
    ],
)
def test_what_makes_no_campaign_is_said_with_its_place(
    client: Client, boss: User, body: dict[str, Any], place: str
) -> None:
    response = post(client, "", body)
    assert response.status_code == 400
    assert place in {problem["place"] for problem in response.json()["details"]}
    assert Campaign.objects.count() == 1


def test_what_an_open_campaign_may_not_change_stays(client: Client, boss: User, campaign: Campaign) -> None:
    response = client.patch(BASE + "walk/", {"batch_size": 5, "title": "x"}, content_type="application/json")
    assert response.status_code == 400 and "batches are cut" in response.content.decode()
    campaign.refresh_from_db()
    assert (campaign.batch_size, campaign.title) == (10, "")


def test_a_step_that_cannot_be_taken_is_a_conflict(client: Client, boss: User, campaign: Campaign) -> None:
    make_draft(campaign.dataset, "draft")
    assert post(client, "draft/step/", {"step": "pause"}).status_code == 409
    assert post(client, "draft/step/", {"step": "jump"}).status_code == 400


def test_how_a_campaign_goes(client: Client, boss: User, campaign: Campaign) -> None:
    finish(claim(make_worker(), Pool(campaign.dataset, campaign)))
    going = client.get(BASE + "walk/course/").json()
    assert (going["frames_submitted"], going["batches"]["submitted"], going["currency"]) == (10, 1, "USD")


def test_links_are_made_listed_rotated_and_revoked(client: Client, boss: User) -> None:
    made = post(client, "walk/links/", {"note": "panel", "days": 3}).json()
    assert "/join/" in made["link"] and made["state"] == "open"
    fresh = post(client, f"walk/links/{made['id']}/", {"deed": "rotate"}).json()
    assert fresh["link"] != made["link"]
    assert post(client, f"walk/links/{made['id']}/", {"deed": "revoke"}).json()["link"] == ""
    assert [one["state"] for one in client.get(BASE + "walk/links/").json()["results"]] == ["revoked"]
    personal = post(client, "walk/links/", {"kind": "personal", "worker": "alice"}).json()
    assert personal["worker"] == Worker.objects.get(external_id="alice").pseudonym
    assert post(client, "walk/links/", {"kind": "invitation"}).status_code == 400
    assert CampaignLink.objects.count() == 2


def test_workers_are_invited_blocked_and_their_links_ended(
    client: Client, boss: User, campaign: Campaign
) -> None:
    assert post(client, "walk/workers/alice/", {"deed": "invite"}).status_code == 204
    worker = Worker.objects.get(external_id="alice")
    held = claim(worker, Pool(campaign.dataset, campaign))
    token, seat = links.assignment_token(held), links.worker_token(worker, campaign.dataset)
    path = f"walk/workers/{worker.pseudonym}/"
    assert post(client, path, {"deed": "block"}).status_code == 400
    assert post(client, path, {"deed": "block", "reason": "clicks anywhere"}).status_code == 204
    shown = client.get(BASE + "walk/workers/").json()["results"][0]
    assert (shown["worker"], shown["standing"], shown["batches"]) == (worker.pseudonym, "blocked", 1)
    assert "alice" not in str(shown)
    assert post(client, path, {"deed": "revoke_link", "assignment": held.pk}).status_code == 204
    assert client.get(f"/annotate/{token}/").status_code == 404
    assert post(client, path, {"deed": "revoke_links"}).status_code == 204
    assert client.get(f"/work/{seat}/").status_code == 404
    assert post(client, "walk/workers/nobody/", {"deed": "forget"}).status_code == 404
    Worker.objects.create(platform="link", external_id="elsewhere")
    assert post(client, "walk/workers/elsewhere/", {"deed": "revoke_links"}).status_code == 404


ADDRESSES = ["", "walk/", "walk/course/", "walk/links/", "walk/workers/"]


@pytest.mark.parametrize("path", ADDRESSES)
def test_only_managers_read(client: Client, campaign: Campaign, path: str) -> None:
    assert client.get(BASE + path).status_code == 401
    client.force_login(User.objects.create_user("nobody"))
    assert client.get(BASE + path).status_code == 403
    client.force_login(manager(campaign.dataset))
    assert client.get(BASE + path).status_code == 200


@pytest.mark.parametrize("path", ["", "walk/step/", "walk/links/", "walk/workers/alice/"])
def test_a_key_that_reads_changes_nothing(campaign: Campaign, path: str) -> None:
    user = manager(campaign.dataset)
    _token, key = api_tokens.make(user, "reader", [ApiToken.Scope.READ])
    body = {"name": "x", "step": "close", "deed": "invite"}
    headers = {"Authorization": f"Bearer {key}"}
    response = Client().post(BASE + path, body, content_type="application/json", headers=headers)
    assert response.status_code == 403
    assert Campaign.objects.get().state == "open" and not Worker.objects.exists()


def test_links_are_no_reading(campaign: Campaign) -> None:
    _token, key = api_tokens.make(manager(campaign.dataset), "reader", [ApiToken.Scope.READ])
    response = Client().get(BASE + "walk/links/", headers={"Authorization": f"Bearer {key}"})
    assert response.status_code == 403
