"""The manager's pages of a campaign, and who else may not see them."""

from __future__ import annotations

import csv
import io
import re
from decimal import Decimal
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Campaign, CampaignLink, Worker
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import accounts, editing, standing, states
from gtm_hit.ops.campaigns import links as campaign_links
from gtm_hit.ops.work import links
from gtm_hit.ops.work.assignments import claim
from gtm_hit.ops.work.pools import Pool
from gtm_hit.pages.campaigns import workers
from gtm_hit.pages.campaigns.form import CampaignForm
from tests.campaign_scene import make_campaign, make_draft, manager
from tests.work_scene import do_frames, finish, make_dataset, make_worker

pytestmark = pytest.mark.django_db
BASE = "/datasets/square/campaigns/"


@pytest.fixture
def campaign() -> Campaign:
    return make_campaign(make_dataset(frames=60), title="Walk one", pay_per_batch=Decimal("2.50"))


@pytest.fixture
def boss(client: Client, campaign: Campaign) -> User:
    user = manager(campaign.dataset)
    client.force_login(user)
    return user


@pytest.fixture
def worked(campaign: Campaign) -> list[Worker]:
    """Three who submitted, hold and were blocked."""
    workers = [make_worker(name) for name in ("alice", "bob", "carol")]
    pool = Pool(campaign.dataset, campaign)
    finish(claim(workers[0], pool))
    do_frames(claim(workers[1], pool))
    standing.block(campaign, workers[2], "clicks anywhere")
    return workers


def text(response: Any) -> str:
    return response.content.decode()


def shown(page: str) -> str:
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page))


PAGES = [
    "",
    "new/",
    "walk/",
    "walk/rules/",
    "walk/links/",
    "walk/workers/",
    "walk/batches.csv",
    "walk/workers.csv",
]
DEEDS = ["new/", "walk/rules/", "walk/links/", "walk/workers/", "walk/step/"]


@pytest.mark.parametrize("path", PAGES)
def test_managers_see_it_and_others_do_not(client: Client, campaign: Campaign, path: str) -> None:
    assert client.get(BASE + path)["Location"].startswith("/login/")
    client.force_login(User.objects.create_user("nobody"))
    assert client.get(BASE + path).status_code == 403
    client.force_login(manager(campaign.dataset))
    assert client.get(BASE + path).status_code == 200


@pytest.mark.parametrize("path", DEEDS)
def test_nobody_else_changes_anything(client: Client, campaign: Campaign, path: str) -> None:
    given = {"step": "close", "worker": "x", "kind": "general", "name": "other"}
    for user in (None, User.objects.create_user("nobody")):
        if user:
            client.force_login(user)
        assert client.post(BASE + path, given).status_code in {302, 403}
    assert Campaign.objects.get().state == "open"
    assert not CampaignLink.objects.exists() and not Worker.objects.exists()


def test_what_is_not_there_is_said(client: Client, boss: User) -> None:
    for page in ("other/", "other/rules/", "walk/workers/w-none/", "walk/links/77/"):
        method = client.post if "77" in page else client.get
        assert method(BASE + page).status_code == 404


def test_a_dataset_without_campaigns_says_what_to_do(client: Client, campaign: Campaign, boss: User) -> None:
    Campaign.objects.all().update(dataset=make_dataset("other"))
    assert "No campaign yet" in text(client.get(BASE))


def test_the_datasets_page_leads_to_its_campaigns(client: Client, boss: User) -> None:
    assert 'href="/datasets/square/campaigns/"' in text(client.get(BASE))
    assert "Walk one" in text(client.get(BASE))


# Rules


def as_typed(campaign: Campaign, **changed: Any) -> dict[str, Any]:
    """The form as a browser sends it back."""
    form = CampaignForm(instance=campaign)
    sent = {name: form[name].value() for name, field in form.fields.items() if not field.disabled}
    return {name: "" if value is None else value for name, value in {**sent, **changed}.items()}


def test_the_form_has_a_field_for_every_rule(client: Client, boss: User) -> None:
    page = text(client.get(BASE + "new/"))
    for name in CampaignForm(instance=Campaign(dataset=Campaign.objects.get().dataset)).fields:
        assert f'name="{name}"' in page, name


