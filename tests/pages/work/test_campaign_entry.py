"""How workers of each platform come into a campaign, and how they leave."""

from __future__ import annotations

from typing import Any
from urllib.parse import parse_qs, urlsplit

import pytest
from django.test import Client

from gtm_hit.models import Assignment, Campaign, Worker
from gtm_hit.ops.campaigns import links as campaign_links
from gtm_hit.ops.campaigns import standing, states
from gtm_hit.ops.work import links
from tests.campaign_scene import make_campaign
from tests.work_scene import finish, make_dataset

pytestmark = pytest.mark.django_db

PANEL = "https://panel.example"
FOUND = {"hitId": "H1", "assignmentId": "A1", "workerId": "W1", "turkSubmitTo": PANEL}
STUDY = {"PROLIFIC_PID": "P1", "STUDY_ID": "S1", "SESSION_ID": "X1"}


@pytest.fixture(autouse=True)
def allowed(settings: Any) -> None:
    settings.EMBEDDING_ORIGINS = [PANEL]


def entry(campaign: Campaign, **given: Any) -> str:
    return f"/join/{campaign_links.token(campaign_links.make(campaign, **given))}/"


def text(response: Any) -> str:
    return response.content.decode()


def strict() -> Client:
    """A browser in whose frame no cookie arrives."""
    return Client(enforce_csrf_checks=True)


def press(client: Client, address: str, given: dict[str, str]) -> Any:
    """The form of the entry page, whose address is the page's own."""
    return client.post(address, query_params=given)


def seat(client: Client, address: str, given: dict[str, str]) -> str:
    return str(press(client, address, given)["Location"])


def complete(client: Client, home: str) -> Assignment:
    client.post(home + "start/")
    return finish(Assignment.objects.get(submitted_at=None))


# A panel with a code


def test_a_panels_worker_comes_by_the_link_and_gets_a_code(client: Client) -> None:
    address = entry(make_campaign(title="Marking people"))
    assert "Marking people" in text(client.get(address))
    home = client.post(address, {"worker_id": "alice"})["Location"]
    done = complete(client, home)
    assert str(done.code) in text(client.get(home))


def test_another_browser_with_the_same_id_gets_no_seat(client: Client) -> None:
    address = entry(make_campaign())
    client.post(address, {"worker_id": "alice"})
    assert Client().post(address, {"worker_id": "alice"}).status_code == 403
    assert client.post(address, {"worker_id": "alice"}).status_code == 302


def test_the_parameter_that_names_the_worker_is_the_campaigns(client: Client) -> None:
    address = entry(make_campaign(platform_settings={"worker_parameter": "rid"}))
    assert 'value="alice"' in text(client.get(address + "?rid=alice"))
    assert 'value="alice"' not in text(client.get(address + "?PROLIFIC_PID=alice"))


def test_a_panel_with_one_code_for_all_and_an_address_back(client: Client) -> None:
    settings = {"fixed_code": "PANEL-77", "return_address": "https://panel.example/done"}
    home = client.post(entry(make_campaign(platform_settings=settings)), {"worker_id": "a"})["Location"]
    done = complete(client, home)
    page = text(client.get(home))
    assert 'value="PANEL-77"' in page and 'href="https://panel.example/done"' in page
    assert str(done.code) not in page


def test_a_forged_form_cannot_seat_somebody_in_anothers_browser() -> None:
    address = entry(make_campaign())
    assert strict().post(address, {"worker_id": "mallory"}).status_code == 403
    assert not Worker.objects.exists()


@pytest.mark.parametrize("end", ["revoke", "rotate", "close"])
def test_a_link_that_is_over_lets_nobody_new_in_and_the_others_go_on(client: Client, end: str) -> None:
    campaign = make_campaign()
    link = campaign_links.make(campaign)
    address = f"/join/{campaign_links.token(link)}/"
    home = client.post(address, {"worker_id": "alice"})["Location"]
    if end == "close":
        states.take(campaign, "close")
    else:
        getattr(campaign_links, end)(link)
    if end != "close":
        assert Client().post(address, {"worker_id": "new"}).status_code in {404, 410}
        assert Worker.objects.count() == 1
    assert client.get(home).status_code == 200


