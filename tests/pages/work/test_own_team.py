"""Accounts, invitations, and the page of somebody who works with a login."""

from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Assignment, Campaign, CampaignLink, Worker
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import accounts, standing, states
from gtm_hit.ops.campaigns import links as campaign_links
from tests.campaign_scene import account, make_campaign
from tests.work_scene import finish, make_dataset

pytestmark = pytest.mark.django_db
GIVEN = {"username": "alice", "password": "a long enough word"}


@pytest.fixture
def campaign() -> Campaign:
    return make_campaign(make_dataset(frames=40), platform="own_team", title="Walk one")


@pytest.fixture
def link(campaign: Campaign) -> CampaignLink:
    return campaign_links.make(campaign, "invitation")


@pytest.fixture
def alice(client: Client, campaign: Campaign) -> User:
    """An annotator, logged in."""
    user = account("alice", Role.ANNOTATOR, campaign.dataset)
    client.force_login(user)
    return user


def address(link: CampaignLink) -> str:
    return f"/invitation/{campaign_links.token(link)}/"


def text(response: Any) -> str:
    return response.content.decode()


def test_an_invitation_makes_an_account_that_is_an_invited_worker(client: Client, link: CampaignLink) -> None:
    assert "Walk one" in text(client.get(address(link)))
    assert not User.objects.exists()
    assert client.post(address(link), GIVEN)["Location"] == "/my-work/"
    user = User.objects.get()
    assert user.check_password(GIVEN["password"]) and not user.is_staff
    row = link.campaign.workers.get()
    assert (row.standing, row.worker.user, row.worker.platform) == ("invited", user, "own_team")


def test_an_invitation_works_once(client: Client, link: CampaignLink) -> None:
    client.post(address(link), GIVEN)
    late = Client()
    assert late.get(address(link)).status_code == 410
    assert late.post(address(link), {**GIVEN, "username": "bob"}).status_code == 410
    assert User.objects.count() == 1


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({**GIVEN, "password": "short"}, "too short"),
        ({**GIVEN, "password": "password"}, "too common"),
        ({**GIVEN, "username": ""}, "required"),
        ({**GIVEN, "username": "a b"}, "valid username"),
        ({**GIVEN, "username": "taken"}, "already"),
    ],
)
def test_what_makes_no_account_is_said_and_uses_nothing_up(
    client: Client, link: CampaignLink, given: dict[str, str], told: str
) -> None:
    User.objects.create_user("taken")
    response = client.post(address(link), given)
    assert response.status_code == 400 and told in text(response)
    assert User.objects.count() == 1 and not Worker.objects.exists()
    assert client.post(address(link), GIVEN).status_code == 302


@pytest.mark.parametrize("end", ["revoke", "rotate"])
def test_an_invitation_that_was_taken_back_makes_nothing(
    client: Client, link: CampaignLink, end: str
) -> None:
    sent = address(link)
    getattr(campaign_links, end)(link)
    assert client.post(sent, GIVEN).status_code in {404, 410}
    assert not User.objects.exists()


def test_who_has_an_account_accepts_with_it(client: Client, alice: User, link: CampaignLink) -> None:
    assert "alice" in text(client.get(address(link)))
    client.post(address(link))
    assert link.campaign.workers.get().worker.user == alice
    assert User.objects.count() == 1


def test_an_invitation_undoes_no_block(client: Client, alice: User, link: CampaignLink) -> None:
    standing.block(link.campaign, accounts.worker_of(alice), "clicks anywhere")
    client.post(address(link))
    assert link.campaign.workers.get().standing == "blocked"


def test_an_entry_link_is_no_invitation_and_an_invitation_no_entry(
    client: Client, link: CampaignLink
) -> None:
    general = campaign_links.make(link.campaign)
    assert client.get(address(general)).status_code == 404
    assert client.get(f"/join/{campaign_links.token(link)}/").status_code == 404


def test_the_link_of_an_own_team_leads_to_my_work(client: Client, campaign: Campaign) -> None:
    general = campaign_links.make(campaign)
    assert client.get(f"/join/{campaign_links.token(general)}/")["Location"] == "/my-work/"


def test_strangers_log_in_first_and_others_are_refused(client: Client, campaign: Campaign) -> None:
    assert client.get("/my-work/")["Location"].startswith("/login/")
    client.force_login(User.objects.create_user("nobody"))
    assert client.get("/my-work/").status_code == 403
    assert client.post(f"/my-work/{campaign.pk}/").status_code == 403
    assert not Worker.objects.exists()


def test_an_annotator_goes_from_my_work_to_a_batch_and_finds_it_there(client: Client, alice: User) -> None:
    page = text(client.get("/my-work/"))
    assert "Walk one" in page and "You have taken no batch yet." in page
    assert not Worker.objects.exists()
    home = client.post(f"/my-work/{Campaign.objects.get().pk}/")["Location"]
    work = client.post(home + "start/")["Location"]
    assert work in text(client.get("/my-work/"))
    finish(Assignment.objects.get())
    page = text(client.get("/my-work/"))
    assert f'"{work}"' not in page and "submitted" in page
    home_page = text(client.get(home))
    assert "Your completion code" not in home_page and "Annotate another batch" in home_page


def test_only_open_campaigns_and_those_one_worked_in_stand_there(client: Client, alice: User) -> None:
    campaign = Campaign.objects.get()
    for name, values in {"theirs": {"entry": "invited"}, "panel": {"platform": "link"}}.items():
        make_campaign(campaign.dataset, name, **{"platform": "own_team", **values})
    assert [one.campaign.name for one in accounts.places(alice)] == ["walk"]
    home = client.post(f"/my-work/{campaign.pk}/")["Location"]
    client.post(home + "start/")
    states.take(campaign, "close")
    assert [(one.campaign.name, one.held) for one in accounts.places(alice)] == [("walk", 1)]


def test_a_campaign_that_is_not_for_somebody_is_not_opened_by_its_number(client: Client, alice: User) -> None:
    other = make_campaign(Campaign.objects.get().dataset, "other", platform="own_team", entry="invited")
    assert client.post(f"/my-work/{other.pk}/").status_code == 404
    standing.put(other, accounts.worker_of(alice), "invited", "", None)
    assert client.post(f"/my-work/{other.pk}/").status_code == 302


def test_many_batches_and_campaigns_take_no_more_queries(
    client: Client, alice: User, django_assert_max_num_queries: Any
) -> None:
    campaign = Campaign.objects.get()
    for number in range(12):
        make_campaign(campaign.dataset, f"c{number}", platform="own_team")
    home = client.post(f"/my-work/{campaign.pk}/")["Location"]
    for _ in range(3):
        client.post(home + "start/")
        finish(Assignment.objects.get(submitted_at=None))
    with django_assert_max_num_queries(13):
        client.get("/my-work/")


def test_an_account_is_one_worker_and_no_other_accounts(alice: User) -> None:
    first = accounts.worker_of(alice)
    assert accounts.worker_of(alice) == first
    User.objects.filter(pk=alice.pk).delete()
    again = User.objects.create_user("alice")
    assert accounts.worker_of(again) != first