def test_a_campaign_is_made_by_its_form(client: Client, boss: User, campaign: Campaign) -> None:
    draft = Campaign(dataset=campaign.dataset)
    given = as_typed(
        draft, name="second", platform="link", copies=2, pay_per_batch="3.20", **{"link.fixed_code": "P7"}
    )
    response = client.post(BASE + "new/", given)
    made = Campaign.objects.get(name="second")
    assert response["Location"] == BASE + "second/"
    assert (made.copies, made.pay_per_batch, made.state) == (2, Decimal("3.20"), "draft")
    assert (made.platform_settings["fixed_code"], made.created_by) == ("P7", boss)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"name": "walk"}, "already"),
        ({"name": "a b"}, "letters, digits"),
        ({"overlap": 10}, "fewer frames"),
        ({"link.return_address": "ftp://x"}, "https://"),
        ({"copies": 0}, "greater than or equal to 1"),
    ],
)
def test_a_form_that_makes_no_sense_makes_nothing(
    client: Client, boss: User, campaign: Campaign, changed: dict[str, Any], told: str
) -> None:
    draft = Campaign(dataset=campaign.dataset)
    response = client.post(BASE + "new/", as_typed(draft, **{"name": "x", "platform": "link", **changed}))
    assert response.status_code == 400 and told in text(response)
    assert Campaign.objects.count() == 1


def test_the_rules_of_an_open_campaign_say_what_may_change(
    client: Client, boss: User, campaign: Campaign
) -> None:
    page = text(client.get(BASE + "walk/rules/"))
    assert "fixed: batches are cut" in page and "may rise; nobody gets less" in page
    client.post(BASE + "walk/rules/", as_typed(campaign, title="Anew", batch_size=20, pay_per_batch="3"))
    campaign.refresh_from_db()
    assert (campaign.title, campaign.batch_size, campaign.pay_per_batch) == ("Anew", 10, 3)
    response = client.post(BASE + "walk/rules/", as_typed(campaign, title="Again", pay_per_batch="1"))
    assert response.status_code == 400 and "may rise" in text(response)
    campaign.refresh_from_db()
    assert (campaign.title, campaign.pay_per_batch) == ("Anew", 3)


def test_the_estimate_is_batches_times_copies_times_pay(
    client: Client, boss: User, campaign: Campaign
) -> None:
    editing.edit(campaign, {"copies": 2, "pay_per_batch": Decimal("2.50")})
    # 60 frames by 10 with 1 shared: 1 + ceil(50 / 9) = 7 batches.
    assert "35.00 USD" in shown(text(client.get(BASE + "walk/rules/")))


# States


def test_a_campaign_is_opened_paused_and_closed_by_its_buttons(client: Client, boss: User) -> None:
    make_draft(Campaign.objects.get().dataset, "second")
    for step, state in [("open", "open"), ("pause", "paused"), ("open", "open"), ("close", "closed")]:
        client.post(BASE + "second/step/", {"step": step})
        assert Campaign.objects.get(name="second").state == state
    page = client.post(BASE + "second/step/", {"step": "open"}, follow=True)
    assert "cannot be changed" in text(page)


def test_the_overview_tells_how_it_goes(client: Client, boss: User, worked: list[Worker]) -> None:
    page = text(client.get(BASE + "walk/"))
    assert "1 batch to be reviewed" in shown(page)
    assert worked[1].pseudonym in page and worked[0].pseudonym not in page
    assert "2.50 USD" in shown(page)
    assert "<svg" in page and "submitted 10" in page


def test_a_draft_has_an_overview_too(client: Client, boss: User) -> None:
    make_draft(Campaign.objects.get().dataset, "second")
    page = text(client.get(BASE + "second/"))
    assert "Nothing to draw yet" in page and "Nobody holds a batch." in page


# Links


def test_a_general_link_is_made_rotated_and_revoked(client: Client, boss: User, campaign: Campaign) -> None:
    assert "No link yet" in text(client.get(BASE + "walk/links/"))
    client.post(BASE + "walk/links/", {"kind": "general", "note": "panel A", "days": 3})
    link = CampaignLink.objects.get()
    old = campaign_links.token(link)
    assert old in text(client.get(BASE + "walk/links/"))
    client.post(f"{BASE}walk/links/{link.pk}/", {"deed": "rotate"})
    fresh = campaign_links.token(CampaignLink.objects.get())
    page = text(client.get(BASE + "walk/links/"))
    assert fresh in page and old not in page
    client.post(f"{BASE}walk/links/{link.pk}/", {"deed": "revoke"})
    page = text(client.get(BASE + "walk/links/"))
    assert fresh not in page and "revoked" in page