def test_who_is_blocked_reads_so_and_gets_nothing(client: Client) -> None:
    campaign = make_campaign()
    home = client.post(entry(campaign), {"worker_id": "alice"})["Location"]
    standing.block(campaign, Worker.objects.get(), "clicks anywhere")
    assert "You get no more batches" in text(client.get(home))
    page = client.post(home + "start/")
    assert "You get no more batches" in text(page) and "clicks anywhere" not in text(page)
    assert not Assignment.objects.exists()


def test_a_second_batch_beside_the_first_is_offered_where_the_campaign_allows_it(client: Client) -> None:
    campaign = make_campaign(make_dataset(frames=40), batches_at_once=2)
    home = client.post(entry(campaign), {"worker_id": "alice"})["Location"]
    client.post(home + "start/")
    assert "Take another batch beside this one" in text(client.get(home))
    client.post(home + "start/", {"another": "yes"})
    assert Assignment.objects.count() == 2
    assert "Take another batch beside this one" not in text(client.get(home))


# ExternalQuestion


def embedded(**given: Any) -> Campaign:
    return make_campaign(platform="external_question", **given)


def test_a_preview_makes_nothing_and_may_be_framed() -> None:
    address = entry(embedded())
    response = strict().get(address, {**FOUND, "assignmentId": "ASSIGNMENT_ID_NOT_AVAILABLE", "workerId": ""})
    assert "This is a preview" in text(response)
    assert (
        press(strict(), address, {**FOUND, "assignmentId": "ASSIGNMENT_ID_NOT_AVAILABLE"}).status_code == 200
    )
    assert not Worker.objects.exists()
    assert f"frame-ancestors {PANEL}" in response["Content-Security-Policy"]
    assert "X-Frame-Options" not in response


def test_from_the_frame_to_the_form_without_a_cookie() -> None:
    address = entry(embedded())
    assert strict().get(address, FOUND).status_code == 200
    assert not Worker.objects.exists()
    home = seat(strict(), address, FOUND)
    work = strict().post(home + "start/")["Location"]
    for page in (strict().get(home), strict().get(work)):
        assert f"frame-ancestors {PANEL}" in page["Content-Security-Policy"]
        assert f"form-action 'self' {PANEL}" in page["Content-Security-Policy"]
    done = finish(Assignment.objects.get())
    assert done.submission == "A1"
    page = text(strict().get(home))
    assert f'action="{PANEL}/mturk/externalSubmit"' in page
    assert 'name="assignmentId" value="A1"' in page and str(done.code) in page


def test_the_workbench_leads_back_to_a_page_that_still_knows_where_the_form_goes() -> None:
    address = entry(embedded())
    work = strict().post(seat(strict(), address, FOUND) + "start/")["Location"]
    finish(Assignment.objects.get())
    page = text(strict().get(work))
    home = page.split('data-home="')[1].split('"')[0]
    assert f'action="{PANEL}/mturk/externalSubmit"' in text(strict().get(home))


@pytest.mark.parametrize(
    "submit_to",
    [
        "",
        "https://evil.example",
        "https://panel.example.evil.example",
        "https://panel.example@evil.example",
        "http://panel.example",
        "javascript:alert(1)",
        "https://panel.example/?x=",
        "https://panel.example/#x",
        "//panel.example",
    ],
)
def test_a_form_goes_to_listed_origins_only(submit_to: str) -> None:
    address = entry(embedded())
    response = press(strict(), address, {**FOUND, "turkSubmitTo": submit_to})
    assert response.status_code == 400
    assert not Worker.objects.exists()


def test_a_panel_that_the_server_lists_no_longer_may_neither_frame_nor_take_forms(settings: Any) -> None:
    address = entry(embedded())
    settings.EMBEDDING_ORIGINS = []
    response = strict().get(address, FOUND)
    assert response.status_code == 400
    assert response["X-Frame-Options"] == "DENY"
    assert "frame-ancestors 'none'" in response["Content-Security-Policy"]


@pytest.mark.parametrize("platform", ["link", "prolific"])
def test_pages_of_other_platforms_are_framed_by_nobody(client: Client, platform: str) -> None:
    response = client.get(entry(make_campaign(platform=platform)), STUDY)
    assert response["X-Frame-Options"] == "DENY"
    assert "frame-ancestors 'none'" in response["Content-Security-Policy"]