def test_a_personal_link_is_for_a_worker_by_his_id(client: Client, boss: User) -> None:
    client.post(BASE + "walk/links/", {"kind": "personal", "worker": "alice"})
    assert CampaignLink.objects.get().worker == Worker.objects.get(external_id="alice")
    response = client.post(BASE + "walk/links/", {"kind": "personal", "worker": ""})
    assert response.status_code == 400 and CampaignLink.objects.count() == 1


@pytest.mark.parametrize(
    ("platform", "told"),
    [("prolific", "PROLIFIC_PID={{%PROLIFIC_PID%}}"), ("link", "/join/"), ("own_team", "/invitation/")],
)
def test_the_address_stands_there_as_it_is_pasted(
    client: Client, boss: User, campaign: Campaign, platform: str, told: str
) -> None:
    other = make_campaign(campaign.dataset, "other", platform=platform)
    campaign_links.make(other, "invitation" if platform == "own_team" else "general")
    assert told in text(client.get(BASE + "other/links/"))


def test_a_link_of_another_campaign_is_not_touched(client: Client, boss: User, campaign: Campaign) -> None:
    link = campaign_links.make(make_campaign(campaign.dataset, "other"))
    assert client.post(f"{BASE}walk/links/{link.pk}/", {"deed": "revoke"}).status_code == 404
    assert CampaignLink.objects.get().state == "open"


# Workers


def test_nobody_has_come_in_yet(client: Client, boss: User) -> None:
    assert "Nobody has come in yet" in text(client.get(BASE + "walk/workers/"))


def test_workers_stand_there_with_what_they_did(client: Client, boss: User, worked: list[Worker]) -> None:
    page = text(client.get(BASE + "walk/workers/"))
    for worker in worked:
        assert worker.pseudonym in page
    assert "blocked" in page and "alice" not in page
    found = text(client.get(f"{BASE}walk/workers/?q=alice"))
    assert worked[0].pseudonym in found and worked[1].pseudonym not in found


def test_a_worker_is_invited_by_his_id(client: Client, boss: User, campaign: Campaign) -> None:
    client.post(BASE + "walk/workers/", {"worker": "dora"})
    row = campaign.workers.get()
    assert (row.worker.external_id, row.standing, row.changed_by) == ("dora", "invited", boss)


def test_nobody_is_invited_to_the_own_team_without_an_account(
    client: Client, boss: User, campaign: Campaign
) -> None:
    other = make_campaign(campaign.dataset, "other", platform="own_team")
    response = client.post(BASE + "other/workers/", {"worker": "dora"})
    assert response.status_code == 400 and "invitation" in text(response)
    known = accounts.worker_of(User.objects.create_user("dora"))
    client.post(BASE + "other/workers/", {"worker": "dora"})
    assert other.workers.get().worker == known


def test_a_worker_is_blocked_with_a_reason_and_let_in_again(
    client: Client, boss: User, campaign: Campaign, worked: list[Worker]
) -> None:
    address = f"{BASE}walk/workers/{worked[0].pseudonym}/"
    client.post(address + "decide/", {"deed": "block"})
    assert campaign.workers.count() == 1
    client.post(address + "decide/", {"deed": "block", "reason": "never moves the box"})
    page = text(client.get(address))
    assert "never moves the box" in page and boss.username in page
    client.post(address + "decide/", {"deed": "forget"})
    assert campaign.workers.count() == 1
    refused = client.post(address + "decide/", {"deed": "pay him"}, follow=True)
    assert "nothing was changed" in text(refused)


def test_the_links_of_a_worker_and_of_a_batch_are_revoked(
    client: Client, boss: User, campaign: Campaign, worked: list[Worker]
) -> None:
    assignment = worked[1].assignments.get()
    address = f"{BASE}walk/workers/{worked[1].pseudonym}/decide/"
    first, seat = (
        links.assignment_token(assignment),
        links.seat_token(links.Seat(worked[1], campaign.dataset, campaign)),
    )
    client.post(address, {"deed": "revoke-link", "assignment": assignment.pk})
    assert Client().get(f"/annotate/{first}/").status_code == 404
    assert Client().get(f"/work/{seat}/").status_code == 200
    client.post(address, {"deed": "revoke-links"})
    assert Client().get(f"/work/{seat}/").status_code == 404


def test_the_link_of_somebody_elses_batch_is_not_revoked_by_his_number(
    client: Client, boss: User, worked: list[Worker]
) -> None:
    theirs = worked[0].assignments.get()
    address = f"{BASE}walk/workers/{worked[1].pseudonym}/decide/"
    assert client.post(address, {"deed": "revoke-link", "assignment": theirs.pk}).status_code == 404
    assert worked[0].assignments.get().nonce == theirs.nonce


def test_a_worker_of_another_dataset_is_not_there(client: Client, boss: User, campaign: Campaign) -> None:
    other = make_campaign(make_dataset("other", frames=60))
    stranger = make_worker("stranger")
    claim(stranger, Pool(other.dataset, other))
    nonce = stranger.nonce
    address = f"{BASE}walk/workers/{stranger.pseudonym}/"
    assert client.get(address).status_code == client.get(address + "batches.csv").status_code == 404
    assert client.post(address + "decide/", {"deed": "revoke-links"}).status_code == 404
    stranger.refresh_from_db()
    assert stranger.nonce == nonce


def test_all_links_end_only_where_the_manager_manages_everything(
    client: Client, boss: User, campaign: Campaign, worked: list[Worker]
) -> None:
    other = make_campaign(make_dataset("other", frames=60))
    claim(worked[1], Pool(other.dataset, other))
    nonce = Worker.objects.get(pk=worked[1].pk).nonce
    address = f"{BASE}walk/workers/{worked[1].pseudonym}/decide/"
    assert "do not manage" in text(client.post(address, {"deed": "revoke-links"}, follow=True))
    assert Worker.objects.get(pk=worked[1].pk).nonce == nonce
    granting.grant(boss, Role.MANAGER, other.dataset)
    client.post(address, {"deed": "revoke-links"})
    assert Worker.objects.get(pk=worked[1].pk).nonce != nonce


def test_an_unknown_deed_with_a_link_is_answered(client: Client, boss: User, campaign: Campaign) -> None:
    client.post(f"{BASE}walk/links/", {"kind": "general"})
    link = campaign.links.get()
    answer = client.post(f"{BASE}walk/links/{link.pk}/", {"deed": "polish"}, follow=True)
    assert "nothing was changed" in text(answer)


# Tables


def rows(response: Any) -> list[dict[str, str]]:
    assert response["Content-Type"].startswith("text/csv")
    return list(csv.DictReader(io.StringIO(text(response))))


def test_the_tables_come_as_csv(client: Client, boss: User, worked: list[Worker]) -> None:
    workers = {row["worker"]: row for row in rows(client.get(BASE + "walk/workers.csv"))}
    assert workers[worked[0].pseudonym]["submitted"] == "1"
    assert workers[worked[2].pseudonym]["standing"] == "blocked"
    assert {row["state"] for row in rows(client.get(BASE + "walk/batches.csv"))} == {"submitted", "leased"}
    own = rows(client.get(f"{BASE}walk/workers/{worked[0].pseudonym}/batches.csv"))
    assert [row["worker"] for row in own] == [worked[0].pseudonym]


@pytest.mark.parametrize("path", ["", "walk/", "walk/links/", "walk/workers/", "walk/rules/"])
def test_more_workers_take_no_more_queries(client: Client, boss: User, campaign: Campaign, path: str) -> None:
    from django.db import connection
    from django.test.utils import CaptureQueriesContext

    counts = []
    for names in (["a"], ["b", "c", "d", "e"]):
        for name in names:
            worker = make_worker(name)
            finish(claim(worker, Pool(campaign.dataset, campaign)))
            campaign_links.make(campaign, "personal", worker=worker)
        with CaptureQueriesContext(connection) as counted:
            client.get(BASE + path)
        counts.append(len(counted))
    assert counts[0] == counts[1]


def test_a_closed_campaign_keeps_its_pages(client: Client, boss: User, campaign: Campaign) -> None:
    states.take(campaign, "close")
    for page in ("walk/", "walk/rules/", "walk/links/", "walk/workers/"):
        assert client.get(BASE + page).status_code == 200
    assert "Make a link" not in text(client.get(BASE + "walk/links/"))


def test_paging_keeps_what_was_searched(
    client: Client, boss: User, campaign: Campaign, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(workers, "ROWS_PER_PAGE", 1)
    for one in ("ada-1", "ada-2"):
        Worker.objects.filter(pk=standing.invite(campaign, one, boss).worker.pk).update(pseudonym=one)
    html = client.get(f"{BASE}{campaign.name}/workers/?q=ada").content.decode()
    assert 'href="?q=ada&amp;page=2"' in html