def test_who_knows_the_id_and_the_link_gets_neither_the_seat_nor_the_code() -> None:
    campaign = embedded()
    address = entry(campaign)
    home = seat(strict(), address, FOUND)
    done = complete(strict(), home)
    other = seat(strict(), address, {**FOUND, "assignmentId": "A2"})
    assert other != home
    assert str(done.code) not in text(strict().get(other))
    strict().post(other + "start/")
    assert Assignment.objects.count() == 2


def test_the_same_task_opened_again_goes_on() -> None:
    address = entry(embedded())
    home = seat(strict(), address, FOUND)
    strict().post(home + "start/")
    again = strict().get(address, FOUND)
    assert again.status_code == 302
    assert links.read_worker(again["Location"].split("/")[2]) == links.read_worker(home.split("/")[2])


# Prolific


def test_a_participant_goes_back_with_the_code_of_his_outcome(client: Client) -> None:
    home = seat(client, entry(make_campaign(platform="prolific")), STUDY)
    assert complete(client, home).submission == "X1"
    assert "https://app.prolific.com/submissions/complete?cc=DONE1" in text(client.get(home))


def test_a_participant_for_whom_there_is_no_work_goes_back_with_another_code(client: Client) -> None:
    address = entry(make_campaign(make_dataset(frames=10), platform="prolific"))
    seat_of_first = seat(client, address, STUDY)
    client.post(seat_of_first + "start/")
    late = seat(client, address, {**STUDY, "PROLIFIC_PID": "P2", "SESSION_ID": "X2"})
    assert "cc=NONE1" in text(client.post(late + "start/"))


def test_a_participant_who_is_not_admitted_goes_back_with_a_third(client: Client) -> None:
    home = seat(client, entry(make_campaign(platform="prolific", entry="invited")), STUDY)
    assert "cc=OUT1" in text(client.post(home + "start/"))
    assert not Assignment.objects.exists()


def test_the_parameters_of_a_study_have_the_campaigns_names(client: Client) -> None:
    names = {"worker_parameter": "participant", "submission_parameter": "submission"}
    campaign = make_campaign(platform="prolific", platform_settings={**names, "code_completed": "D"})
    address = entry(campaign)
    assert press(client, address, STUDY).status_code == 400
    assert press(client, address, {"participant": "P1", "submission": "X1"}).status_code == 302


@pytest.mark.parametrize("lacking", ["PROLIFIC_PID", "SESSION_ID"])
def test_a_study_without_its_parameters_is_told_apart(client: Client, lacking: str) -> None:
    given = {name: value for name, value in STUDY.items() if name != lacking}
    response = press(client, entry(make_campaign(platform="prolific")), given)
    assert response.status_code == 400 and "Open this page from the study" in text(response)
    assert not Worker.objects.exists()


def test_one_submission_gets_one_batch(client: Client) -> None:
    home = seat(client, entry(make_campaign(make_dataset(frames=40), platform="prolific")), STUDY)
    complete(client, home)
    assert client.post(home + "start/")["Location"] == home
    assert Assignment.objects.count() == 1


def test_a_completion_address_keeps_its_own_query(client: Client) -> None:
    own = {"completion_address": "https://app.prolific.com/x?y=1", "code_completed": "D&E".replace("&", "-")}
    home = seat(client, entry(make_campaign(platform="prolific", platform_settings=own)), STUDY)
    complete(client, home)
    page = text(client.get(home))
    found = page.split('href="https://app.prolific.com')[1].split('"')[0].replace("&amp;", "&")
    assert parse_qs(urlsplit(found).query) == {"y": ["1"], "cc": ["D-E"]}


# Personal links


def test_a_personal_link_opens_in_every_browser_until_it_is_revoked(client: Client) -> None:
    campaign = make_campaign(entry="invited")
    worker = standing.invite(campaign, "alice").worker
    link = campaign_links.make(campaign, "personal", worker=worker)
    address = f"/join/{campaign_links.token(link)}/"
    assert Client().get(address).status_code == client.get(address).status_code == 302
    campaign_links.revoke(link)
    assert client.get(address).status_code == 404
